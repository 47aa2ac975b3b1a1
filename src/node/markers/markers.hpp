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
#include "node/publishing/diagnostics.hpp"
#include "node/steps/step.hpp"
#include "node/tools/tool.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"

namespace organ_collision {

// What is drawn.

/// A step of a tool against an organ.
struct SceneStep {
  ContactArrayConstPtr answer;
  ToolPath path;  ///< empty if the step failed
};

/// What is known of one tool in relation to an organ.
struct ScenePair {
  std::size_t tool;              ///< index into Scene::tools
  ContactArrayConstPtr answer;   ///< the latest answer about the present triangles; null: none yet
  std::optional<ToolPose> pose;  ///< the pose in the organ's frame at the last successful step
  std::vector<SceneStep> steps = {};  ///< the latest one, and those since the last picture
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

/// Adds markers to a picture, in the drawing thread.
using Drawing = std::function<void(visualization_msgs::MarkerArray& picture)>;

/// What one picture shows. It shares or copies everything, so that another thread can draw it.
struct Scene {
  SteadyTime time;
  MarkerSettings settings;
  bool anew = false;  ///< a subscriber has come that has received nothing yet
  std::shared_ptr<const std::vector<Tool>> tools;
  std::vector<SceneOrgan> organs;
  const DurationStatistics* query_times = nullptr;  ///< null: there are no queries
  Drawing more = {};  ///< adds what else there is to show; empty: nothing
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

}  // namespace colours

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
/// Adds nothing if the arrow has no length.
void add_arrow(const MarkerStyle& style, const Eigen::Vector3d& tail, const Eigen::Vector3d& head,
               visualization_msgs::MarkerArray& picture);

/// Adds what an answer about the organ tells: the outlines of its regions, an arrow for each of the
/// deepest contacts, the names of the links that touch, near faces, and the line of its clearance.
void add_answer(const SceneOrgan& organ, const ContactArray& answer,
                visualization_msgs::MarkerArray& picture);
/// Adds the faces that the latest answers and the steps of all tools touch, coloured by depth.
/// `last_colour`: from this depth [m] on, all have the same colour.
void add_touched(const SceneOrgan& organ, double last_colour,
                 visualization_msgs::MarkerArray& picture);
/// Adds a text below the organ: its name, a line for each tool, and the query time. If there are
/// several organs, tools beyond their margin have no line.
void add_status(const Scene& scene, const SceneOrgan& organ,
                visualization_msgs::MarkerArray& picture);

/// Adds the tool at a pose in the frame of the style: its shaft as a capsule, and the shapes of its
/// links.
void add_tool(const Tool& tool, const ToolPose& pose, const MarkerStyle& style,
              visualization_msgs::MarkerArray& picture);
/// Adds the surface that the axis of a shaft swept in these steps.
void add_swept(const std::vector<SceneStep>& steps, const std::string& frame,
               visualization_msgs::MarkerArray& picture);

}  // namespace organ_collision
