#include "passage_oracle.hpp"

#include <algorithm>

#include "test/proof/exact_distance.hpp"
#include "test/proof/rounded_distance.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

struct Pair {
  const ShaftMotion& segment;
  const Triangle& before;
  const Triangle& now;
  double bound;  ///< [m]

  double distance(double time) const {
    Triangle face;
    for (int i = 0; i < 3; ++i) face[i] = (1.0 - time) * before[i] + time * now[i];
    return rounded_distance(core(segment.at(time)), face);
  }

  /// How far a point of the segment moves relative to one of the face, at most [m].
  double relative_motion() const {
    double most = 0.0;
    for (const Vector3d& end : {Vector3d(segment.end.trocar - segment.start.trocar),
                                Vector3d(segment.end.tip - segment.start.tip)}) {
      for (int i = 0; i < 3; ++i) most = std::max(most, (end - (now[i] - before[i])).norm());
    }
    return most;
  }
};

bool meets(const Pair& pair, double motion, double from, double to) {
  const double middle = 0.5 * (from + to), reach = 0.5 * (to - from) * motion;
  const double distance = pair.distance(middle);
  if (distance <= pair.bound) return true;
  if (distance - reach > pair.bound) return false;
  return meets(pair, motion, from, middle) || meets(pair, motion, middle, to);
}

}  // namespace

bool passes(const ShaftMotion& segment, const Triangle& before, const Triangle& now,
            double distance) {
  const Pair pair{segment, before, now, distance};
  return meets(pair, pair.relative_motion(), 0.0, 1.0);
}

}  // namespace organ_collision::oracle
