#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <atomic>
#include <boost/make_shared.hpp>
#include <chrono>
#include <iostream>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <thread>

#include "soak.hpp"

namespace organ_collision::soak {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

// How often things happen, in a second of simulated time.
constexpr double kJumpsOfClock = 0.25, kCutMessages = 0.3, kFloods = 0.2, kBriefChanges = 10.0;
constexpr Tick kFarthestJump = 3000;
constexpr Tick kEarliest = 50'000;
constexpr int kFloodOfVertices = 30, kFloodOfPoses = 200;
constexpr std::size_t kBriefOrgans = 3;
constexpr Sheet kBrief{5};

/// [messages] No pose may be lost on the way, or the judge would not know the path of a tool.
constexpr std::uint32_t kPoseQueue = 10'000;
constexpr std::uint32_t kOrganQueue = 10;

constexpr auto kTick = 1ms;  ///< of wall time
/// A simulator that is late by more than this does not make up for it.
constexpr auto kLatest = 10ms;
/// [ticks] If the node is farther behind, the simulator waits for it, but not longer than this.
/// With a flood, the node's queues of 1000 poses then do not overflow.
constexpr std::uint64_t kMostLag = 500;
constexpr auto kLongestWait = 5s;
constexpr int kCalmTicks = 40;
constexpr auto kCalmTick = 50ms;
constexpr auto kStart = 60s;

geometry_msgs::TransformStamped transform(const std::string& frame, Tick tick,
                                          const Eigen::Isometry3d& pose) {
  geometry_msgs::TransformStamped transform = tf2::eigenToTransform(pose);
  transform.header.frame_id = "sheet";
  transform.header.stamp = stamp_of(tick);
  transform.child_frame_id = frame;
  return transform;
}

Eigen::Isometry3d at(const Eigen::Vector3d& point) {
  return Eigen::Isometry3d(Eigen::Translation3d(point));
}

geometry_msgs::PoseStamped stylus_pose(const ToolPlaces& places, Tick tick) {
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = "sheet";
  pose.header.stamp = stamp_of(tick);
  pose.pose = tf2::toMsg(at(places.stylus_tip));
  return pose;
}

template <typename Message>
boost::shared_ptr<Message> organ_message(const std::string& organ, ros::Time stamp) {
  const auto message = boost::make_shared<Message>();
  message->header.frame_id = "sheet";
  message->header.stamp = stamp;
  message->organ = organ;
  return message;
}

/// How far the node is behind the simulator. If it is so far behind that its queues of poses would
/// overflow, poses would be lost without a word, as roscpp does it, and the judge could not know
/// the paths of the tools. The simulator waits then.
class Lag {
 public:
  Lag()
      : contacts_(node_.subscribe<ContactArray>(
            "organ_collision/contacts", 1000,
            [this](const ContactArrayConstPtr& answer) { take(*answer); })) {}

  /// Notes that a tick was sent.
  void add(Tick tick) {
    const std::lock_guard lock(mutex_);
    sent_[tick] = ++count_;
    if (sent_.size() <= 2 * kKept) return;
    for (auto sent = sent_.begin(); sent != sent_.end();) {
      sent = sent->second + kKept < count_ ? sent_.erase(sent) : std::next(sent);
    }
  }

  /// Waits until the node is at most so many ticks behind, however the clock has jumped.
  void wait_for_node(std::uint64_t most, SteadyClock::duration longest) const {
    const auto give_up = SteadyClock::now() + longest;
    while (ticks() > most && SteadyClock::now() < give_up) std::this_thread::sleep_for(kTick);
  }

 private:
  static constexpr std::uint64_t kKept = 20'000;  ///< Older ticks are forgotten.

  std::uint64_t ticks() const {
    const std::lock_guard lock(mutex_);
    return count_ - answered_;
  }
  void take(const ContactArray& answer) {
    const std::lock_guard lock(mutex_);
    for (const ros::Time stamp : {answer.header.stamp, answer.mesh_stamp}) {
      const auto sent = sent_.find(tick_of(stamp));
      if (sent != sent_.end()) answered_ = std::max(answered_, sent->second);
    }
  }

