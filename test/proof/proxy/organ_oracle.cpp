#include "organ_oracle.hpp"

#include <algorithm>
#include <utility>

#include "test/proof/exact_distance.hpp"
#include "test/proof/exact_sides.hpp"

namespace organ_collision::oracle {
namespace {

ShaftAxis middle_line(const OrientedBox& box) {
  Eigen::Index longest = 0;
  const double length = box.half_size.maxCoeff(&longest) - box.half_size.minCoeff();
  const Eigen::Vector3d half = length * box.axes.col(longest);
  return {box.center - half, box.center + half};
}

ShaftAxis moved(const Eigen::Isometry3d& T_to_from, const ShaftAxis& axis) {
  return {T_to_from * axis.trocar, T_to_from * axis.tip};
}

}  // namespace

std::vector<ShaftAxis> skeleton(const ProxyTool& tool, const ToolPose& pose) {
  std::vector<ShaftAxis> lines;
  if (tool.radius > 0.0) lines.push_back(pose.axis);
  for (std::size_t link = 0; link < tool.links.size(); ++link) {
    for (const LinkPart& part : tool.links[link].parts) {
      lines.push_back(moved(pose.links[link], middle_line(part.bounds)));
    }
  }
  return lines;
}

ToolPose operator*(const Eigen::Isometry3d& T_to_from, const ToolPose& pose) {
  ToolPose result = pose;
  result.axis = moved(T_to_from, pose.axis);
  for (Eigen::Isometry3d& link : result.links) link = T_to_from * link;
  return result;
}

namespace {

using Eigen::Vector3d;

double distance_to(const ShaftAxis& segment, const Vector3d& point) {
  const Vector3d along = segment.tip - segment.trocar, from = point - segment.trocar;
  const double length2 = along.squaredNorm();
  const double place = length2 > 0.0 ? std::clamp(from.dot(along) / length2, 0.0, 1.0) : 0.0;
  return (from - place * along).norm();
}

/// A segment and a radius that enclose a core.
struct Capsule {
  ShaftAxis axis;
  double radius;
};

Capsule capsule_around(const ConvexCore& core) {
  if (core.is_axis()) return {core.axis(), 0.0};
  Vector3d center = Vector3d::Zero();
  for (std::size_t i = 0; i < core.count; ++i) center += core.points[i];
  center /= static_cast<double>(core.count);
  double radius = 0.0;
  for (std::size_t i = 0; i < core.count; ++i) {
    radius = std::max(radius, (core.points[i] - center).norm());
  }
  return {{center, center}, radius + core.rim.norm()};
}

}  // namespace

void OrganOracle::set_shape(std::shared_ptr<const TriangleMesh> shape) {
  const bool is_known = shape == shape_;
  last_ = std::exchange(shape_, std::move(shape));
  motion_ = 0.0;
  if (is_known) return;
  if (last_ && !last_->same_faces(*shape_)) last_ = nullptr;
  if (!last_) last_ = shape_;
  balls_.clear();
  for (std::size_t face = 0; face < shape_->face_count(); ++face) {
    const Triangle corners = shape_->triangle(face), old = last_->triangle(face);
    Ball ball{(corners[0] + corners[1] + corners[2]) / 3.0, 0.0};
    for (int i = 0; i < 3; ++i) {
      ball.radius = std::max(ball.radius, (corners[i] - ball.center).norm());
      motion_ = std::max(motion_, (corners[i] - old[i]).norm());
    }
    balls_.push_back(ball);
  }
}

Triangle OrganOracle::at(std::size_t face, double time) const {
  Triangle corners = last_->triangle(face);
  const Triangle now = shape_->triangle(face);
  for (int i = 0; i < 3; ++i) corners[i] += time * (now[i] - corners[i]);
  return corners;
}

double OrganOracle::distance(const std::vector<PlacedCore>& tool, double bound) const {
  Eigen::AlignedBox3d around_all;
  for (const PlacedCore& part : tool) {
    const Capsule around = capsule_around(part.core);
    const Vector3d reach = Vector3d::Constant(around.radius + part.radius);
    for (const Vector3d& end : {around.axis.trocar, around.axis.tip}) {
      around_all.extend(end - reach).extend(end + reach);
    }
  }
  double least = bound;
  for (std::size_t face = 0; face < balls_.size(); ++face) {
    if (around_all.exteriorDistance(balls_[face].center) - balls_[face].radius > least) continue;
    for (const PlacedCore& part : tool) {
      const Capsule around = capsule_around(part.core);
      const double reach = around.radius + part.radius + balls_[face].radius;
      if (distance_to(around.axis, balls_[face].center) - reach > least) continue;
      least = std::min(least, rounded_distance(part.core, shape_->triangle(face)) - part.radius);
    }
  }
  return least;
}

bool OrganOracle::is_passed(const std::vector<ShaftMotion>& segments, double begin, double end,
                            double distance) const {
  for (const ShaftMotion& segment : segments) {
    const double reach = distance + motion_ +
                         std::max((segment.end.trocar - segment.start.trocar).norm(),
                                  (segment.end.tip - segment.start.tip).norm());
    for (std::size_t face = 0; face < balls_.size(); ++face) {
      if (distance_to(segment.end, balls_[face].center) - balls_[face].radius > reach) continue;
      if (passes(segment, {at(face, begin), at(face, end)}, distance)) return true;
    }
  }
  return false;
}

int OrganOracle::winding(const Vector3d& point) const {
  std::vector<Triangle> faces;
  for (std::size_t face = 0; face < shape_->face_count(); ++face) {
    faces.push_back(shape_->triangle(face));
  }
  return exact_winding(faces, point);
}

}  // namespace organ_collision::oracle
