#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ros/interface/failure_log.hpp"
#include "ros/parameters/node_parameters.hpp"
#include "transform_buffer.hpp"

namespace organ_collision {

/// Tips whose poses come as PoseStamped, as CRTK's measured_cp: in the frame of their header,
/// without a name of their own. They become transforms to the tool's tip frame in the node's
/// buffer, so that all else is as for tools on TF.
class PoseTopics {
 public:
  /// Where poses go; all must outlive it. `arrived` gets the tool's index, after each pose of a
  /// tip.
  struct Sinks {
    TransformBuffer& transforms;
    FailureLog& rejected;
    std::function<void(std::size_t)> arrived;
  };
  PoseTopics(const std::vector<ToolParameters>& tools, const Sinks& sinks);

  /// To the topics that the tools name; `node` resolves their names.
  void subscribe(ros::NodeHandle node);

  /// A pose of the tool's tip, or of the frame that those are in. A pose that cannot be is counted
  /// as rejected, and the last one stays.
  void take_tip(std::size_t tool, const geometry_msgs::PoseStamped& pose);
  void take_base(std::size_t tool, const geometry_msgs::PoseStamped& pose);

  /// The clock jumped back.
  void forget_stamps();

 private:
  struct Stream {
    ToolParameters tool;
    std::string frame;  ///< in which the tip's poses are; empty: none came
    ros::Time latest;   ///< stamp of the tip's poses; zero: none came
    std::optional<geometry_msgs::PoseStamped> base;  ///< of that frame
  };
  void place_base(const Stream& stream);
  bool check(const geometry_msgs::PoseStamped& pose, const std::string& frame);
  void reject(const std::string& frame, const std::string& wrong);

  std::vector<Stream> streams_;  ///< one for each tool
  Sinks sinks_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace organ_collision