  mutable std::mutex mutex_;
  std::map<Tick, std::uint64_t> sent_;  ///< by tick: the number of ticks sent up to it
  std::uint64_t count_ = 0, answered_ = 0;
  ros::NodeHandle node_;
  ros::Subscriber contacts_;
};

/// Sends the clock, the organ and the tools of each tick, and disturbs the node: the clock jumps,
/// the organ is cut, other organs come and go, messages come in floods. What happens when depends
/// only on the seed.
class Simulator {
 public:
  explicit Simulator(std::uint64_t seed)
      : script_(seed),
        random_(seed),
        clock_(node_.advertise<rosgraph_msgs::Clock>("/clock", 10)),
        transforms_(node_.advertise<tf2_msgs::TFMessage>("/tf", kPoseQueue)),
        static_transforms_(node_.advertise<tf2_msgs::TFMessage>("/tf_static", 10, /*latch=*/true)),
        stylus_(node_.advertise<geometry_msgs::PoseStamped>("/stylus", kPoseQueue)),
        meshes_(node_.advertise<OrganMesh>("organ_collision/organ_mesh", kOrganQueue)),
        vertices_(node_.advertise<OrganVertices>("organ_collision/organ_vertices", kOrganQueue)),
        jumps_(node_.advertise<rosgraph_msgs::Clock>(kJumps, kPoseQueue)) {}

  /// Whether the node and the judge listen to everything.
  bool has_listener() const {
    const ros::Publisher all[] = {clock_,    transforms_, static_transforms_, stylus_, meshes_,
                                  vertices_, jumps_};
    return std::all_of(std::begin(all), std::end(all), [](const ros::Publisher& publisher) {
      return publisher.getNumSubscribers() > 0;
    });
  }

  /// Sends what the node keeps: the trocars and the organ.
  void send_scene() {
    tf2_msgs::TFMessage trocars;
    trocars.transforms = {transform("probe_trocar", tick_, at(kProbeTrocar)),
                          transform("needle_trocar", tick_, at(kNeedleTrocar)),
                          transform("stylus_trocar", tick_, at(kStylusTrocar))};
    static_transforms_.publish(trocars);
    while (script_.glitch(tick_) != Glitch::kNone) ++tick_;
    send_mesh();
  }

  /// Whether the node knows the organ. Before, vertices may overtake the mesh, because they come
  /// over another connection.
  static bool scene_has_come() {
    ListOrgans list;
    return ros::service::call("organ_collision/list_organs", list) && !list.response.organs.empty();
  }

  /// One tick, with disturbances.
  void tick() {
    if (happens(kJumpsOfClock)) jump();
    // The vertices of a tick are the same in each message.
    if (happens(kCutMessages) && script_.glitch(tick_) == Glitch::kNone) {
      ++topology_;
      ++sent_["cuts"];
      send_mesh();
    }
    if (happens(kBriefChanges)) change_brief_organs();
    if (happens(kFloods)) flood();
    send_tick();
    lag_.wait_for_node(kMostLag, kLongestWait);
  }

  /// One tick without disturbances. The last message of each topic tells the node how many
  /// it has missed.
  void calm_tick() {
    change_brief_organs();
    send_tick();
  }

  /// Waits until the node has answered the last tick.
  void wait_for_node() const { lag_.wait_for_node(0, kStart); }

  /// How many were sent, by what it is.
  const std::map<std::string, std::uint64_t>& sent() const { return sent_; }

 private:
  void send_tick() {
    ++tick_;
    ++sent_["ticks"];
    lag_.add(tick_);
    rosgraph_msgs::Clock clock;
    clock.clock = stamp_of(tick_);
    clock_.publish(clock);
    send_poses();
    send_vertices();
  }

  void send_poses() {
    if (!script_.has_poses(tick_)) {
      ++sent_["ticks without poses"];
      return;
    }
    const ToolPlaces places = script_.tools(tick_);
    tf2_msgs::TFMessage transforms;
    transforms.transforms = {transform("probe_tip", tick_, at(places.probe_tip)),
                             transform("needle_tip", tick_, at(places.needle_tip)),
                             transform("jaw", tick_, places.jaw)};
    transforms_.publish(transforms);
    stylus_.publish(stylus_pose(places, tick_));
  }

