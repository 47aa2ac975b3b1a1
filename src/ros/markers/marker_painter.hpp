#pragma once

#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <string>

#include "answer_markers.hpp"
#include "ros/steps/step_history.hpp"
#include "scene.hpp"

namespace organ_collision {

/// The faces in one marker. A large surface consists of several markers, so that no message keeps
/// for long a socket, with the messages of others, or roscpp's lock of all topics, which it holds
/// while it writes a message into bytes.
inline constexpr std::size_t kFacesPerMarker = 2048;

/// The number of markers of a surface.
std::size_t surface_marker_count(const SceneOrgan& organ);

/// One marker of a surface, with the id `index`. `number`: the organ's place among the organs.
visualization_msgs::Marker surface_marker(const SceneOrgan& organ, std::size_t number,
                                          std::size_t index);

/// Which markers the subscribers have, so that what is no longer there can be deleted.
class ShownMarkers {
 public:
  /// The number of markers that a namespace has now, with the ids 0 ... count - 1.
  struct Group {
    int count = 0;
    std::string frame = {};  ///< of one of them; RViz ignores a DELETE without a frame
  };
  using Groups = std::map<std::string, Group>;

  /// Notes that `now` is all that subscribers are to have. Adds a DELETE to `array` for each marker
  /// that they have beyond that.
  void replace(Groups now, visualization_msgs::MarkerArray& array);
  /// Notes that the subscribers have nothing.
  void clear() { groups_.clear(); }

 private:
  Groups groups_;
};

/// The mean of the values of about the last second, for a number that people can read: it changes
/// once a second.
class SecondMean {
 public:
  void add(double value);
  /// To be called often. 0 if no value has come.
  double at(SteadyTime now);

 private:
  SteadyTime since_;
  double sum_ = 0.0;
  std::size_t count_ = 0;
  double mean_ = 0.0;
};

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
