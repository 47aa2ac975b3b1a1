#include "deformable_organ.hpp"

#include <ros/console.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/messages/conversions.hpp"
#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

/// [1] A volume below this share of the cube of the organ's longest side counts as a rounding
/// error. The two sides of a sheet enclose such a volume.
constexpr double kNoVolume = 1e-9;

/// [s] Shapes without stamps that come within this time have waited for each other. Their arrival
/// does not tell how fast the tissue moves.
constexpr double kLeastArrival = 1e-3;

constexpr char kNotYetKnown[] = "not yet known";

}  // namespace

void OrganSurface::find() {
  if (is_found()) return;
  SurfaceTopology topology(*faces_, *vertices_);
  const double least = kNoVolume * std::pow(box_.sizes().maxCoeff(), 3);
  const bool is_inward = signed_volume(topology, *faces_, *vertices_) < -least;
  vertices_.reset();
  promise_.set_value({std::move(topology), is_inward});
}

DeformableOrgan::DeformableOrgan(std::string name, std::string frame, TriangleMesh mesh,
                                 ros::Time stamp, ros::Time received)
    : name_(std::move(name)), frame_(std::move(frame)) {
  replace(std::move(mesh), stamp, received);
}

void DeformableOrgan::move(SharedVertices vertices, ros::Time stamp, ros::Time received) {
  // Another thread may have been the last user of a shape. The copied pointer synchronises with it.
  const auto unused = std::find_if(shapes_.begin(), shapes_.end(),
                                   [](const auto& shape) { return shape.use_count() == 1; });
  const std::shared_ptr<TriangleMesh> shape =
      unused != shapes_.end() ? *unused
                              : shapes_.emplace_back(std::make_shared<TriangleMesh>(*latest_.mesh));
  shape->move_vertices(std::move(vertices));
  OrganShape next{shape, stamp, received, latest_.surface, history_.number};
  const double arrival_sec = seconds_between(latest_.received, received);
  const bool have_stamps = !stamp.isZero() && !latest_.stamp.isZero();
  if (have_stamps || arrival_sec > kLeastArrival) {
    next.motion_sec = have_stamps ? seconds_between(latest_.stamp, stamp) : arrival_sec;
  }
  next.period_sec = std::max(next.motion_sec, arrival_sec);
  if (latest_.history == history_.number) next.before = latest_.mesh;
  latest_ = std::move(next);
}

void DeformableOrgan::replace(TriangleMesh mesh, ros::Time stamp, ros::Time received) {
  const auto shape = std::make_shared<TriangleMesh>(std::move(mesh));
  auto surface = std::make_shared<OrganSurface>(*shape);
  shapes_ = {shape};  // Last, as it may fail for lack of memory.
  latest_ = {shape, stamp, received, std::move(surface), history_.number};
}

void DeformableOrgan::limit_received(ros::Time now) {
  const bool came_before_time = latest_.received.isZero();
  latest_.received = came_before_time ? now : std::min(latest_.received, now);
}

std::string closedness(const OrganSurface& surface) {
  if (!surface.is_found()) return kNotYetKnown;
  if (surface.topology().is_closed()) return "closed";
  return "open (" + counted(surface.topology().open_edge_count(), "edge") + ")";
}

std::string orientation(const OrganSurface& surface) {
  if (!surface.is_found()) return kNotYetKnown;
  if (!surface.topology().is_closed()) return "none";
  return surface.is_inward() ? "inward" : "outward";
}

std::string summary(const std::string& organ, const OrganSurface& surface) {
  return concatenate("organ '", organ, "': ", counted(surface.face_count(), "face"), ", ",
                     closedness(surface), ", ", sides_of(surface.box()), " m");
}

std::vector<std::string> doubts(const std::string& organ, const Eigen::AlignedBox3d& box,
                                const OrganSurface& surface) {
  std::vector<std::string> sentences;
  const std::string size = doubt_about_organ(organ, box);
  if (!size.empty()) sentences.push_back(size);
  if (surface.is_found() && surface.is_inward()) {
    sentences.push_back("the faces of organ '" + organ +
                        "' point inward, so that `behind` and the direction of crossings are "
                        "reversed: swap two vertices of each triangle");
  }
  return sentences;
}

OrganInfo info_of(const DeformableOrgan& organ) {
  const TriangleMesh& mesh = *organ.latest().mesh;
  const Eigen::AlignedBox3d box = mesh.box().cast<double>();
  organ.surface()->find();
  OrganInfo info;
  info.name = organ.name();
  info.frame = organ.frame();
  info.topology = mesh.topology();
  info.faces = static_cast<std::uint32_t>(mesh.face_count());
  info.vertices = static_cast<std::uint32_t>(mesh.vertex_count());
  info.low = tf2::toMsg(Eigen::Vector3d(box.min()));
  info.high = tf2::toMsg(Eigen::Vector3d(box.max()));
  info.stamp = organ.latest().stamp;
  const SurfaceTopology& topology = organ.surface()->topology();
  info.closed = topology.is_closed();
  info.volume = signed_volume(topology, mesh.faces(), mesh.vertices());
  return info;
}

void SurfaceLog::tell(const std::string& organ, const OrganSurface& surface, Time now) {
  Next& next = next_[organ];
  if (now >= next.summary) {
    next.summary = now + kPeriod;
    ROS_INFO("%s", summary(organ, surface).c_str());
  }
  const std::vector<std::string> sentences = doubts(organ, surface.box(), surface);
  if (sentences.empty() || now < next.doubts) return;
  next.doubts = now + kPeriod;
  for (const std::string& sentence : sentences) ROS_WARN("%s", sentence.c_str());
}

}  // namespace organ_collision
