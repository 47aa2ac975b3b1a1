#include "middle_face.hpp"

#include <Eigen/LU>

namespace organ_collision {

Triangle middle_face(const ViewingVolume& volume) {
  Eigen::Matrix<double, 4, 3> corners;  // in clip coordinates, around the middle
  corners << -0.5, 0.5, 0.0,            //
      -0.5, -0.5, 1.0,                  //
      0.0, 0.0, 0.0,                    //
      1.0, 1.0, 1.0;
  corners = (volume.clip().inverse() * corners).eval();
  const auto point = [&](Eigen::Index i) -> Eigen::Vector3d {
    return corners.col(i).hnormalized();
  };
  return {point(0), point(1), point(2)};
}

}  // namespace organ_collision
