#include "proof/first_touch_oracle.hpp"

#include <algorithm>

#include "proof/exact_distance.hpp"

namespace organ_collision::oracle {
namespace {

class Search {
 public:
  Search(const ShaftMotion& shaft, const FaceMotion& face, double radius, double slack)
      : shaft_(shaft), face_(face), radius_(radius), slack_(slack) {
    double corner = 0.0;
    for (int i = 0; i < 3; ++i) corner = std::max(corner, (face.end[i] - face.start[i]).norm());
    speed_ = corner + std::max((shaft.end.trocar - shaft.start.trocar).norm(),
                               (shaft.end.tip - shaft.start.tip).norm());
  }

  /// Looks at the interval, earlier half first, until it knows when they surely meet.
  void look(double from, double to) {
    const double half = 0.5 * (to - from), middle = from + half;
    const double gap = distance_at(middle) - radius_;
    if (gap > half * speed_ + slack_) return;
    if (half * speed_ < slack_) {
      if (!found_.possibly) found_.possibly = from;
      if (gap <= -slack_) found_.certainly = middle;
      return;
    }
    look(from, middle);
    if (!found_.certainly) look(middle, to);
  }

  const FirstTime& found() const { return found_; }

 private:
  double distance_at(double time) const {
    const auto between = [time](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return Eigen::Vector3d((1.0 - time) * a + time * b);
    };
    const Eigen::Vector3d tip = between(shaft_.start.tip, shaft_.end.tip);
    return distance({between(shaft_.start.trocar, shaft_.end.trocar), tip, tip},
                    {between(face_.start[0], face_.end[0]), between(face_.start[1], face_.end[1]),
                     between(face_.start[2], face_.end[2])});
  }

  const ShaftMotion& shaft_;
  const FaceMotion& face_;
  const double radius_, slack_;
  double speed_;  ///< [m] in the whole leg
  FirstTime found_;
};

}  // namespace

FirstTime first_time_within(const ShaftMotion& shaft, const FaceMotion& face, double radius,
                            double slack) {
  Search search(shaft, face, radius, slack);
  search.look(0.0, 1.0);
  return search.found();
}

}  // namespace organ_collision::oracle
