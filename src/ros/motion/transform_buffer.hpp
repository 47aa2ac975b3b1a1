#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "stamp_record.hpp"

namespace organ_collision {

/// TF's buffer, with a record of what it keeps to itself: at which stamps it was told where each
/// frame is. What is set by its setTransform alone is read as ever, but is not in the record.
class TransformBuffer : public tf2::BufferCore {
 public:
  using Frames = std::vector<std::string>;

  /// Takes a transform; `resting`: of all times, as on /tf_static. False: TF refused it. Throws
  /// std::runtime_error at absurd stamps, as TF does.
  bool add(const geometry_msgs::TransformStamped& transform, const std::string& authority,
           bool resting = false);
  /// Forgets all that moves, as TF does: what rests is not sent again.
  void clear();

  /// Whether a transform moved the frame lately.
  bool has_heard(const std::string& frame) const;
  /// The stamps after `from` and before `to` of all transforms between a frame and any of
  /// `sources`. Rising, each once.
  std::vector<ros::Time> stamps_between(const std::string& target, const Frames& sources,
                                        ros::Time from, ros::Time to) const;

  /// Where `sources` are in the target frame has been answered for, up to `stamp`.
  void set_answered(const std::string& target, const Frames& sources, ros::Time stamp);
  /// How many transforms came after what they belong to had been answered for.
  std::size_t late() const { return late_; }

 private:
  struct Frame {
    StampRecord stamps;
    ros::Time answered;                ///< zero: never
    std::vector<std::size_t> parents;  ///< that it had lately
  };
  using Indices = std::vector<std::size_t>;

  std::size_t index_of(const std::string& frame);
  Indices chain(const std::string& target, const Frames& sources) const;
  Indices upward(const std::string& frame) const;
  bool is_line(const Indices& frames) const;

  std::map<std::string, std::size_t> indices_;  ///< into frames_, by name
  std::vector<Frame> frames_;
  std::size_t late_ = 0;
};

}  // namespace organ_collision
