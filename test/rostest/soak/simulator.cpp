#include "simulator.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/service.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <string>

#include "test/rostest/load/tool_messages.hpp"

namespace organ_collision::soak {
namespace {

// How often things happen, in a second of simulated time.
constexpr double kJumpsOfClock = 0.25, kCuts = 0.3, kFloods = 0.2, kBriefChanges = 10.0;
constexpr Tick kFarthestJump = 3000;
constexpr Tick kEarliest = 50'000;
constexpr int kFloodOfVertices = 30, kFloodOfPoses = 200;
constexpr std::size_t kBriefOrgans = 3;
constexpr stress::Sheet kBrief{5};

/// [messages] No pose may be lost on the way, or the judge would not know the path of a tool.
constexpr std::uint32_t kPoseQueue = 10'000;
constexpr std::uint32_t kOrganQueue = 10;

template <typename Message>
boost::shared_ptr<Message> organ_message(const std::string& organ, Tick tick) {
  const auto message = boost::make_shared<Message>();
  message->header.frame_id = "sheet";
  message->header.stamp = stamp_of(tick);
  message->organ = organ;
  return message;
}

}  // namespace

Simulator::Simulator(std::uint64_t seed)
    : script_(seed),
      random_(seed),
      clock_(node_.advertise<rosgraph_msgs::Clock>("/clock", 10)),
      transforms_(node_.advertise<tf2_msgs::TFMessage>("/tf", kPoseQueue)),
      static_transforms_(node_.advertise<tf2_msgs::TFMessage>("/tf_static", 10, /*latch=*/true)),
      stylus_(node_.advertise<geometry_msgs::PoseStamped>("/stylus", kPoseQueue)),
      meshes_(node_.advertise<OrganMesh>("organ_collision/organ_mesh", kOrganQueue)),
      vertices_(node_.advertise<OrganVertices>("organ_collision/organ_vertices", kOrganQueue)),
      jumps_(node_.advertise<rosgraph_msgs::Clock>(kJumps, kPoseQueue)) {}

bool Simulator::has_listener() const {
  const ros::Publisher all[] = {clock_,    transforms_, static_transforms_, stylus_, meshes_,
                                vertices_, jumps_};
  return std::all_of(std::begin(all), std::end(all), [](const ros::Publisher& publisher) {
    return publisher.getNumSubscribers() > 0;
  });
}

bool Simulator::scene_has_come() const {
  ListOrgans list;
  return ros::service::call("organ_collision/list_organs", list) && !list.response.organs.empty();
}

void Simulator::send_scene() {
  tf2_msgs::TFMessage trocars;
  trocars.transforms = stress::resting_transforms(stamp_of(tick_));
  static_transforms_.publish(trocars);
  while (script_.glitch(tick_) != Glitch::kNone) ++tick_;
  send_mesh();
}

void Simulator::tick() {
  if (happens(kJumpsOfClock)) jump();
  // The vertices of a tick are the same in each message.
  if (happens(kCuts) && script_.glitch(tick_) == Glitch::kNone) {
    ++topology_;
    ++sent_.cuts;
    send_mesh();
  }
  if (happens(kBriefChanges)) change_brief_organs();
  if (happens(kFloods)) flood();
  send_tick();
}

void Simulator::calm_tick() {
  change_brief_organs();
  send_tick();
}

void Simulator::send_tick() {
  ++tick_;
  ++sent_.ticks;
  lag_.add(tick_);
  rosgraph_msgs::Clock clock;
  clock.clock = stamp_of(tick_);
  clock_.publish(clock);
  send_poses();
  send_vertices();
}

void Simulator::send_poses() {
  if (!script_.has_poses(tick_)) {
    ++sent_.gap_ticks;
    return;
  }
  const stress::ToolPlaces places = script_.tools(tick_);
  tf2_msgs::TFMessage transforms;
  transforms.transforms = stress::moving_transforms(places, stamp_of(tick_));
  transforms_.publish(transforms);
  stylus_.publish(stress::stylus_pose(places, stamp_of(tick_)));
}

void Simulator::send_mesh() {
  const auto mesh = organ_message<OrganMesh>("sheet", tick_);
  mesh->topology = topology_;
  mesh->vertices = script_.vertices(tick_);
  mesh->triangles = script_.triangles(topology_);
  meshes_.publish(mesh);
  ++sent_.meshes;
}

void Simulator::send_vertices() {
  const auto message = organ_message<OrganVertices>("sheet", tick_);
  message->topology = topology_;
  message->vertices = script_.vertices(tick_);
  sent_.glitches += script_.glitch(tick_) != Glitch::kNone;
  vertices_.publish(message);
  ++sent_.vertices;
}

/// One of several organs appears, and another one vanishes.
void Simulator::change_brief_organs() {
  const auto name = [](std::uint64_t number) {
    return "brief" + std::to_string(number % kBriefOrgans);
  };
  meshes_.publish(stress::mesh_message(name(brief_), kBrief, 0, 0.0));
  ++brief_;
  meshes_.publish(organ_message<OrganMesh>(name(brief_), tick_));
  sent_.meshes += 2;
}

/// The same vertices and poses again and again. The vertices are more than the queue takes.
void Simulator::flood() {
  ++sent_.floods;
  for (int i = 0; i < kFloodOfVertices; ++i) send_vertices();
  if (!script_.has_poses(tick_)) return;
  for (int i = 0; i < kFloodOfPoses; ++i) {
    stylus_.publish(stress::stylus_pose(script_.tools(tick_), stamp_of(tick_)));
  }
}

void Simulator::jump() {
  ++sent_.jumps;
  const Tick by = std::uniform_int_distribution<Tick>(200, kFarthestJump)(random_);
  const bool back = random_() % 2 == 0 && tick_ - by > kEarliest;
  if (back) {
    rosgraph_msgs::Clock before;
    before.clock = stamp_of(tick_);
    jumps_.publish(before);
  }
  tick_ += back ? -by : by;
}

bool Simulator::happens(double times_per_second) {
  return std::uniform_real_distribution<>()(random_) < times_per_second / 1000.0;
}

}  // namespace organ_collision::soak
