#pragma once

#include <ros/time.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "ros/organs/deformable_organ.hpp"

namespace organ_collision {

/// Does not stand still with simulated time.
using SteadyTime = std::chrono::steady_clock::time_point;

/// Where the last evaluation that succeeded ended; the next step begins there.
struct LastStep {
  ToolPose pose;
  ros::Time stamp;
  std::shared_ptr<const TriangleMesh> mesh;
};

/// Shapes of an organ that one tool has yet to be evaluated against: the one that waits for its
/// transform, and the newest behind it. The first is not replaced by newer ones: else it would
/// never be evaluated where transforms lag by more than the time between two shapes.
class ShapeQueue {
 public:
  struct Entry {
    OrganShape shape;
    SteadyTime arrival;
  };

  void push(Entry entry) { (waiting_ ? newest_ : waiting_) = std::move(entry); }
  /// The shape to evaluate next; null: none.
  const Entry* front() const { return waiting_ ? &*waiting_ : nullptr; }
  void pop();
  void clear();

 private:
  std::optional<Entry> waiting_;
  std::optional<Entry> newest_;
};

/// What is known of one organ and one tool.
struct OrganToolPair {
  std::optional<LastStep> last;
  /// The organ as this tool sees it: its shape at the last evaluation, failed or not.
  OrganShape current;
  ShapeQueue queue;
};

/// The history of each pair of organ and tool.
class StepHistory {
 public:
  using Pairs = std::map<std::pair<std::string, std::size_t>, OrganToolPair>;

  OrganToolPair& of(const std::string& organ, std::size_t tool) { return pairs_[{organ, tool}]; }
  /// Null: never evaluated.
  const LastStep* last(const std::string& organ, std::size_t tool) const;

  void forget(const std::string& organ);
  void clear() { pairs_.clear(); }

  Pairs& pairs() { return pairs_; }
  const Pairs& pairs() const { return pairs_; }

 private:
  Pairs pairs_;
};

}  // namespace organ_collision
