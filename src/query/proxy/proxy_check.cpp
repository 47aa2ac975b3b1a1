#include "proxy_check.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "query/request_check.hpp"

namespace organ_collision {
namespace {

void check(bool is_legal, const std::string& what) {
  if (!is_legal) throw std::invalid_argument(what);
}

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

void check_tool(const ProxyTool& tool) {
  check(
      std::isfinite(tool.radius) && tool.radius >= 0.0,
      "the radius of the proxy's tool is " + shown(tool.radius) + " m; it must be >= 0 and finite");
  const bool has_parts = std::any_of(tool.links.begin(), tool.links.end(),
                                     [](const Link& link) { return !link.parts.empty(); });
  check(tool.radius > 0.0 || has_parts,
        "the proxy's tool has neither a shaft nor links with parts; give it a radius > 0 or links");
  check(tool.radius > 0.0 || tool.freedom == ProxyFreedom::kFree,
        "the proxy's tool has no shaft (its radius is 0), so it cannot go through a trocar; let it "
        "be free");
}

void check_settings(const ProxyTool& tool, const ProxySettings& settings) {
  check(std::isfinite(settings.clearance) && settings.clearance > 0.0,
        "the clearance is " + shown(settings.clearance) + " m; it must be > 0 and finite");
  check(settings.jump > 0.0, "the jump is " + shown(settings.jump) + " m; it must be > 0");
  check(!settings.puncture || *settings.puncture > 0.0,
        "the puncture is " + shown(settings.puncture.value_or(0.0)) + " m; it must be > 0");
  check(!settings.puncture || tool.freedom == ProxyFreedom::kTrocar,
        "a puncture is set for a free tool; only a shaft through a trocar can pierce tissue");
  check(std::isfinite(settings.friction) && settings.friction >= 0.0,
        "the friction is " + shown(settings.friction) + " m; it must be >= 0 and finite");
}

void check_hand(const ProxyTool& tool, const ToolPose& hand) {
  const bool has_shaft = tool.radius > 0.0;
  const bool is_finite =
      (!has_shaft || (hand.axis.trocar.allFinite() && hand.axis.tip.allFinite())) &&
      std::all_of(hand.links.begin(), hand.links.end(),
                  [](const Eigen::Isometry3d& link) { return link.matrix().allFinite(); });
  check(is_finite, "the hand's pose has a value that is not finite");
  check(hand.links.size() == tool.links.size(),
        "the hand's pose has " + std::to_string(hand.links.size()) + " links; the tool has " +
            std::to_string(tool.links.size()));
}

void check_organs(const std::vector<ProxyOrgan>& organs) {
  for (const ProxyOrgan& organ : organs) {
    check(organ.shape != nullptr, "organ '" + organ.name + "' has no shape");
    const Eigen::Matrix3d turned = organ.T_organ_proxy.linear();
    check(organ.T_organ_proxy.matrix().allFinite() && turned.isUnitary(kRotationTolerance) &&
              turned.determinant() > 0.0,
          "the frame of organ '" + organ.name +
              "' has a pose that is not finite, or whose linear part is not a rotation");
    check(std::count_if(organs.begin(), organs.end(),
                        [&](const ProxyOrgan& other) { return other.name == organ.name; }) == 1,
          "two organs have the name '" + organ.name + "'");
  }
}

}  // namespace organ_collision
