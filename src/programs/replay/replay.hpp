#pragma once

#include <ros/time.h>
#include <rosbag/message_instance.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/messages/failure_log.hpp"
#include "node/steps/collision_pipeline.hpp"

namespace organ_collision {

/// The node's pipeline, in the time of a bag. Each message is applied and answered before the next
/// one, so the answers depend on nothing but the messages.
class Replay {
 public:
  using Handler = std::function<void(const rosbag::MessageInstance&)>;
  /// Gets each answer, with the time at which it was given.
  using Answer = std::function<void(const ContactArray&, ros::Time)>;

  /// `node`: the full name under which the node's topics were recorded. `follows_clock`: if true,
  /// the time is that of /clock in the bag; otherwise, it is the time at which messages were
  /// recorded. `parameters` and `tools` must outlive this. Throws GlError.
  Replay(const NodeParameters& parameters, const std::vector<Tool>& tools, const std::string& node,
         bool follows_clock, Answer answer);

  /// Goes to the time of a message of one of topics(), and applies it.
  void take(const rosbag::MessageInstance& message);
  /// Answers the shapes that still wait for their transforms when the bag has ended.
  void finish();

  /// A topic that a replay reads: the name and the MD5 sum of its type, and what takes a message.
  struct Topic {
    std::string type, md5sum;
    std::vector<Handler> handlers = {};
  };
  const std::map<std::string, Topic>& topics() const { return topics_; }
  bool reads(const std::string& topic) const { return topics_.count(topic) > 0; }
  /// Whether TF, or a topic of poses, has told of a frame.
  bool knows_frame(const std::string& frame) const {
    return pipeline_.inbox.transforms._frameExists(frame);
  }

 private:
  template <typename Message, typename Handle>
  void handle(const std::string& topic, Handle handler);
  void handle_poses(const std::vector<ToolParameters>& tools, const std::string& node);
  void go_to(ros::Time time);
  void evaluate_before(ros::Time time);
  SteadyTime steady(ros::Time time) const;
  ros::Time ros_time(SteadyTime time) const;
  void report(const OrganUpdate& update);
  void write(const ContactArray& answer) { answer_(answer, follows_clock_ ? recorded_ : now_); }

  const NodeParameters& parameters_;
  const std::vector<Tool>& tools_;
  bool follows_clock_;
  Answer answer_;
  std::map<std::string, Topic> topics_;

  FailureLog rejected_;
  CollisionPipeline pipeline_;

  ros::Time start_;  ///< the first time of the bag; zero: it has not come yet
  ros::Time now_;
  ros::Time recorded_;  ///< when the latest message was recorded
  ros::Time next_tick_;
};

}  // namespace organ_collision
