#pragma once

#include <organ_collision/ContactArray.h>

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "ros/motion/tool_poses.hpp"

namespace organ_collision {

/// How many of the contacts found a static test at the same instants would have missed: those whose
/// face is farther than the radius from the axis when the step ends. By exact distances, from the
/// shapes and transforms on the topics, without the collision node.
class StaticComparison {
 public:
  struct Tally {
    std::size_t contacts = 0;
    std::size_t missed_by_static = 0;
  };

  /// `transforms` must outlive it.
  StaticComparison(std::vector<ToolParameters> tools, TransformBuffer& transforms);

  /// `triangles`: three vertex indices a face.
  void set_triangles(std::vector<std::uint32_t> triangles) { triangles_ = std::move(triangles); }
  /// `vertices`: x y z x y z ... [m], of the shape at `stamp`. The last few seconds are kept.
  void add_shape(const ros::Time& stamp, std::vector<float> vertices);
  /// An answer with status OK. It waits until its shape and its tool's pose are there.
  void add_answer(const ContactArrayConstPtr& answer);

  /// Of each tool by name, of the answers compared so far.
  const std::map<std::string, Tally>& tallies() const { return tallies_; }
  /// Answers whose shape or pose has not come yet.
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
