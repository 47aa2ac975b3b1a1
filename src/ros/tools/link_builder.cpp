#include "link_builder.hpp"

#include <cmath>
#include <utility>

#include "geometry/concatenate.hpp"
#include "geometry/coordinate_range.hpp"
#include "link_description.hpp"
#include "organ_collision/geometry/tolerances.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  throw ToolError(concatenate(parts...));
}

double checked_size(const std::string& what, double size) {
  if (size > 0.0 && is_in_range(size)) return size;
  refuse(what, " is ", size, "; must be more than 0 and at most ", tolerance::kFarthest, " m");
}

Eigen::Isometry3d checked_pose(const ShapePose& pose) {
  if (!is_in_range(pose.position)) {
    refuse("a shape's origin is ", pose.position.transpose(), "; must be finite and within ",
           tolerance::kFarthest, " m");
  }
  if (!(std::abs(pose.orientation.norm() - 1.0) <= 1e-6)) {
    refuse("a shape's orientation is ", pose.orientation.coeffs().transpose(),
           "; must be a unit quaternion, of finite angles");
  }
  return Eigen::Translation3d(pose.position) * pose.orientation.normalized();
}

LinkPart part(const SphereDescription& sphere) {
  return LinkPart::sphere(checked_pose(sphere.pose).translation(),
                          checked_size("a sphere's radius", sphere.radius));
}

LinkPart part(const CylinderDescription& cylinder) {
  return LinkPart::cylinder(checked_pose(cylinder.pose),
                            checked_size("a cylinder's radius", cylinder.radius),
                            checked_size("a cylinder's length", cylinder.length));
}

LinkPart part(const BoxDescription& box) {
  for (int axis = 0; axis < 3; ++axis) checked_size("a box's side", box.size[axis]);
  return LinkPart::box(checked_pose(box.pose), box.size);
}

LinkPart part(MeshDescription& mesh) {
  try {
    return LinkPart::mesh({std::move(mesh.vertices), std::move(mesh.triangles)});
  } catch (const MeshError& error) {
    refuse("mesh '", mesh.file, "': ", error.what());
  }
}

}  // namespace

Link build_link(const std::string& name, LinkDescription description) {
  Link link{name, {}};
  try {
    for (ShapeDescription& shape : description.shapes) {
      link.parts.push_back(std::visit([](auto& described) { return part(described); }, shape));
    }
    if (link.parts.empty()) refuse("has no collision or visual geometry; name links that have");
  } catch (const ToolError& error) {
    refuse("link '", name, "': ", error.what());
  }
  return link;
}

}  // namespace organ_collision
