#include "stress_simulator.hpp"

#include <organ_collision/OrganVertices.h>
#include <ros/duration.h>
#include <rosgraph_msgs/Clock.h>

#include <boost/make_shared.hpp>
#include <string>
#include <utility>

namespace organ_collision::stress {
namespace {

constexpr double kPhaseStep = 0.01;  // [rad] from pose to pose

}  // namespace

MovingTools::MovingTools() : stylus_(node_.advertise<geometry_msgs::PoseStamped>("/stylus", 10)) {
  static_transforms_.sendTransform(resting_transforms(ros::Time::now()));
}

void MovingTools::send() {
  phase_ += kPhaseStep;
  const ToolPlaces places = tool_places(phase_);
  transforms_.sendTransform(moving_transforms(places, ros::Time::now()));
  stylus_.publish(
      boost::make_shared<geometry_msgs::PoseStamped>(stylus_pose(places, ros::Time::now())));
}

namespace {

constexpr Sheet kQuick{25}, kLarge{224}, kBrief{5};
constexpr std::size_t kBriefOrgans = 3;
constexpr std::size_t kLargeSteps = 8;  ///< from one appearance of the large organ to the next
constexpr double kPhaseStep = 0.02;     // [rad] from shape to shape

OrganVerticesPtr vertices_message(const std::string& organ, const Sheet& sheet, std::size_t cut,
                                  double phase) {
  const auto message = boost::make_shared<OrganVertices>();
  message->header.frame_id = "sheet";
  message->header.stamp = ros::Time::now();
  message->organ = organ;
  message->topology = static_cast<std::uint32_t>(cut);
  message->vertices = sheet.vertices(phase);
  return message;
}

OrganMeshPtr removal(const std::string& organ) {
  const auto message = boost::make_shared<OrganMesh>();
  message->header.frame_id = "sheet";
  message->organ = organ;
  return message;
}

}  // namespace

OrganTraffic::OrganTraffic()
    : meshes_(node_.advertise<OrganMesh>("organ_collision/organ_mesh", 10)),
      vertices_(node_.advertise<OrganVertices>("organ_collision/organ_vertices", 10)) {}

void OrganTraffic::move_quick() {
  quick_phase_ += kPhaseStep;
  vertices_.publish(vertices_message("quick", kQuick, 0, quick_phase_));
}

void OrganTraffic::restore_quick() { meshes_.publish(mesh_message("quick", kQuick, 0, 0.0)); }

void OrganTraffic::change_large() {
  const std::size_t step = large_step_++ % kLargeSteps;
  const std::size_t cut = step < kLargeSteps / 2 ? 0 : 100;
  const double phase = kPhaseStep * static_cast<double>(large_step_);
  if (step == kLargeSteps - 1) {
    meshes_.publish(removal("large"));
  } else if (step % (kLargeSteps / 2) == 0) {
    meshes_.publish(mesh_message("large", kLarge, cut, phase));
  } else {
    vertices_.publish(vertices_message("large", kLarge, cut, phase));
  }
}

void OrganTraffic::change_brief() {
  const std::size_t appears = brief_step_++ % kBriefOrgans, vanishes = brief_step_ % kBriefOrgans;
  const auto name = [](std::size_t number) { return "brief" + std::to_string(number); };
  meshes_.publish(mesh_message(name(appears), kBrief, 0, 0.0));
  meshes_.publish(removal(name(vanishes)));
}

Repeated::Repeated(double pause, std::function<void()> once)
    : once_(std::move(once)), thread_([this, pause] { work(pause); }) {}

Repeated::~Repeated() {
  stop_ = true;
  thread_.join();
}

void Repeated::work(double pause) const {
  while (!stop_) {
    once_();
    ros::WallDuration(pause).sleep();
  }
}

namespace {

constexpr double kTick = 1e-3;  // [s]
const ros::Duration kJump(1.0);
const ros::Time kEarliest(50.0);

}  // namespace

SimulatedClock::SimulatedClock() : clock_(node_.advertise<rosgraph_msgs::Clock>("/clock", 10)) {
  ticks_.emplace(kTick, [this] { publish(); });
}

void SimulatedClock::publish() {
  const ros::WallTime wall = ros::WallTime::now();
  now_ += ros::Duration((wall - last_).toSec());
  last_ = wall;
  if (jumps_.exchange(false) && now_ - kJump > kEarliest) now_ -= kJump;
  rosgraph_msgs::Clock message;
  message.clock = now_;
  clock_.publish(message);
}

}  // namespace organ_collision::stress
