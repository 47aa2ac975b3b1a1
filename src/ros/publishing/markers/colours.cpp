#include "colours.hpp"

#include <algorithm>
#include <array>

namespace organ_collision::colours {
namespace {

std_msgs::ColorRGBA rgba(double red, double green, double blue, double alpha = 1.0) {
  std_msgs::ColorRGBA colour;
  colour.r = static_cast<float>(red);
  colour.g = static_cast<float>(green);
  colour.b = static_cast<float>(blue);
  colour.a = static_cast<float>(alpha);
  return colour;
}

}  // namespace

std_msgs::ColorRGBA depth(double share) {
  static const std::array<std_msgs::ColorRGBA, 5> stops{
      rgba(1.00, 0.93, 0.20), rgba(1.00, 0.60, 0.10), rgba(0.95, 0.25, 0.35),
      rgba(0.65, 0.05, 0.60), rgba(0.20, 0.02, 0.45)};
  const double place = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t lower = std::min<std::size_t>(place, stops.size() - 2);
  const auto &from = stops[lower], &to = stops[lower + 1];
  const auto between = [&](float a, float b) { return a + (place - lower) * (b - a); };
  return rgba(between(from.r, to.r), between(from.g, to.g), between(from.b, to.b));
}

std_msgs::ColorRGBA tissue(std::size_t number) {
  static const std::array<std_msgs::ColorRGBA, 5> tissues{
      rgba(0.72, 0.34, 0.28), rgba(0.80, 0.62, 0.45), rgba(0.55, 0.62, 0.42),
      rgba(0.78, 0.52, 0.58), rgba(0.52, 0.42, 0.55)};
  return tissues[number % tissues.size()];
}

std_msgs::ColorRGBA tool() { return rgba(0.85, 0.87, 0.90); }
std_msgs::ColorRGBA swept() { return rgba(0.20, 0.60, 1.00, 0.45); }
std_msgs::ColorRGBA region() { return rgba(0.05, 0.05, 0.05); }
std_msgs::ColorRGBA normal() { return rgba(0.20, 0.85, 0.45); }
std_msgs::ColorRGBA near_face() { return rgba(0.35, 0.85, 0.95, 0.80); }
std_msgs::ColorRGBA clearance() { return rgba(0.35, 0.95, 1.00); }
std_msgs::ColorRGBA entering() { return rgba(1.00, 0.65, 0.10); }
std_msgs::ColorRGBA leaving() { return rgba(0.25, 0.45, 1.00); }
std_msgs::ColorRGBA hand() { return rgba(0.45, 0.75, 1.00, 0.40); }
std_msgs::ColorRGBA load() { return rgba(1.00, 0.80, 0.15); }
std_msgs::ColorRGBA text() { return rgba(0.95, 0.95, 0.95); }
std_msgs::ColorRGBA failure() { return rgba(1.00, 0.45, 0.35); }

std_msgs::ColorRGBA proxy(ProxyStatus state) {
  switch (state) {
    case ProxyStatus::kFree:
      return text();
    case ProxyStatus::kTouching:
      return rgba(0.30, 0.95, 0.50);
    case ProxyStatus::kSqueezed:
      return rgba(1.00, 0.65, 0.10);
    case ProxyStatus::kPunctured:
      return rgba(0.80, 0.50, 1.00);
    case ProxyStatus::kNoAnswer:
      break;
  }
  return failure();
}

std_msgs::ColorRGBA faded(std_msgs::ColorRGBA colour, double share) {
  colour.a *= static_cast<float>(share);
  return colour;
}

}  // namespace organ_collision::colours
