#pragma once

#include <organ_collision/ContactArray.h>
#include <organ_collision/ProxyState.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "ros/motion/tool_poses.hpp"

namespace organ_collision {

/// What a proxy did, for a line each second and a summary.
class ProxyTally {
 public:
  void add(const ProxyState& state);

  /// "TOUCHING, up to 1.2 N, 998 poses/s", about the last `seconds`: the latest state, and the
  /// greatest force. Begins to count anew.
  std::string take_line(double seconds);
  /// "30012 poses, tissue held the proxy in 45% of them, with at most 1.8 N; 24 us a tick on
  /// average"
  std::string summary() const;
  /// The number of poses that had an answer.
  std::size_t answered() const { return answered_; }

 private:
  std::uint8_t state_ = ProxyState::NO_ANSWER;
  std::string message_;
  // Since the last line.
  std::size_t poses_ = 0;
  double force_ = 0.0;  ///< [N]
  // In all.
  std::size_t answered_ = 0, held_ = 0;
  double greatest_ = 0.0;  ///< [N]
  double tick_sec_ = 0.0;  ///< [s] of all ticks
};

/// Counts the contacts that a static test at the same instants would have missed. These are the
/// contacts whose face is farther from the axis than the radius when the step ends. Uses exact
/// distances, from the shapes and transforms on the topics, without the collision node.
class StaticComparison {
 public:
  struct Tally {
    std::size_t contacts = 0;
    std::size_t missed_by_static = 0;
  };

  /// `transforms` must outlive this object.
  StaticComparison(std::vector<ToolParameters> tools, TransformBuffer& transforms);

  /// `triangles`: three vertex indices for each face.
  void set_triangles(std::vector<std::uint32_t> triangles) { triangles_ = std::move(triangles); }
  /// `vertices`: x y z x y z ... [m], of the shape at `stamp`. Keeps the shapes of a few seconds.
  void add_shape(const ros::Time& stamp, std::vector<float> vertices);
  /// Adds an answer with status OK. It waits until its shape and its tool's pose have arrived.
  void add_answer(const ContactArrayConstPtr& answer);

  /// By name of the tool, for the answers compared so far.
  const std::map<std::string, Tally>& tallies() const { return tallies_; }
  /// The number of answers whose shape or pose has not arrived yet.
  std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Shape {
    ros::Time stamp;
    std::vector<float> vertices;
  };

  void compare_waiting();
  bool compare(const ContactArray& answer);
  Triangle face(const Shape& shape, std::uint32_t number) const;

  std::vector<Tool> tools_;
  ToolPoses poses_;
  std::vector<std::uint32_t> triangles_;
  std::deque<Shape> shapes_;
  std::deque<ContactArrayConstPtr> waiting_;
  std::map<std::string, Tally> tallies_;
};

}  // namespace organ_collision
