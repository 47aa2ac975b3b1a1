#pragma once

#include <std_msgs/ColorRGBA.h>

#include <cstddef>

#include "organ_collision/query/haptic_proxy.hpp"

namespace organ_collision::colours {

/// The colour map of depths: `share` is 0 for a first touch (yellow) and 1 for the greatest depth
/// that the map distinguishes (dark violet). Values beyond are clamped.
std_msgs::ColorRGBA depth(double share);

/// The surface of an organ. `number`: its place among the organs; neighbours differ.
std_msgs::ColorRGBA tissue(std::size_t number);

std_msgs::ColorRGBA tool();
std_msgs::ColorRGBA swept();
std_msgs::ColorRGBA region();
std_msgs::ColorRGBA normal();
std_msgs::ColorRGBA near_face();
std_msgs::ColorRGBA clearance();
/// Where a shaft's axis enters and leaves an organ. Both differ also for the colour-blind.
std_msgs::ColorRGBA entering();
std_msgs::ColorRGBA leaving();
/// A tool where the hand has it, while tissue holds its proxy back.
std_msgs::ColorRGBA hand();
/// What a proxy does: its text, and the line between hand and proxy.
std_msgs::ColorRGBA proxy(ProxyStatus state);
/// The force of a proxy on the tissue.
std_msgs::ColorRGBA load();
std_msgs::ColorRGBA text();
std_msgs::ColorRGBA failure();

/// The colour with its opacity multiplied by `share` in [0, 1].
std_msgs::ColorRGBA faded(std_msgs::ColorRGBA colour, double share);

}  // namespace organ_collision::colours
