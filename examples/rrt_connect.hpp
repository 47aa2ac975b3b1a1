#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>
#include <vector>

// RRT-Connect (Kuffner and LaValle, 2000): two trees of configurations, one from the start and one
// from the goals, grow towards random configurations and towards each other.
namespace rrt_connect {

using Place = Eigen::VectorXd;
using Path = std::vector<Place>;
/// The last place that is free on the straight line from a to b.
using Advance = std::function<Place(const Place& a, const Place& b)>;
/// A random place.
using Sample = std::function<Place()>;

/// From the start to one of the goals. Empty if `most` samples do not suffice.
Path connect(const Place& start, const Path& goals, const Advance& advance, const Sample& sample,
             int most);

/// The path without detours that straight lines can replace.
Path shortened(Path path, const Advance& advance, std::mt19937& random, int attempts);

}  // namespace rrt_connect
