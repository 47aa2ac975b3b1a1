#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>
#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "node/parameters/node_parameters.hpp"
#include "transform_buffer.hpp"

namespace organ_collision {

/// Receives /tf and /tf_static into the node's buffer, and the poses of tool tips that are sent as
/// PoseStamped, for example CRTK's measured_cp. Each pose becomes a transform to the tool's tip
/// frame, so that the rest of the node treats these tools like those on TF.
class MotionTopics {
 public:
  /// Called with a tool's index after each pose of its tip from a topic.
  using Arrived = std::function<void(std::size_t tool)>;

  /// `transforms` and `rejected` must outlive this object. Transforms and poses whose stamps are
  /// more than `max_ahead_sec` ahead of the clock are refused.
  MotionTopics(const std::vector<ToolParameters>& tools, TransformBuffer& transforms,
               FailureLog& rejected, Arrived arrived, double max_ahead_sec = kMaxAheadDefault);
  MotionTopics(const MotionTopics&) = delete;  ///< The subscriptions refer to this.

  /// Subscribes to TF and to the topics that the tools name; `node` resolves their names.
  void subscribe(const ros::NodeHandle& node);
  /// Takes a new list of tools. The subscriptions of tools with the same name, tip frame and topics
  /// stay, so that no pose is lost. Throws std::runtime_error if a topic cannot be subscribed to;
  /// then nothing has changed.
  void change_tools(const std::vector<ToolParameters>& tools, const ros::NodeHandle& node);

  /// Adds the transforms of a message. A transform that tf2 refuses, or whose stamp is too far
  /// ahead of the clock, is counted as rejected. A transform whose frame and stamp are known is
  /// left out. It is counted only if it has another pose, because senders repeat transforms.
  /// `authority`: the sender. `resting`: the message is from /tf_static.
  void take_transforms(const tf2_msgs::TFMessage& message, const std::string& authority,
                       bool resting);
  /// Takes a pose of the tool's tip (take_tip()), or of the frame in which the tip's poses are
  /// given (take_base()). An illegal pose is counted as rejected, and the last legal pose stays.
  void take_tip(std::size_t tool, const geometry_msgs::PoseStamped& pose);
  void take_base(std::size_t tool, const geometry_msgs::PoseStamped& pose);

  /// To be called when the clock has jumped back: forgets the stamps of the last poses.
  void forget_stamps();

 private:
  struct Stream {
    std::size_t index;  ///< index of the tool
    ToolParameters tool;
    std::string frame = {};  ///< frame of the tip's poses; empty: no pose came yet
    ros::Time latest = {};   ///< stamp of the tip's last pose; zero: no pose came yet
    std::optional<geometry_msgs::PoseStamped> base = {};  ///< last pose of `frame`
    ros::Subscriber tips = {}, bases = {};
  };
  void subscribe(Stream& stream, ros::NodeHandle node);
  static ros::Time arrival(const Stream& stream);
  bool came_for_another_tool(const Stream& stream, ros::Time stamp) const;
  void place_base(const Stream& stream);
  std::string fault_of(const geometry_msgs::PoseStamped& pose, const std::string& frame) const;
  bool check(const geometry_msgs::PoseStamped& pose, const std::string& frame);
  void reject(const std::string& what, const std::string& frame, const std::string& why);

  TransformBuffer& transforms_;
  FailureLog& rejected_;
  Arrived arrived_;
  double max_ahead_sec_;
  /// The streams by tool. Subscriptions refer to streams, so their addresses must not change.
  std::vector<std::shared_ptr<Stream>> streams_;
  std::vector<ros::Subscriber> tf_;
};

}  // namespace organ_collision