  void send_mesh() {
    const auto mesh = organ_message<OrganMesh>("sheet", stamp_of(tick_));
    mesh->topology = topology_;
    mesh->vertices = script_.vertices(tick_);
    mesh->triangles = script_.triangles(topology_);
    meshes_.publish(mesh);
    ++sent_["meshes"];
  }

  void send_vertices() {
    const auto message = organ_message<OrganVertices>("sheet", stamp_of(tick_));
    message->topology = topology_;
    message->vertices = script_.vertices(tick_);
    sent_["glitches"] += script_.glitch(tick_) != Glitch::kNone;
    vertices_.publish(message);
    ++sent_["vertices"];
  }

  /// One of several organs appears, and another one vanishes.
  void change_brief_organs() {
    const auto name = [](std::uint64_t number) {
      return "brief" + std::to_string(number % kBriefOrgans);
    };
    const auto mesh = organ_message<OrganMesh>(name(brief_), ros::Time::now());
    mesh->vertices = kBrief.vertices(0.0);
    mesh->triangles = kBrief.triangles(0);
    meshes_.publish(mesh);
    ++brief_;
    meshes_.publish(organ_message<OrganMesh>(name(brief_), stamp_of(tick_)));
    sent_["meshes"] += 2;
  }

  /// The same vertices and poses again and again. The vertices are more than the queue takes.
  void flood() {
    ++sent_["floods"];
    for (int i = 0; i < kFloodOfVertices; ++i) send_vertices();
    if (!script_.has_poses(tick_)) return;
    for (int i = 0; i < kFloodOfPoses; ++i) {
      stylus_.publish(stylus_pose(script_.tools(tick_), tick_));
    }
  }

  void jump() {
    ++sent_["jumps"];
    const Tick by = std::uniform_int_distribution<Tick>(200, kFarthestJump)(random_);
    const bool back = random_() % 2 == 0 && tick_ - by > kEarliest;
    if (back) {
      rosgraph_msgs::Clock before;
      before.clock = stamp_of(tick_);
      jumps_.publish(before);
    }
    tick_ += back ? -by : by;
  }

  bool happens(double times_per_second) {
    return std::uniform_real_distribution<>()(random_) < times_per_second / 1000.0;
  }

  Script script_;
  std::mt19937_64 random_;
  ros::NodeHandle node_;
  ros::Publisher clock_, transforms_, static_transforms_, stylus_, meshes_, vertices_, jumps_;
  Tick tick_ = 100'000;
  std::uint32_t topology_ = 0;
  std::uint64_t brief_ = 0;
  std::map<std::string, std::uint64_t> sent_;
  Lag lag_;
};

}  // namespace

int simulate(std::uint64_t seed) {
  Simulator simulator(seed);
  if (!wait_for([&] { return simulator.has_listener(); })) {
    std::cerr << "soak: no node listens\n";
    return 1;
  }
  ros::AsyncSpinner spinner(1);
  spinner.start();
  simulator.send_scene();
  if (!wait_for(Simulator::scene_has_come)) {
    std::cerr << "soak: the node does not know the organ\n";
    return 1;
  }
  // The node counts losses from the first message that it gets. It must be the first one of all.
  simulator.calm_tick();
  simulator.wait_for_node();
  std::cout << std::endl;

  std::atomic<bool> ends = false;
  std::string line;
  std::thread input([&] {
    std::getline(std::cin, line);
    ends = true;
  });
  auto next = SteadyClock::now();
  while (!ends) {
    simulator.tick();
    next += kTick;
    if (SteadyClock::now() > next + kLatest) next = SteadyClock::now();
    std::this_thread::sleep_until(next);
  }
  input.join();
  for (int i = 0; i < kCalmTicks; ++i) {
    simulator.calm_tick();
    std::this_thread::sleep_for(kCalmTick);
  }
  print_json(std::cout, simulator.sent());
  std::cout << std::endl;
  std::getline(std::cin, line);
  return 0;
}

}  // namespace organ_collision::soak
