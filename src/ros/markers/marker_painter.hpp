#pragma once

#include <deque>

#include "markers.hpp"

namespace organ_collision {

/// The faces in one marker. A large surface consists of several markers, so that no message keeps
/// for long a socket, with the messages of others, or roscpp's lock of all topics, which it holds
/// while it writes a message into bytes.
inline constexpr std::size_t kFacesPerMarker = 2048;
/// Surfaces with so many faces are sent once a second, and larger ones less often, whatever
/// `surface_rate` is.
inline constexpr double kFacesPerSecond = 1e6;
/// [s] A surface that rests is sent again after this time, for viewers that could not place it
/// before. Large surfaces wait longer.
inline constexpr double kRefreshSec = 2.0;

/// Draws scenes as markers. Remembers what it drew, so that it deletes what is gone, sends surfaces
/// only when they changed, and lets traces of recent steps fade.
class MarkerPainter {
 public:
  using Publish = std::function<void(const visualization_msgs::MarkerArrayConstPtr&)>;

  /// Publishes the markers of a scene, which is later than the one before: an array for each marker
  /// of a surface that is due, then one with all other markers.
  void paint(const Scene& scene, const Publish& publish);

 private:
  /// A surface that was sent.
  struct Surface {
    SteadyTime sent;
    std::shared_ptr<const TriangleMesh> mesh;
    std::string frame;
  };

  void start_anew(const Scene& scene, const Publish& publish);
  void remember(const Scene& scene);
  void paint_surfaces(const Scene& scene, const Publish& publish);
  bool is_due(const Scene& scene, const SceneOrgan& organ) const;
  void add_tools(const Scene& scene, visualization_msgs::MarkerArray& picture) const;
  void add_touched(const Scene& scene, const SceneOrgan& organ,
                   visualization_msgs::MarkerArray& picture) const;
  void add_answer(const Scene& scene, const ScenePair& pair,
                  visualization_msgs::MarkerArray& picture) const;
  void delete_rest(const Scene& scene, visualization_msgs::MarkerArray& picture);

  std::map<std::string, Surface> surfaces_;  ///< by organ
  /// What subscribers have: frames by namespace and id. RViz ignores a DELETE without a frame.
  std::map<std::pair<std::string, int>, std::string> shown_;
  std::deque<SceneStep> trail_;  ///< the recent steps, which fade

  // The mean time of the queries of about a second, which changes once a second so that people can
  // read it.
  SteadyTime mean_since_;
  double query_sec_sum_ = 0.0;
  std::size_t query_count_ = 0;
  double mean_query_sec_ = 0.0;
};

}  // namespace organ_collision
