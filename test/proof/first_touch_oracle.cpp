#include "first_touch_oracle.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "exact_distance.hpp"

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

class Search {
 public:
  /// `distance`: the distance at a time of the leg [m]. `speed`: an upper bound of its change in
  /// the whole leg [m].
  Search(std::function<double(double)> distance, double speed, double radius, double slack)
      : distance_(std::move(distance)), speed_(speed), radius_(radius), slack_(slack) {}

  /// Searches the interval, its earlier half first, until a time is found at which core and face
  /// certainly meet.
  void look(double from, double to) {
    const double half = 0.5 * (to - from), middle = from + half;
    const double gap = distance_(middle) - radius_;
    if (gap > half * speed_ + slack_) return;
    if (half * speed_ < slack_ || ++looks_ > kMostLooks) {
      if (!found_.possibly) found_.possibly = from;
      if (gap <= -slack_) found_.certainly = middle;
      return;
    }
    look(from, middle);
    if (!found_.certainly) look(middle, to);
  }

  FirstTime in_the_leg() {
    look(0.0, 1.0);
    return found_;
  }

 private:
  /// Ends the search when face and core slide along each other. `certainly` may then be missing.
  static constexpr int kMostLooks = 200'000;

  const std::function<double(double)> distance_;
  const double speed_, radius_, slack_;
  int looks_ = 0;
  FirstTime found_;
};

Vector3d between(const Vector3d& from, const Vector3d& to, double time) {
  return (1.0 - time) * from + time * to;
}

Triangle at(const FaceMotion& face, double time) {
  return {between(face.start[0], face.end[0], time), between(face.start[1], face.end[1], time),
          between(face.start[2], face.end[2], time)};
}

/// How far the fastest corner moves in the whole leg [m].
double speed(const FaceMotion& face) {
  double corner = 0.0;
  for (int i = 0; i < 3; ++i) corner = std::max(corner, (face.end[i] - face.start[i]).norm());
  return corner;
}

/// An upper bound on how far any point of the core moves in the whole leg [m].
double speed(const LinkTrial& trial) {
  double reach = 0.0;
  for (std::size_t i = 0; i < trial.core.count; ++i) {
    reach = std::max(reach, trial.core.points[i].norm());
  }
  const Eigen::Quaterniond from(trial.start.linear()), to(trial.end.linear());
  return (trial.end.translation() - trial.start.translation()).norm() +
         (reach + trial.core.rim.norm()) * from.angularDistance(to);
}

}  // namespace

FirstTime first_time_within(const ShaftMotion& shaft, const FaceMotion& face, double radius,
                            double slack) {
  const auto distance_at = [&](double time) {
    const Vector3d tip = between(shaft.start.tip, shaft.end.tip, time);
    return distance({between(shaft.start.trocar, shaft.end.trocar, time), tip, tip},
                    at(face, time));
  };
  const double axis = std::max((shaft.end.trocar - shaft.start.trocar).norm(),
                               (shaft.end.tip - shaft.start.tip).norm());
  return Search(distance_at, axis + speed(face), radius, slack).in_the_leg();
}

FirstTime first_time_within(const LinkTrial& trial, const FaceMotion& face, double slack) {
  const auto distance_at = [&](double time) {
    return closest_points(pose_at(trial, time) * trial.core, at(face, time)).distance;
  };
  return Search(distance_at, speed(trial) + speed(face), trial.radius, slack).in_the_leg();
}

Eigen::Isometry3d pose_at(const LinkTrial& trial, double time) {
  const Eigen::Quaterniond from(trial.start.linear()), to(trial.end.linear());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = from.slerp(time, to).toRotationMatrix();
  pose.translation() = between(trial.start.translation(), trial.end.translation(), time);
  return pose;
}

}  // namespace organ_collision::oracle
