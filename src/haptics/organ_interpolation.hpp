#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <string>

#include "node/organs/organ_registry.hpp"

namespace organ_collision {

/// Moves organs from shape to shape over the time between shapes, one such time late, so that
/// shapes that come at 60 Hz do not push a hand sixty times a second. An organ begins each way
/// where it is, and rests when it has arrived. New triangles are there at once, and so is the first
/// shape of a sender that has restarted. The velocity of the tissue is OrganShape::moves_from(), as
/// without interpolation.
class OrganInterpolation {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The longest way. Shapes that come more rarely are reached within this time.
  static constexpr std::chrono::milliseconds kLongest{100};
  /// [vertices] The shapes of larger organs are there at once: to compute them would take longer
  /// than a tick may.
  static constexpr std::size_t kLargest = 50'000;

  /// Takes the latest shapes, which came at `now`.
  void update(const OrganRegistry& organs, Time now);
  /// The shape of an organ at `now`.
  std::shared_ptr<const TriangleMesh> shape(const DeformableOrgan& organ, Time now);
  /// [s] How old the shape at `now` is, seen from the stamp of the latest one.
  double late(const DeformableOrgan& organ, Time now) const;
  /// Whether a shape is on its way.
  bool is_moving(Time now) const;

 private:
  struct Way {
    std::shared_ptr<const TriangleMesh> from, to;
    Time start{};          ///< when the shape `to` came
    double seconds = 0.0;  ///< how long the way takes; 0: the organ rests

    double late = 0.0;  ///< [s] how long `from` was before `to`, by their stamps

    double share(Time now) const;
    double late_at(Time now) const { return (1.0 - share(now)) * late; }
  };

  static std::shared_ptr<const TriangleMesh> shape_on(const Way& way, Time now);

  std::map<std::string, Way> ways_;  ///< by organ
};

}  // namespace organ_collision
