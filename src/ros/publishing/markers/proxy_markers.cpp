#include "proxy_markers.hpp"

#include <algorithm>
#include <cstdio>

#include "arrow.hpp"
#include "colours.hpp"
#include "ros/interface/plain_text.hpp"
#include "tool_markers.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

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
