#pragma once

// The program `soak`: what the simulator sends is a script, from which the judge evaluates answers
// a second time.

#include <organ_collision/ContactArray.h>
#include <ros/time.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

namespace organ_collision::soak {

/// A millisecond of simulated time. All that the simulator sends depends only on the tick and on
/// the seed, also where the clock jumps. Therefore the judge knows what an answer is about from the
/// answer's stamps.
using Tick = std::int64_t;

/// The stamp of a tick, and back.
inline ros::Time stamp_of(Tick tick) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(tick) * 1'000'000U);
}
inline Tick tick_of(ros::Time stamp) { return static_cast<Tick>(stamp.toNSec() / 1'000'000U); }

/// On this topic, the simulator tells the time before each jump back of the clock.
inline constexpr char kJumps[] = "/soak/jumps";

/// A wavy square sheet of 0.1 m around the origin, with `cells` times `cells` squares of two faces.
struct Sheet {
  std::size_t cells;

  /// x y z x y z ... [m]. `phase` [rad] moves the waves on.
  std::vector<float> vertices(double phase) const;
  /// Without the first `cut` squares: a sheet that was cut has other triangles.
  std::vector<std::uint32_t> triangles(std::size_t cut) const;
};

/// Where the tools of soak.py are, in the frame "sheet" [m]. They go up and down through the
/// sheet, and the jaw turns.
struct ToolPlaces {
  Eigen::Vector3d probe_tip, needle_tip, stylus_tip;
  Eigen::Isometry3d jaw;
};

inline const Eigen::Vector3d kProbeTrocar{0.02, 0.01, 0.15};
inline const Eigen::Vector3d kNeedleTrocar{-0.02, 0.01, 0.15};
inline const Eigen::Vector3d kStylusTrocar{0.01, -0.02, 0.15};

/// What is wrong with the shape of a tick.
enum class Glitch {
  kNone,
  kSpike,     ///< one vertex is far off; legal
  kHuge,      ///< one vertex is too far off; illegal
  kNotFinite  ///< one vertex is not a number; illegal
};

/// What happens at each tick.
class Script {
 public:
  explicit Script(std::uint64_t seed);

  /// The organ: a sheet of 100 352 faces, in which each cut leaves a larger or smaller hole.
  /// The tick's glitch is in its vertices.
  std::vector<float> vertices(Tick tick) const;
  std::vector<std::uint32_t> triangles(std::uint32_t topology) const;
  Glitch glitch(Tick tick) const;

  ToolPlaces tools(Tick tick) const;
  /// False in gaps, in which no tool sends a pose.
  bool has_poses(Tick tick) const;

 private:
  /// A random number for each tick (or block of ticks) and each purpose.
  std::uint64_t draw(Tick tick, std::uint64_t purpose) const;

  std::uint64_t seed_;
  std::vector<std::vector<float>> shapes_;  ///< of one wave, again and again
};

/// An answer about the organ of the script, and the answer before it of the same tool, where its
/// step began. A static answer needs none.
struct AnsweredStep {
  ContactArrayConstPtr answer, before;
};

/// Why a step cannot be evaluated again; empty: it can. It is too long, so that the node may have
/// left out poses, or it begins or ends in a gap between poses.
std::string why_not_checkable(const Script& script, const AnsweredStep& step);

/// What is wrong with the contacts of an answer; empty: nothing; std::nullopt: the search could not
/// decide. The oracle of test/proof evaluates the step again, from the script alone: each contact
/// touches at its time, and no other face comes within the tool at any time of the step. Both by
/// exact distances or by a search that bounds them; up to 1e-7 m for shafts, and 1.1e-6 m for
/// links.
std::optional<std::string> wrong_contacts(const Script& script, const AnsweredStep& step);

/// The simulator. It begins when a node listens, and prints an empty line. At the line "end" on
/// standard input, it ends calmly, and prints as JSON what it has sent. It stays until standard
/// input is closed, so that nothing of it is lost on the way. Returns an exit code.
int simulate(std::uint64_t seed);

/// The judge. It prints an empty line when the node publishes. At each line on standard input, it
/// prints a report as JSON. It ends when standard input is closed. Returns an exit code.
int judge(std::uint64_t seed);

/// Waits for at most a minute. Returns whether the condition holds.
template <typename Condition>
bool wait_for(const Condition& condition) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > give_up) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// Prints the entries of a map as a JSON object.
template <typename Map>
void print_json(std::ostream& out, const Map& map) {
  out << '{';
  const char* separator = "";
  for (const auto& [key, value] : map) {
    out << separator << '"' << key << "\": " << value;
    separator = ", ";
  }
  out << '}';
}

}  // namespace organ_collision::soak
