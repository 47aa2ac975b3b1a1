#include "tool_step.hpp"

#include <iomanip>
#include <ostream>

namespace organ_collision::oracle {
namespace {

using Eigen::Vector3d;

Vector3d between(const Vector3d& from, const Vector3d& to, double time) {
  return (1.0 - time) * from + time * to;
}

Eigen::Isometry3d between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double time) {
  const Eigen::Quaterniond first(from.linear()), last(to.linear());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = first.slerp(time, last).toRotationMatrix();
  pose.translation() = between(from.translation(), to.translation(), time);
  return pose;
}

const Eigen::IOFormat kRow(Eigen::FullPrecision, Eigen::DontAlignCols, ", ", "; ", "", "", "{",
                           "}");

void print_part(const LinkPart& part, std::ostream& out) {
  if (part.surface) {
    out << "\n  surface";
    for (std::size_t i = 0; i < part.surface->faces().size(); ++i) {
      for (const Vector3d& corner : part.surface->triangle(i)) {
        out << ' ' << corner.transpose().format(kRow);
      }
    }
  } else {
    out << "\n  core";
    for (std::size_t i = 0; i < part.core.count; ++i) {
      out << ' ' << part.core.points[i].transpose().format(kRow);
    }
    out << " rim " << part.core.rim.transpose().format(kRow);
  }
  out << " radius " << part.radius;
}

}  // namespace

Triangle face_at(const ToolStep& step, std::size_t face, double fraction) {
  if (step.at_rest()) return step.now.triangle(face);
  const Triangle from = step.before.triangle(face), to = step.now.triangle(face);
  return {between(from[0], to[0], fraction), between(from[1], to[1], fraction),
          between(from[2], to[2], fraction)};
}

ToolPose pose_at(const ToolStep& step, double fraction) {
  const ToolPath& path = step.path;
  std::size_t next = 1;
  while (next < path.size() && path[next].fraction < fraction) ++next;
  if (next >= path.size()) return {path.back().axis, path.back().links};
  const ToolWaypoint &from = path[next - 1], &to = path[next];
  const double time = (fraction - from.fraction) / (to.fraction - from.fraction);
  ToolPose pose{
      {between(from.axis.trocar, to.axis.trocar, time), between(from.axis.tip, to.axis.tip, time)},
      {}};
  for (std::size_t i = 0; i < step.links.size(); ++i) {
    pose.links.push_back(between(from.links[i], to.links[i], time));
  }
  return pose;
}

std::ostream& operator<<(std::ostream& out, const ToolStep& step) {
  out << std::setprecision(17) << "radius " << step.radius;
  for (const ToolWaypoint& waypoint : step.path) {
    out << "\nat " << waypoint.fraction;
    if (step.radius > 0.0) {
      out << " axis " << waypoint.axis.trocar.transpose().format(kRow) << ' '
          << waypoint.axis.tip.transpose().format(kRow);
    }
    for (const Eigen::Isometry3d& pose : waypoint.links) {
      out << " link " << pose.matrix().topRows<3>().format(kRow);
    }
  }
  for (const Link& link : step.links) {
    for (const LinkPart& part : link.parts) print_part(part, out);
  }
  for (std::size_t face = 0; face < step.now.face_count(); ++face) {
    out << "\nface";
    for (const Vector3d& corner : step.before.triangle(face)) {
      out << ' ' << corner.transpose().format(kRow);
    }
    out << " to";
    for (const Vector3d& corner : step.now.triangle(face)) {
      out << ' ' << corner.transpose().format(kRow);
    }
  }
  return out;
}

}  // namespace organ_collision::oracle
