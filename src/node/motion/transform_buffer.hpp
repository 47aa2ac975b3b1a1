#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace organ_collision {

/// [s] The interval over which velocities of frames are measured. TF interpolates between
/// transforms, so that for frames that come more rarely, the last two transforms count.
inline constexpr double kVelocitySec = 0.01;

/// The transforms between a target frame and another frame at one time. TF interpolates each of
/// them: its origin moves linearly, and it turns by slerp. Their product is T_target_frame.
struct FrameJoints {
  /// What tells whether the transforms are those between the same frames; empty: not known.
  std::vector<const void*> way = {};
  std::vector<Eigen::Isometry3d> poses = {};

  bool is_on_joints_of(const FrameJoints& other) const { return !way.empty() && way == other.way; }
};

/// The name of a frame, and when the last transform to its parent came, by the node's own clock.
struct LastTransform {
  std::string frame;
  ros::Time received;
};

/// TF's buffer with a record of the stamps of each frame's transforms, because tf2 does not tell
/// the stamps. Transforms that are set with setTransform() instead of add() are not in the record.
class TransformBuffer : public tf2::BufferCore {
 public:
  using Frames = std::vector<std::string>;

  /// Adds a transform; `resting`: it is static, as on /tf_static. Returns false if tf2 refuses it,
  /// or would refuse it because the frame has a transform with this stamp (has()), or one that is
  /// later by more than tf2 keeps transforms.
  /// Throws std::runtime_error for extreme stamps, as tf2 does.
  bool add(const geometry_msgs::TransformStamped& transform, const std::string& authority,
           bool resting = false);
  /// Whether the record has a transform of this frame, not a static one, with this stamp.
  bool has(const std::string& frame, ros::Time stamp) const;
  /// Forgets all transforms but the static ones, because their senders do not repeat them.
  void clear();
  /// The largest stamp of a transform that is not static; zero if there is none.
  ros::Time latest() const { return latest_; }
  /// Whether the record has a transform of this frame. Static transforms are not recorded.
  bool has_heard(const std::string& frame) const;
  /// The joints between two frames at a time at which their transform is known.
  FrameJoints joints(const std::string& target, const std::string& frame, ros::Time time) const;
  /// Notes why the last pose of a frame was refused; empty: it was taken.
  void set_refusal(const std::string& frame, const std::string& why) { refusals_[frame] = why; }
  /// Why the last pose of a frame was refused; empty if it was taken, or if none came.
  std::string refusal(const std::string& frame) const {
    const auto found = refusals_.find(frame);
    return found == refusals_.end() ? "" : found->second;
  }
  /// The stamps of the transforms between a target frame and some sources.
  struct Stamps {
    std::vector<ros::Time> rising;  ///< stamps in rising order, each once
    /// The latest stamp that was forgotten, because TF keeps no transform for so long, or because
    /// its frame had too many stamps; zero if there is none.
    ros::Time forgotten;
  };
  /// The stamps, after `from` and before `to`, of all transforms between `target` and any of
  /// `sources`.
  Stamps stamps_between(const std::string& target, const Frames& sources, ros::Time from,
                        ros::Time to) const;

  /// Whether `sources`, whose poses in the target frame are known up to `time`, count as moving on
  /// at `now`: no newer transform is overdue (organ_collision::goes_on()).
  bool goes_on(const std::string& target, const Frames& sources, ros::Time time,
               ros::Time now) const;

  /// Notes that the poses of `sources` in the target frame have been used up to the time `stamp`.
  void set_answered(const std::string& target, const Frames& sources, ros::Time stamp);
  /// How many transforms came late, after poses at or past their stamp had already been used.
  std::size_t late() const { return late_; }
  /// A frame between `target` and `sources` of which a transform came late, after the first `seen`
  /// of all that came late. Empty if there is none.
  std::string late_frame(const std::string& target, const Frames& sources, std::size_t seen) const;

  /// The frame in the chain from `frame` upwards whose last transform came first. Frames with only
  /// static transforms are left out. The chain ends below the first frame that also carries all of
  /// `others`, because from there on, both sides move together. Empty if no frame is left.
  std::optional<LastTransform> oldest_transform(const std::string& frame,
                                                const Frames& others) const;

 private:
  struct Frame;
  using Nodes = std::vector<const Frame*>;
  /// The record of a frame. A stamp that there is not is zero.
  struct Frame {
    std::string name = {};
    Nodes parents = {};                 ///< recent parents, the latest at the end
    std::deque<ros::Time> stamps = {};  ///< stamps of recent transforms, in rising order
    ros::Time received = {};            ///< when the last one came, by the node's own clock
    ros::Time advanced = {};            ///< when the largest stamp came, by the node's own clock
    ros::Time forgotten = {};           ///< the latest stamp that was forgotten
    ros::Time answered = {};            ///< poses were used up to this stamp
    std::size_t late = 0;               ///< the number of its last late transform among all
  };

  const Frame* find(const std::string& frame) const;
  void note(Frame& frame, ros::Time stamp);
  Nodes chain(const std::string& target, const Frames& sources) const;
  Nodes upward(const std::string& frame, std::size_t most) const;
  Nodes upward_at(const std::string& frame, ros::Time time) const;

  std::map<std::string, Frame> frames_;          ///< by name; the addresses of frames do not change
  std::map<std::string, std::string> refusals_;  ///< why the last pose was refused, by frame
  ros::Time latest_;                             ///< the largest stamp of all frames
  std::size_t late_ = 0;
};

/// A value and its time. Time zero means that the value is valid at any time, because it comes from
/// static transforms alone.
template <typename T>
struct Timed {
  T value;
  ros::Time stamp;
};

/// A value, or why TF does not have it. If TF does not have it, no other value takes its place.
template <typename T>
struct Lookup {
  std::optional<Timed<T>> found;
  std::string why_not;
  bool is_late = false;            ///< the newest transform is older than the time asked for
  std::string unknown_frame = {};  ///< the frame that is unknown to TF, if this is the reason
};

/// The transform T_target_source at a time. Time zero means the latest time at which all transforms
/// are known. The frame names must have no leading slash.
Lookup<Eigen::Isometry3d> look_up(const TransformBuffer& buffer, const std::string& target,
                                  const std::string& source, ros::Time time);

}  // namespace organ_collision
