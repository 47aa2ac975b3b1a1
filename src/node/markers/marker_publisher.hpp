#pragma once

#include <atomic>
#include <functional>
#include <map>

#include "common/threads/queues.hpp"
#include "markers.hpp"
#include "node/organs/organ_registry.hpp"

namespace organ_collision {

/// The most faces in one marker. A large surface consists of several markers, because a large
/// message would block others for long: it occupies the socket, and roscpp holds its lock of all
/// topics while it writes a message into bytes.
inline constexpr std::size_t kFacesPerMarker = 2048;
/// A surface of this many faces is sent at most once a second, and a larger one less often,
/// whatever `surface_rate` is.
inline constexpr double kFacesPerSecond = 1e6;
/// [s] A surface that rests is sent again after this time, for viewers that could not place it
/// before. Large surfaces wait longer.
inline constexpr double kRefreshSec = 2.0;

/// Draws scenes as markers. Remembers what it drew, so that it deletes what is gone, and sends
/// surfaces only when they changed.
class MarkerPainter {
 public:
  using Publish = std::function<void(const visualization_msgs::MarkerArrayConstPtr&)>;

  /// Publishes the markers of a scene: an array for each marker of a surface that is due, and then
  /// an array with all other markers. The scene must be later than the one before.
  void paint(const Scene& scene, const Publish& publish);

 private:
  /// A surface that was sent.
  struct Surface {
    SteadyTime sent;
    std::shared_ptr<const TriangleMesh> mesh;  ///< null: it was not sent yet
    std::string frame;
  };

  void start_anew(const Publish& publish);
  void paint_surfaces(const Scene& scene, const Publish& publish);
  bool is_due(const Scene& scene, const SceneOrgan& organ, const Surface& last) const;
  void add_tools(const Scene& scene, visualization_msgs::MarkerArray& picture) const;
  void delete_rest(visualization_msgs::MarkerArray& picture);

  std::map<std::string, Surface> surfaces_;  ///< by the organ's name
  std::map<std::string, int> counts_;        ///< of the markers that are shown, by namespace
  std::string frame_;  ///< of the last picture. RViz ignores a DELETE without a frame.
};

/// The topic of a node's markers. The node's thread only notes what there is to see. A thread of
/// lower priority draws it, so that the node's thread does not wait. Without subscribers, both
/// threads do nothing.
///
/// Only one thread may call these functions: the node's.
class MarkerPublisher {
 public:
  using Draw = std::function<Drawing(double size)>;

  MarkerPublisher(ros::NodeHandle private_node, const MarkerSettings& settings,
                  const std::vector<Tool>& tools = {});

  /// Takes effect with the next picture, which is due as soon as the last one is finished.
  void set_settings(const MarkerSettings& settings);
  void set_tools(const std::vector<Tool>& tools);
  /// Notes a step: what the tool touched and swept. Pictures show the latest step of each organ and
  /// tool, and all others since the last picture.
  void add(const ToolStep& step);

  // These draw a picture if one is due: there is a subscriber, the last picture is finished, and it
  // is time for the next one. If markers are switched off, what is still shown disappears at the
  // end of its lifetime.

  /// What the collision node has to show: organs, tools and answers. `query_times`: must outlive
  /// this object.
  void update(const OrganRegistry& organs, const StepHistory& history,
              const DurationStatistics& query_times);
  /// What another node has to show: its organs, and what `draw_more` makes. It is called only if a
  /// picture is due. `size`: of the largest organ [m]; 0 if there is none.
  void update(const OrganRegistry& organs, const Draw& draw_more);

 private:
  struct Step {
    SharedFaces faces;  ///< the organ's triangles at that time
    SceneStep shown;
  };

  std::optional<Scene> next_scene(const OrganRegistry& organs);
  void draw(Scene scene);

  MarkerSettings settings_;
  std::shared_ptr<const std::vector<Tool>> tools_;
  std::map<std::pair<std::string, std::size_t>, std::vector<Step>> steps_;  ///< as in StepHistory
  int subscribers_ = 0;
  bool anew_ = false;  ///< a subscriber has come that has received nothing yet
  SteadyTime due_;
  ros::Publisher markers_;

  MarkerPainter painter_;  ///< used by the drawing thread only
  std::atomic<bool> is_drawing_{false};
  QueueThread thread_;
};

}  // namespace organ_collision
