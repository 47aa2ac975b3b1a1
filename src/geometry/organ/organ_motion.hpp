#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "organ_collision/geometry/organ/face_clusters.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/triangle.hpp"

namespace organ_collision {

/// A face whose corners move linearly during one leg of the tool's path [m].
struct FaceMotion {
  Triangle start;
  Triangle end;

  /// The face at `time` in [0, 1] of the leg.
  Triangle at(double time) const {
    return {start[0] + time * (end[0] - start[0]), start[1] + time * (end[1] - start[1]),
            start[2] + time * (end[2] - start[2])};
  }
  /// [m] The largest distance by which a corner moves during the leg.
  double farthest_move() const {
    double squared = 0.0;
    for (int i = 0; i < 3; ++i) squared = std::max(squared, (end[i] - start[i]).squaredNorm());
    return std::sqrt(squared);
  }
  /// [m] The largest absolute coordinate of the corners at both ends of the leg.
  double largest_coordinate() const {
    return std::max(organ_collision::largest_coordinate(start),
                    organ_collision::largest_coordinate(end));
  }
};

/// The surface of an organ during a part of a step, in the organ's frame [m]. The organ rests, or
/// each vertex moves linearly. This object refers to meshes that must outlive it.
class OrganMotion {
 public:
  /// An organ at rest.
  explicit OrganMotion(const TriangleMesh& organ)
      : before_(&organ), boxes_before_(&organ.block_boxes()), after_(&organ) {}
  /// The part from fraction `begin` to fraction `finish`, in [0, 1], of a step in which the organ
  /// moves from the shape `before` to the shape `after`. Both meshes have the same faces.
  /// `boxes_before` are the boxes of the shape `before` for the clusters of `after`.
  OrganMotion(const TriangleMesh& before, const BlockBoxes& boxes_before, const TriangleMesh& after,
              double begin, double finish)
      : before_(&before),
        boxes_before_(&boxes_before),
        after_(&after),
        begin_(begin),
        finish_(finish) {}

  bool rests() const { return before_ == after_; }
  /// The shapes at the start and at the end of the whole step.
  const TriangleMesh& before() const { return *before_; }
  const BlockBoxes& boxes_before() const { return *boxes_before_; }
  const TriangleMesh& after() const { return *after_; }
  /// The fractions of the step at which this part of it begins and ends.
  double begin() const { return begin_; }
  double finish() const { return finish_; }

  /// The motion of one face during this part of the step.
  FaceMotion face(const FaceIndices& corners) const {
    const Triangle end = after_->triangle(corners);
    if (rests()) return {end, end};
    const FaceMotion whole{before_->triangle(corners), end};
    return {whole.at(begin_), finish_ == 1.0 ? end : whole.at(finish_)};
  }
  /// [m] The largest absolute coordinate of any vertex at any time of the whole step, relative to
  /// `origin`.
  double extent(const Eigen::Vector3d& origin) const {
    Eigen::AlignedBox3f box = after_->box();
    if (!rests()) box.extend(before_->box());
    const Eigen::Vector3d low = box.min().cast<double>() - origin;
    const Eigen::Vector3d high = box.max().cast<double>() - origin;
    return std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  }

 private:
  const TriangleMesh* before_;
  const BlockBoxes* boxes_before_;
  const TriangleMesh* after_;
  double begin_ = 0.0, finish_ = 1.0;
};

}  // namespace organ_collision
