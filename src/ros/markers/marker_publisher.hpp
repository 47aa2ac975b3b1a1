#pragma once

#include <ros/node_handle.h>
#include <visualization_msgs/MarkerArray.h>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "marker_painter.hpp"
#include "ros/organs/organ_registry.hpp"
#include "ros/steps/step_history.hpp"
#include "ros/steps/step_scheduler.hpp"
#include "scene.hpp"

namespace organ_collision {

/// The topic of a node's markers, and the thread of lower priority that draws them. The node's
/// thread decides when a picture is due, and hands over what it shows.
///
/// Only one thread may call these functions: the node's.
class MarkerTopic {
 public:
  using Publish = std::function<void(const visualization_msgs::MarkerArrayConstPtr&)>;
  /// Draws one picture, in the other thread. It must own what it shows.
  using Picture = std::function<void(const Publish&)>;

  explicit MarkerTopic(ros::NodeHandle private_node);
  ~MarkerTopic();

  bool has_subscribers() const { return subscribers_ > 0; }
  /// Whether draw() is to be called: somebody looks, the last picture is finished, and 1 /
  /// `rate_hz` has passed since it was due. If the rate is 0, an empty picture is due now and then.
  bool is_due(double rate_hz, SteadyTime now);
  /// The next picture is due as soon as the last one is finished.
  void hurry() { due_ = {}; }
  /// Whether there is a subscriber that knows nothing yet. Forgets it.
  bool take_anew();
  /// Hands a picture that is due to the other thread. If it throws, it is left out.
  void draw(Picture picture);

 private:
  void draw_pictures();
  Picture next_picture();
  void publish(const visualization_msgs::MarkerArrayConstPtr& array);

  int subscribers_ = 0;
  bool anew_ = false;
  SteadyTime due_;

  // Shared with the drawing thread.
  std::mutex mutex_;
  std::condition_variable changed_;
  Picture picture_;  ///< to be drawn
  bool drawing_ = false;
  bool stop_ = false;

  ros::Publisher markers_;
  std::thread thread_;
};

/// Publishes markers for RViz. The node's thread only notes what there is to see. A thread of its
/// own, of lower priority, draws and publishes it. Without subscribers, both do nothing.
///
/// Only one thread may call these functions: the node's.
class MarkerPublisher {
 public:
  MarkerPublisher(ros::NodeHandle private_node, const MarkerSettings& settings,
                  const std::vector<Tool>& tools);

  /// Takes effect with the next picture.
  void set_settings(const MarkerSettings& settings);
  void set_tools(const std::vector<Tool>& tools);

  /// Notes a step: its contacts and its path leave traces in the next pictures. Never throws: if
  /// memory is short, the step leaves no traces.
  void add(const EvaluatedStep& step);
  /// Hands the scene to the other thread if a picture is due and the last one is finished.
  void update(const OrganRegistry& organs, const StepHistory& history);

 private:
  Scene take_scene(const OrganRegistry& organs, const StepHistory& history, SteadyTime now);

  MarkerSettings settings_;
  std::shared_ptr<const std::vector<Tool>> tools_;
  std::vector<SceneStep> steps_;  ///< since the last picture
  MarkerPainter painter_;         ///< of the drawing thread
  MarkerTopic topic_;             ///< the last member: its thread ends before the painter does
};

/// Publishes hands, proxies and organs for RViz. A thread of its own, of lower priority, draws
/// them, so that the thread that moves the proxies does not wait. Without subscribers, both do
/// nothing.
///
/// Only one thread may call these functions: the node's.
class ProxyMarkerPublisher {
 public:
  using Views = std::function<std::vector<ProxyView>()>;

  ProxyMarkerPublisher(const ros::NodeHandle& private_node, const MarkerSettings& settings);

  /// Takes effect with the next picture.
  void set_settings(const MarkerSettings& settings);
  /// Hands a picture to the other thread if one is due. Only then, `views` is called: it makes a
  /// view of each proxy. Their `size` is set here.
  void update(const OrganRegistry& organs, const Views& views);

 private:
  Scene take_scene(const OrganRegistry& organs, const Views& views, SteadyTime now);

  MarkerSettings settings_;
  MarkerPainter painter_;  ///< of the drawing thread
  MarkerTopic topic_;      ///< the last member: its thread ends before the painter does
};

}  // namespace organ_collision
