#include "tool_markers.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr double kThinnest = 1e-6;  // [m] RViz warns of a scale of 0.

/// Makes the markers of one tool.
class ToolPainter {
 public:
  ToolPainter(const std::string& frame, const ToolLook& look) : frame_(frame), look_(look) {}

  Marker ball(const Vector3d& center, double radius) const {
    return shape(Marker::SPHERE, Isometry3d(Eigen::Translation3d(center)),
                 Vector3d::Constant(2.0 * radius));
  }

  /// A flat-ended cylinder around an axis.
  Marker cylinder(const ShaftAxis& axis, double radius) const {
    const Vector3d along = axis.tip - axis.trocar;
    Isometry3d pose(Eigen::Translation3d(axis.at(0.5)));
    if (!along.isZero(0.0)) {
      pose.rotate(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), along));
    }
    return shape(Marker::CYLINDER, pose, {2.0 * radius, 2.0 * radius, along.norm()});
  }

  Marker link_part(const Isometry3d& T_frame_link, const LinkPart& part) const {
    if (part.surface && part.surface->faces().size() <= kMostFacesOfTool) {
      return mesh(T_frame_link, *part.surface);
    }
    const ConvexCore core = T_frame_link * part.core;
    if (part.core.is_cylinder()) {
      return cylinder(core.axis(), part.radius + core.rim.col(0).norm());
    }
    if (part.core.count == 1) return ball(core.points[0], part.radius);
    return box(T_frame_link, part);
  }

 private:
  Marker shape(int type, const Isometry3d& pose, const Vector3d& scale) const {
    Marker marker = make_marker(look_.name_space, frame_, type, look_.colour);
    marker.pose = pose_message(pose);
    marker.scale.x = std::max(kThinnest, scale.x());
    marker.scale.y = std::max(kThinnest, scale.y());
    marker.scale.z = std::max(kThinnest, scale.z());
    return marker;
  }

  Marker box(const Isometry3d& T_frame_link, const LinkPart& part) const {
    Isometry3d T_link_box(Eigen::Translation3d(part.bounds.center));
    T_link_box.rotate(part.bounds.axes);
    return shape(Marker::CUBE, T_frame_link * T_link_box,
                 2.0 * (part.bounds.half_size + Vector3d::Constant(part.radius)));
  }

  Marker mesh(const Isometry3d& T_frame_link, const ToolSurface& surface) const {
    Marker triangles = shape(Marker::TRIANGLE_LIST, T_frame_link, Vector3d::Constant(1.0));
    for (std::size_t face = 0; face < surface.faces().size(); ++face) {
      for (const Vector3d& corner : surface.triangle(face)) add_point(triangles, corner);
    }
    return triangles;
  }

  const std::string& frame_;
  const ToolLook& look_;
};

}  // namespace

void add_tool(const Tool& tool, const ToolPose& pose, const std::string& frame, MarkerSheet& sheet,
              const ToolLook& look) {
  const ToolPainter painter(frame, look);
  if (tool.parameters.has_shaft()) {
    const double radius = tool.parameters.radius;
    sheet.add(painter.cylinder(pose.axis, radius));
    sheet.add(painter.ball(pose.axis.trocar, radius));
    sheet.add(painter.ball(pose.axis.tip, radius));
  }
  const std::size_t known = std::min(tool.links.size(), pose.links.size());
  for (std::size_t i = 0; i < known; ++i) {
    for (const LinkPart& part : tool.links[i].parts) {
      sheet.add(painter.link_part(pose.links[i], part));
    }
  }
}

namespace {

/// The line in a link whose motion stands for that of a part.
ShaftAxis longest_axis(const LinkPart& part) {
  Eigen::Index longest = 0;
  part.bounds.half_size.maxCoeff(&longest);
  const Vector3d half = part.bounds.half_size[longest] * part.bounds.axes.col(longest);
  return {part.bounds.center - half, part.bounds.center + half};
}

/// The lines of a tool at a waypoint.
std::vector<ShaftAxis> lines_of(const Tool& tool, const ToolWaypoint& waypoint) {
  std::vector<ShaftAxis> lines;
  if (tool.parameters.has_shaft()) lines.push_back(waypoint.axis);
  for (std::size_t i = 0; i < std::min(tool.links.size(), waypoint.links.size()); ++i) {
    for (const LinkPart& part : tool.links[i].parts) {
      const ShaftAxis axis = longest_axis(part);
      lines.push_back({waypoint.links[i] * axis.trocar, waypoint.links[i] * axis.tip});
    }
  }
  return lines;
}

void add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                  const std_msgs::ColorRGBA& colour, Marker& list) {
  if ((b - a).cross(c - a).isZero(0.0)) return;
  for (const Vector3d& corner : {a, b, c}) {
    add_point(list, corner);
    list.colors.push_back(colour);
  }
}

void add_leg(const Tool& tool, const ToolWaypoint& from, const ToolWaypoint& to,
             const std_msgs::ColorRGBA& colour, Marker& list) {
  const std::vector<ShaftAxis> before = lines_of(tool, from), after = lines_of(tool, to);
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    add_triangle(before[i].trocar, before[i].tip, after[i].tip, colour, list);
    add_triangle(before[i].trocar, after[i].tip, after[i].trocar, colour, list);
  }
}

}  // namespace

double visibility(SteadyTime time, SteadyTime now) {
  const double age = std::chrono::duration<double>(now - time).count();
  return std::clamp(1.0 - age / kFadeSec, 0.0, 1.0);
}

