#include <geometry_msgs/PoseStamped.h>
#include <organ_collision/ContactArray.h>
#include <organ_collision/ListOrgans.h>
#include <organ_collision/OrganMesh.h>
#include <organ_collision/OrganVertices.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service.h>
#include <ros/spinner.h>
#include <rosgraph_msgs/Clock.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <atomic>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <thread>

#include "load.hpp"
#include "soak_script.hpp"

namespace organ_collision::soak {

/// How far the node is behind the simulator. If it is so far behind that its queues of poses would
/// overflow, poses would be lost without a word, as roscpp does it, and the judge could not know
/// the paths of the tools. The simulator waits then.
class Lag {
 public:
  Lag();

  /// Notes that a tick was sent.
  void add(Tick tick);
  /// In ticks, however the clock has jumped.
  std::uint64_t ticks() const;

 private:
  void take(const ContactArray& answer);

  mutable std::mutex mutex_;
  std::map<Tick, std::uint64_t> sent_;  ///< by tick: the number of ticks sent up to it
  std::uint64_t count_ = 0, answered_ = 0;
  ros::NodeHandle node_;
  ros::Subscriber contacts_;
};

namespace {

/// Older ticks are forgotten.
constexpr std::uint64_t kKept = 20'000;

}  // namespace

Lag::Lag()
    : contacts_(node_.subscribe<ContactArray>(
          "organ_collision/contacts", 1000,
          [this](const ContactArrayConstPtr& answer) { take(*answer); })) {}

void Lag::add(Tick tick) {
  const std::lock_guard lock(mutex_);
  sent_[tick] = ++count_;
  if (sent_.size() <= 2 * kKept) return;
  for (auto sent = sent_.begin(); sent != sent_.end();) {
    sent = sent->second + kKept < count_ ? sent_.erase(sent) : std::next(sent);
  }
}

std::uint64_t Lag::ticks() const {
  const std::lock_guard lock(mutex_);
  return count_ - answered_;
}

void Lag::take(const ContactArray& answer) {
  const std::lock_guard lock(mutex_);
  for (const ros::Time stamp : {answer.header.stamp, answer.mesh_stamp}) {
    const auto sent = sent_.find(tick_of(stamp));
    if (sent != sent_.end()) answered_ = std::max(answered_, sent->second);
  }
}

/// What the simulator has sent.
struct Sent {
  std::uint64_t ticks = 0, meshes = 0, vertices = 0;
  std::uint64_t jumps = 0, floods = 0, cuts = 0, gap_ticks = 0, glitches = 0;
};

/// Sends the clock, the organ and the tools of each tick, and disturbs the node: the clock jumps,
/// the organ is cut, other organs come and go, messages come in floods. What happens when depends
/// only on the seed.
class Simulator {
 public:
  explicit Simulator(std::uint64_t seed);

  /// Whether the node and the judge listen to everything.
  bool has_listener() const;
  /// Sends what the node keeps: the trocars and the organ.
  void send_scene();
  /// Whether the node knows the organ. Before, vertices may overtake the mesh, because they come
  /// over another connection.
  bool scene_has_come() const;
  /// One tick, with disturbances.
  void tick();
  /// One tick without disturbances. The last message of each topic tells the node how many
  /// it has missed.
  void calm_tick();

  /// How many ticks the node is behind.
  std::uint64_t lag() const { return lag_.ticks(); }

  const Sent& sent() const { return sent_; }

 private:
  void send_tick();
  void send_poses();
  void send_mesh();
  void send_vertices();
  void change_brief_organs();
  void flood();
  void jump();
  bool happens(double times_per_second);

  Script script_;
  std::mt19937_64 random_;
  ros::NodeHandle node_;
  ros::Publisher clock_, transforms_, static_transforms_, stylus_, meshes_, vertices_, jumps_;
  Tick tick_ = 100'000;
  std::uint32_t topology_ = 0;
  std::uint64_t brief_ = 0;
  Sent sent_;
  Lag lag_;
};

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

// The simulator of run_soak. It begins when a node listens, and prints an empty line. At the line
// "end" on standard input, it ends calmly, and prints as JSON what it has sent. It stays until
// standard input is closed, so that nothing of it is lost on the way.

namespace {

using namespace organ_collision::soak;
using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

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

template <typename Condition>
bool wait_for(const Condition& condition) {
  const auto give_up = SteadyClock::now() + kStart;
  while (!condition()) {
    if (SteadyClock::now() > give_up) return false;
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

void wait_for_node(const Simulator& simulator, std::uint64_t most_lag,
                   SteadyClock::duration longest) {
  const auto give_up = SteadyClock::now() + longest;
  while (simulator.lag() > most_lag && SteadyClock::now() < give_up) {
    std::this_thread::sleep_for(kTick);
  }
}

void print(const Sent& sent) {
  std::cout << "{\"ticks\": " << sent.ticks << ", \"meshes\": " << sent.meshes
            << ", \"vertices\": " << sent.vertices << ", \"jumps\": " << sent.jumps
            << ", \"floods\": " << sent.floods << ", \"cuts\": " << sent.cuts
            << ", \"ticks without poses\": " << sent.gap_ticks
            << ", \"glitches\": " << sent.glitches << "}" << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "simulator");
  if (argc != 2) {
    std::cerr << "Usage: soak_simulator SEED\n";
    return 2;
  }
  Simulator simulator(std::strtoull(argv[1], nullptr, 10));
  if (!wait_for([&] { return simulator.has_listener(); })) {
    std::cerr << "soak_simulator: no node listens\n";
    return 1;
  }
  ros::AsyncSpinner spinner(1);
  spinner.start();
  simulator.send_scene();
  if (!wait_for([&] { return simulator.scene_has_come(); })) {
    std::cerr << "soak_simulator: the node does not know the organ\n";
    return 1;
  }
  // The node counts losses from the first message that it gets. It must be the first one of all.
  simulator.calm_tick();
  wait_for_node(simulator, 0, kStart);
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
    wait_for_node(simulator, kMostLag, kLongestWait);
    next += kTick;
    if (SteadyClock::now() > next + kLatest) next = SteadyClock::now();
    std::this_thread::sleep_until(next);
  }
  input.join();
  for (int i = 0; i < kCalmTicks; ++i) {
    simulator.calm_tick();
    std::this_thread::sleep_for(kCalmTick);
  }
  print(simulator.sent());
  std::getline(std::cin, line);
  return 0;
}
