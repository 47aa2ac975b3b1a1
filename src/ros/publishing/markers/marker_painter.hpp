#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <string>

#include "scene.hpp"
#include "second_mean.hpp"
#include "shown_markers.hpp"
#include "touched_faces.hpp"

namespace organ_collision {

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
  struct Surface {
    SteadyTime sent;
    SharedVertices vertices;
    SharedFaces faces;
    std::string frame;
  };
  struct LastContacts {
    SteadyTime time;
    ContactArrayConstPtr answer;
    SharedFaces faces;
  };

  void start_anew(const Scene& scene, const Publish& publish);
  void remember(const Scene& scene);
  void paint_surface(const Scene& scene, std::size_t number, const Publish& publish);
  bool is_due(const Scene& scene, const SceneOrgan& organ) const;
  void remove_surfaces(const Scene& scene, const Publish& publish);
  MarkerSheet paint_rest(const Scene& scene);
  void add_contacts(const Scene& scene, MarkerSheet& sheet) const;
  void add_tools(const Scene& scene, MarkerSheet& sheet) const;
  static void add_surroundings(const Scene& scene, const ScenePair& pair, MarkerSheet& sheet);
  void publish_rest(MarkerSheet sheet, const Publish& publish);

  ShownMarkers shown_;  ///< without those of surfaces
  ShownMarkers shown_surfaces_;
  std::map<std::string, Surface> surfaces_;  ///< by organ: the shape that was sent last
  TouchedFaces touched_;
  std::map<std::pair<std::string, std::string>, LastContacts> contacts_;  ///< by organ and tool
  std::deque<SceneStep> trail_;
  SecondMean query_sec_;
};

}  // namespace organ_collision
