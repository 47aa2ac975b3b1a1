#include "load.hpp"

#include <boost/make_shared.hpp>
#include <cmath>

#include "test/check_contacts/answer_rules.hpp"

namespace organ_collision::stress {

void Findings::check(const std::string& source, const ContactArray& answer) {
  const Faults faults = check_answer(answer);
  const std::lock_guard lock(mutex_);
  count(source, answer, faults);
}

void Findings::check_step(const ContactArray& answer, const std::string& publisher) {
  const std::lock_guard lock(mutex_);
  count("contacts", answer, steps_.check(answer, publisher));
}

void Findings::count(const std::string& source, const ContactArray& answer, const Faults& faults) {
  ++checked_;
  answered_ += answer.status == ContactArray::OK;
  for (const Fault& fault : faults.all()) sentences_.insert(source + ": " + fault.sentence);
}

void Findings::add(const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  sentences_.insert(sentence);
}

std::size_t Findings::checked() const {
  const std::lock_guard lock(mutex_);
  return checked_;
}

std::size_t Findings::answered() const {
  const std::lock_guard lock(mutex_);
  return answered_;
}

std::string Findings::text() const {
  const std::lock_guard lock(mutex_);
  std::string text;
  for (const std::string& sentence : sentences_) text += sentence + "\n";
  return text;
}

namespace {

constexpr double kSide = 0.1;         // [m]
constexpr double kWaveHeight = 2e-3;  // [m]
constexpr double kWaveNumber = 90.0;  // [rad/m]

}  // namespace

std::vector<float> Sheet::vertices(double phase) const {
  std::vector<float> vertices;
  vertices.reserve(3 * (cells + 1) * (cells + 1));
  for (std::size_t row = 0; row <= cells; ++row) {
    for (std::size_t column = 0; column <= cells; ++column) {
      const double x = kSide * (static_cast<double>(column) / static_cast<double>(cells) - 0.5);
      const double y = kSide * (static_cast<double>(row) / static_cast<double>(cells) - 0.5);
      const double z = kWaveHeight * std::sin(kWaveNumber * (x + 0.3 * y) + phase);
      for (const double value : {x, y, z}) vertices.push_back(static_cast<float>(value));
    }
  }
  return vertices;
}

std::vector<std::uint32_t> Sheet::triangles(std::size_t cut) const {
  std::vector<std::uint32_t> triangles;
  triangles.reserve(6 * (cells * cells - cut));
  for (std::size_t square = cut; square < cells * cells; ++square) {
    const auto corner = static_cast<std::uint32_t>(square / cells * (cells + 1) + square % cells);
    const auto above = static_cast<std::uint32_t>(corner + cells + 1);
    for (const std::uint32_t vertex : {corner, corner + 1, above + 1, corner, above + 1, above}) {
      triangles.push_back(vertex);
    }
  }
  return triangles;
}

OrganMeshPtr mesh_message(const std::string& organ, const Sheet& sheet, std::size_t cut,
                          double phase) {
  const auto mesh = boost::make_shared<OrganMesh>();
  mesh->header.frame_id = "sheet";
  mesh->header.stamp = ros::Time::now();
  mesh->organ = organ;
  mesh->topology = static_cast<std::uint32_t>(cut);
  mesh->vertices = sheet.vertices(phase);
  mesh->triangles = sheet.triangles(cut);
  return mesh;
}

namespace {

constexpr double kReach = 0.01;  // [m] above and below the sheets
constexpr double kTurn = 0.8;    // [rad] to either side
const Eigen::Vector3d kTurningAxis = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();

}  // namespace

ToolPlaces tool_places(double phase) {
  const double height = kReach * std::sin(phase), side = kReach * std::cos(0.3 * phase);
  const Eigen::AngleAxisd turn(kTurn * std::sin(0.7 * phase), kTurningAxis);
  return {{side, 0.0, height},
          {0.0, side, -height},
          {-side, 0.0, height},
          Eigen::Translation3d(side, side, height) * turn};
}

namespace {

geometry_msgs::TransformStamped transform(const std::string& frame, ros::Time stamp,
                                          const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "sheet";
  transform.header.stamp = stamp;
  transform.child_frame_id = frame;
  transform.transform.translation.x = pose.translation().x();
  transform.transform.translation.y = pose.translation().y();
  transform.transform.translation.z = pose.translation().z();
  transform.transform.rotation.x = rotation.x();
  transform.transform.rotation.y = rotation.y();
  transform.transform.rotation.z = rotation.z();
  transform.transform.rotation.w = rotation.w();
  return transform;
}

Eigen::Isometry3d at(const Eigen::Vector3d& point) {
  return Eigen::Isometry3d(Eigen::Translation3d(point));
}

}  // namespace

std::vector<geometry_msgs::TransformStamped> resting_transforms(ros::Time stamp) {
  return {transform("probe_trocar", stamp, at(kProbeTrocar)),
          transform("needle_trocar", stamp, at(kNeedleTrocar)),
          transform("stylus_trocar", stamp, at(kStylusTrocar))};
}

std::vector<geometry_msgs::TransformStamped> moving_transforms(const ToolPlaces& places,
                                                               ros::Time stamp) {
  return {transform("probe_tip", stamp, at(places.probe_tip)),
          transform("needle_tip", stamp, at(places.needle_tip)),
          transform("jaw", stamp, places.jaw)};
}

geometry_msgs::PoseStamped stylus_pose(const ToolPlaces& places, ros::Time stamp) {
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = "sheet";
  pose.header.stamp = stamp;
  pose.pose.position.x = places.stylus_tip.x();
  pose.pose.position.y = places.stylus_tip.y();
  pose.pose.position.z = places.stylus_tip.z();
  pose.pose.orientation.w = 1.0;
  return pose;
}

}  // namespace organ_collision::stress
