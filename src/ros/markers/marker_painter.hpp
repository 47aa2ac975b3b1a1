#pragma once

#include <deque>

#include "markers.hpp"

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

/// Draws scenes as markers. Remembers what it drew, so that it deletes what is gone, sends surfaces
/// only when they changed, and lets traces of recent steps fade.
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

  std::map<std::string, Surface> surfaces_;  ///< by the organ's name
  /// The markers that subscribers have: the frame of each, by namespace and id. RViz ignores a
  /// DELETE without a frame.
  std::map<std::pair<std::string, int>, std::string> shown_;
  std::deque<SceneStep> trail_;  ///< the recent steps, which fade

  // The mean time of the queries within about a second. It changes only once a second, so that
  // people can read it.
  SteadyTime mean_since_;
  double query_sec_sum_ = 0.0;
  std::size_t query_count_ = 0;
  double mean_query_sec_ = 0.0;
};

}  // namespace organ_collision
