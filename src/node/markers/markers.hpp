#pragma once

#include <organ_collision/ContactArray.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/parameters/node_parameters.hpp"
#include "node/steps/step.hpp"
#include "node/tools/tool.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

// What is drawn.

/// What is known of one tool in relation to an organ.
struct ScenePair {
  std::size_t tool;              ///< index into Scene::tools
  ContactArrayConstPtr answer;   ///< the latest answer about the present triangles; null: none yet
  std::optional<ToolPose> pose;  ///< the pose in the organ's frame at the last successful step
};

/// An organ, its latest shape, which nobody changes, and the tools in relation to it.
struct SceneOrgan {
  std::string name;
  std::string frame;
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<ScenePair> pairs = {};  ///< in the order of the tools

  /// [m] The diagonal of the organ's box. Widths of lines and heights of texts are shares of it.
  double size() const { return mesh->box().diagonal().cast<double>().norm(); }
};

/// A step since the last picture.
struct SceneStep {
  SteadyTime time;
  ContactArrayConstPtr answer;
  SharedFaces faces;  ///< the organ's triangles at that time
  ToolPath path;      ///< empty if the step failed
  double query_sec;
};

/// Adds markers to a picture, in the drawing thread.
using Drawing = std::function<void(visualization_msgs::MarkerArray& picture)>;

/// What one picture shows. It shares or copies everything, so that another thread can draw it.
struct Scene {
  SteadyTime time;
  MarkerSettings settings;
  bool anew = false;  ///< a subscriber has come that has received nothing yet
  std::shared_ptr<const std::vector<Tool>> tools;
  std::vector<SceneOrgan> organs;
  std::vector<SceneStep> steps;  ///< the oldest first
  Drawing more = {};             ///< adds what else there is to show; empty: nothing

  /// The organ with this name. Null if there is none.
  const SceneOrgan* organ(const std::string& name) const {
    for (const SceneOrgan& organ : organs) {
      if (organ.name == name) return &organ;
    }
    return nullptr;
  }
};

// How it is drawn. Lengths are in metres, unless they are shares of a size.

namespace colours {

inline std_msgs::ColorRGBA rgba(float red, float green, float blue, float alpha = 1.0F) {
  std_msgs::ColorRGBA colour;
  colour.r = red;
  colour.g = green;
  colour.b = blue;
  colour.a = alpha;
  return colour;
}

inline const std_msgs::ColorRGBA kTool = rgba(0.85F, 0.87F, 0.90F);
inline const std_msgs::ColorRGBA kText = rgba(0.95F, 0.95F, 0.95F);
inline const std_msgs::ColorRGBA kFailure = rgba(1.00F, 0.45F, 0.35F);

/// The colour map of depths: `share` is 0 for a first touch (yellow) and 1 for the greatest depth
/// that the map distinguishes (dark violet). Values beyond are clamped.
std_msgs::ColorRGBA depth(double share);
/// The colour with its opacity multiplied by `share` in [0, 1].
std_msgs::ColorRGBA faded(std_msgs::ColorRGBA colour, double share);

}  // namespace colours

/// [s] The trace of something that has ended, such as a contact, fades within this time.
inline constexpr double kFadeSec = 0.5;
/// How visible the trace of something that happened at `time` is `now`: from 1 down to 0.
double visibility(SteadyTime time, SteadyTime now);

/// What markers of one kind have in common.
struct MarkerStyle {
  std::string name_space;
  std::string frame;
  std_msgs::ColorRGBA colour;
};

/// A marker at the origin of the frame, with a scale of 1 m. Its stamp is zero and it is locked to
/// the frame: a viewer places it by the latest transform, again and again.
visualization_msgs::Marker make_marker(const MarkerStyle& style, int type);
/// Adds a corner to a TRIANGLE_LIST or LINE_LIST.
void add_point(visualization_msgs::Marker& list, const Eigen::Vector3d& point);
/// Adds a triangle with a colour of its own to a TRIANGLE_LIST.
void add_triangle(visualization_msgs::Marker& list, const Triangle& corners,
                  const std_msgs::ColorRGBA& colour);
/// Adds a face of the organ to a TRIANGLE_LIST, slightly above the surface. Adds both of its sides,
/// because a tool may be on either.
void add_lifted_face(visualization_msgs::Marker& list, const SceneOrgan& organ, std::size_t face,
                     const std_msgs::ColorRGBA& colour);

// These add a marker to a picture.

/// Numbers the marker: the ids of each namespace run from 0. Drops a list without points, which
/// RViz would report as an error.
void add_marker(visualization_msgs::Marker marker, visualization_msgs::MarkerArray& picture);
/// Adds a marker for each line of a text, from `place` downwards, and returns the place of the next
/// line. Lines that are too long for a window are cut at a space. Heights are shares of `size`.
/// RViz would draw the lines of one marker far apart.
Eigen::Vector3d add_text(const MarkerStyle& style, const Eigen::Vector3d& place, double size,
                         const std::string& text, visualization_msgs::MarkerArray& picture);
void add_line(const MarkerStyle& style, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              double width, visualization_msgs::MarkerArray& picture);
/// The widths and the length of the head are shares of the arrow's length.
struct ArrowShape {
  double shaft_width = 0.08;
  double head_width = 0.22;
  double head_length = 0.3;
};
/// Adds nothing if the arrow has no length.
void add_arrow(const MarkerStyle& style, const Eigen::Vector3d& tail, const Eigen::Vector3d& head,
               const ArrowShape& shape, visualization_msgs::MarkerArray& picture);

/// Adds the near faces of the latest answer about a tool, the line of its clearance, and a cone for
/// each place where its axis pierces the organ. `radius`: of the tool's shaft.
void add_surroundings(const SceneOrgan& organ, const ScenePair& pair, double radius,
                      visualization_msgs::MarkerArray& picture);
/// Adds regions, an arrow for each of the deepest contacts, and the names of the links that touch.
/// `share`: how visible arrows and names are, in [0, 1].
void add_contacts(const SceneOrgan& organ, const ContactArray& answer, double share,
                  visualization_msgs::MarkerArray& picture);
/// Adds a text below the organ: its name, a line for each tool, and the query time [s] if it is
/// above 0. If there are several organs, tools beyond their margin have no line. `fading`: for each
/// pair, the step whose contacts are still shown though they have ended; null: none.
void add_status(const Scene& scene, const SceneOrgan& organ,
                const std::vector<const SceneStep*>& fading, double query_sec,
                visualization_msgs::MarkerArray& picture);

/// Adds the tool at a pose in the frame of the style: its shaft as a capsule, and the shapes of its
/// links.
void add_tool(const Tool& tool, const ToolPose& pose, const MarkerStyle& style,
              visualization_msgs::MarkerArray& picture);
/// Adds the surface that the tool swept in `steps`, which are sorted from the oldest to the newest.
/// It consists of the surfaces swept by the shaft's axis, and by the longest axis of each part of
/// the links. It fades with the age of the steps.
void add_swept(const Tool& tool, const std::vector<const SceneStep*>& steps,
               const std::string& frame, SteadyTime now, visualization_msgs::MarkerArray& picture);

}  // namespace organ_collision
