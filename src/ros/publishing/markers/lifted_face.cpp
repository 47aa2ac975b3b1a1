#include "lifted_face.hpp"

#include "marker_sheet.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

constexpr double kLift = 1e-3;  ///< as a share of the organ's size

}  // namespace

void add_lifted_face(const SceneOrgan& organ, std::size_t face, const std_msgs::ColorRGBA& colour,
                     visualization_msgs::Marker& list) {
  const Triangle corners = organ.triangle(face);
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const Vector3d up = kLift * organ.size() * normal;
  for (const Vector3d& shift : {up, Vector3d(-up)}) {
    for (const Vector3d& corner : corners) {
      add_point(list, corner + shift);
      list.colors.push_back(colour);
    }
  }
}

}  // namespace organ_collision