void add_swept(const Tool& tool, const std::vector<const SceneStep*>& steps,
               const std::string& frame, SteadyTime now, MarkerSheet& sheet) {
  Marker swept = make_marker(marker_names::kSwept, frame, Marker::TRIANGLE_LIST, colours::swept());
  std::size_t legs = 0;
  for (auto step = steps.rbegin(); step != steps.rend() && legs < kMostLegs; ++step) {
    const double share = visibility((*step)->time, now);
    if (share == 0.0) continue;
    const ToolPath& path = (*step)->path;
    for (std::size_t i = path.size(); i-- > 1 && legs < kMostLegs; ++legs) {
      add_leg(tool, path[i - 1], path[i], colours::faded(colours::swept(), share), swept);
    }
  }
  sheet.add(std::move(swept));
}

namespace {

constexpr std::size_t kLongestReason = 100;  // [bytes]
/// Shares of the scene's size.
constexpr double kSpringWidth = 6e-3;
constexpr double kLongestArrow = 0.10;  ///< of the greatest force on the tissue
constexpr double kTextHeight = 0.03;
constexpr double kTextLift = 0.06;  ///< from the far end of the tool

/// A force of the proxy on the tissue, divided by the stiffness. [m]
struct Load {
  Vector3d point;
  Vector3d force;
};

std::vector<Load> loads_of(const ProxyAnswer& answer) {
  std::vector<Load> loads;
  for (const ProxyContact& at : answer.contacts) {
    loads.push_back({at.contact.point, at.load * at.contact.normal});
  }
  for (const ProxyCrossing& at : answer.crossings) loads.push_back({at.point, at.load});
  return loads;
}

/// The longest arrow stands for the greatest force.
void add_loads(const ProxyView& view, MarkerSheet& sheet) {
  const std::vector<Load> loads = loads_of(view.answer);
  double greatest = 0.0;
  for (const Load& load : loads) greatest = std::max(greatest, load.force.norm());
  Marker arrows =
      make_marker(marker_names::kLoads, view.frame, Marker::TRIANGLE_LIST, colours::load());
  if (greatest == 0.0) return;
  for (const Load& load : loads) {
    const Vector3d way = kLongestArrow * view.size / greatest * load.force;
    add_arrow(load.point - way, load.point, arrows);
  }
  // RViz lights only markers without colours of their own. It would leave half of the arrows dark.
  arrows.colors.assign(arrows.points.size(), arrows.color);
  sheet.add(std::move(arrows));
}

void add_spring(const ProxyView& view, MarkerSheet& sheet) {
  const ProxyAnswer& answer = view.answer;
  if (answer.pull.isZero(0.0)) return;
  Marker spring = make_marker(marker_names::kSpring, view.frame, Marker::LINE_LIST,
                              colours::proxy(answer.state));
  spring.scale.x = kSpringWidth * view.size;
  add_point(spring, answer.center);
  add_point(spring, answer.center + answer.pull);
  sheet.add(std::move(spring));
}

/// Where the hand's tool is far from tissue: the trocar of a shaft, else the origin of the first
/// link. The origin of the frame if there is no hand.
Vector3d far_end(const ProxyView& view) {
  if (!view.hand) return Vector3d::Zero();
  if (view.tool.parameters.has_shaft()) return view.hand->axis.trocar;
  return view.hand->links.front().translation();
}

void add_state(const ProxyView& view, MarkerSheet& sheet) {
  Marker text = make_marker(marker_names::kState, view.frame, Marker::TEXT_VIEW_FACING,
                            colours::proxy(view.answer.state));
  const Vector3d place = far_end(view) + kTextLift * view.size * Vector3d::UnitZ();
  text.pose = pose_message(Eigen::Isometry3d(Eigen::Translation3d(place)));
  text.text = state_line(view);
  text.scale.z = kTextHeight * view.size;
  sheet.add(std::move(text));
}

}  // namespace

std::string name_of(ProxyStatus state) {
  switch (state) {
    case ProxyStatus::kFree:
      return "FREE";
    case ProxyStatus::kTouching:
      return "TOUCHING";
    case ProxyStatus::kSqueezed:
      return "SQUEEZED";
    case ProxyStatus::kPunctured:
      return "PUNCTURED";
    case ProxyStatus::kNoAnswer:
      break;
  }
  return "NO_ANSWER";
}

std::string state_line(const ProxyView& view) {
  const std::string line = view.tool.parameters.name + ": " + name_of(view.answer.state);
  if (view.answer.state == ProxyStatus::kNoAnswer) {
    return line + ": " + plain_text(view.answer.message, kLongestReason);
  }
  char force[32];
  std::snprintf(force, sizeof force, ", %.1f N", view.force);
  return line + force;
}

void add_proxy(const ProxyView& view, MarkerSheet& sheet) {
  const bool has_proxy = view.answer.state != ProxyStatus::kNoAnswer;
  const bool is_held = view.answer.state != ProxyStatus::kFree;
  if (view.hand && is_held) {
    add_tool(view.tool, *view.hand, view.frame, sheet, {marker_names::kHand, colours::hand()});
  }
  if (has_proxy) {
    add_tool(view.tool, view.answer.proxy, view.frame, sheet,
             {marker_names::kProxy, colours::tool()});
    add_spring(view, sheet);
    add_loads(view, sheet);
  }
  add_state(view, sheet);
}

}  // namespace organ_collision
