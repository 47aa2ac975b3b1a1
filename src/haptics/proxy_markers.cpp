#include "proxy_markers.hpp"

#include <algorithm>
#include <cstdio>

#include "common/messages/text.hpp"

namespace organ_collision {

using Eigen::Vector3d;
using visualization_msgs::MarkerArray;

namespace {

/// The tool at the hand's pose, while tissue holds the proxy back.
const std_msgs::ColorRGBA kHand = colours::rgba(0.45F, 0.75F, 1.00F, 0.40F);
/// The force of a proxy on the tissue.
const std_msgs::ColorRGBA kLoad = colours::rgba(1.00F, 0.80F, 0.15F);

/// Adds an arrow for each force of the proxy on the tissue. The longest arrow stands for the
/// greatest force.
void add_loads(const ProxyView& view, MarkerArray& picture) {
  constexpr double kLongest = 0.10;                  // A share of the scene's size.
  std::vector<std::pair<Vector3d, Vector3d>> loads;  // Points, and forces divided by the stiffness.
  for (const ProxyFace& at : view.answer.contacts) {
    loads.emplace_back(at.contact.point, at.load * at.contact.normal);
  }
  for (const ProxyCrossing& at : view.answer.crossings) loads.emplace_back(at.point, at.load);
  double greatest = 0.0;
  for (const auto& [point, force] : loads) greatest = std::max(greatest, force.norm());
  if (greatest == 0.0) return;
  for (const auto& [point, force] : loads) {
    add_arrow({"loads", view.frame, kLoad}, point - kLongest * view.size / greatest * force, point,
              picture);
  }
}

/// The end of the hand's tool that is far from tissue: the trocar of a shaft, else the origin of
/// the first link. The origin of the frame if there is no hand.
Vector3d far_end(const ProxyView& view) {
  if (!view.hand) return Vector3d::Zero();
  if (view.tool.parameters.has_shaft()) return view.hand->axis.trocar;
  return view.hand->links.front().translation();
}

/// For example "probe: TOUCHING, 1.2 N". If there is no answer, for example "probe: NO_ANSWER:
/// ...", with the reason.
std::string state_line(const ProxyView& view) {
  constexpr std::size_t kLongestReason = 100;  // [bytes]
  const std::string line = view.tool.parameters.name + ": " + name_of(view.answer.state);
  if (view.answer.state == ProxyStatus::kNoAnswer) {
    return line + ": " + plain_text(view.answer.message, kLongestReason);
  }
  char force[32];
  std::snprintf(force, sizeof force, ", %.1f N", view.force);
  return line + force;
}

}  // namespace

std::string name_of(ProxyStatus state) {
  static constexpr const char* kNames[] = {"NO_ANSWER", "FREE", "TOUCHING", "SQUEEZED",
                                           "PUNCTURED"};
  return kNames[static_cast<std::size_t>(state)];
}

std_msgs::ColorRGBA colour_of(ProxyStatus state) {
  static const std_msgs::ColorRGBA all[] = {
      colours::kFailure, colours::kText, colours::rgba(0.30F, 0.95F, 0.50F),
      colours::rgba(1.00F, 0.65F, 0.10F), colours::rgba(0.80F, 0.50F, 1.00F)};
  return all[static_cast<std::size_t>(state)];
}

void add_proxy(const ProxyView& view, MarkerArray& picture) {
  // Shares of the scene's size.
  constexpr double kSpringWidth = 6e-3;
  constexpr double kTextLift = 0.06;  // The distance of the text from the far end of the tool.
  const ProxyAnswer& answer = view.answer;
  const std_msgs::ColorRGBA colour = colour_of(answer.state);
  if (view.hand && answer.state != ProxyStatus::kFree) {
    add_tool(view.tool, *view.hand, {"hand", view.frame, kHand}, picture);
  }
  if (answer.state != ProxyStatus::kNoAnswer) {
    add_tool(view.tool, answer.proxy, {"proxy", view.frame, colours::kTool}, picture);
    if (!answer.pull.isZero(0.0)) {
      add_line({"spring", view.frame, colour}, answer.center, answer.center + answer.pull,
               kSpringWidth * view.size, picture);
    }
    add_loads(view, picture);
  }
  add_text({"state", view.frame, colour}, far_end(view) + kTextLift * view.size * Vector3d::UnitZ(),
           view.size, state_line(view), picture);
}

}  // namespace organ_collision
