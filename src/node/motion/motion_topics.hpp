#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>
#include <tf2_msgs/TFMessage.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "node/parameters/node_parameters.hpp"
#include "node/tools/tool.hpp"
#include "transform_buffer.hpp"

namespace organ_collision {

/// Receives /tf and /tf_static into the node's buffer, and the poses of tool tips that are sent as
/// PoseStamped, for example CRTK's measured_cp. Each pose becomes a transform to the tool's tip
/// frame, so that the rest of the node treats these tools like those on TF.
class MotionTopics {
 public:
  /// Called with a tool's index after each pose of its tip from a topic.
  using Arrived = std::function<void(std::size_t tool)>;

  /// The references must outlive this object. `ahead` refuses transforms and poses by their stamps.
  MotionTopics(const std::vector<ToolParameters>& tools, TransformBuffer& transforms,
               FailureLog& rejected, Arrived arrived, const AheadLimit& ahead);
  MotionTopics(const MotionTopics&) = delete;  ///< The subscriptions refer to this.

  /// Subscribes to TF and to the topics that the tools name; `node` resolves their names.
  void subscribe(ros::NodeHandle node);
  struct Stream;
  /// The streams by tool. Subscriptions refer to streams, so their addresses must not change.
  using Streams = std::vector<std::shared_ptr<Stream>>;

  /// Subscribes to what a new list of tools needs, for change_tools(). The subscriptions of tools
  /// with the same name, tip frame and topics stay, so that no pose is lost. Waits for the ROS
  /// master: may run in another thread than all other functions, but not while change_tools() runs.
  /// Throws std::runtime_error if a topic cannot be subscribed to.
  Streams subscribe_for(const std::vector<Tool>& tools, const ros::NodeHandle& node);
  /// Takes a new list of tools, and the poses that have come for it. `streams`: those for it. Then,
  /// they are the old ones, whose destruction waits for the ROS master.
  void change_tools(Streams& streams, const std::vector<Tool>& tools);

  /// From now on, names topics of poses that have another type, because roscpp connects to none of
  /// them. While no pose comes on a topic, the ROS master is asked for its type once a second, in
  /// the thread of `asking`, which may wait. `node`: of the thread that calls everything else. Both
  /// queues must call nothing more when this ends.
  void watch_types(const ros::NodeHandle& node, ros::CallbackQueue& asking);
  /// Takes the types of topics. A topic without poses whose type is another one is refused.
  void take_types(const std::map<std::string, std::string>& types);

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
  const AheadLimit& ahead_;
  Streams streams_;
  std::vector<ros::Subscriber> tf_;
  ros::WallTimer look_;  ///< for silent topics
  std::shared_ptr<std::atomic<bool>> is_asking_ = std::make_shared<std::atomic<bool>>(false);
};

/// The poses of a tool's tip, and of the frame in which they are given.
struct MotionTopics::Stream {
  std::optional<std::size_t> index;  ///< of the tool; empty: it is not in the list
  ToolParameters tool;
  std::string frame = {};  ///< frame of the tip's poses; empty: no pose came yet
  ros::Time latest = {};   ///< stamp of the tip's last pose; zero: no pose came yet
  std::optional<geometry_msgs::PoseStamped> base = {};  ///< last pose of `frame`
  /// The last poses that came before the tool was in the list.
  geometry_msgs::PoseStampedConstPtr early_tip = {}, early_base = {};
  ros::Subscriber tips = {}, bases = {};  ///< the last members, so that they end first
};

}  // namespace organ_collision
