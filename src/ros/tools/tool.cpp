#include "tool.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/concatenate.hpp"
#include "geometry/coordinate_range.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "robot_reader_client.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

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

LinkPart mesh_part(MeshDescription mesh) {
  try {
    return LinkPart::mesh({std::move(mesh.vertices), std::move(mesh.triangles)});
  } catch (const MeshError& error) {
    refuse("mesh '", mesh.file, "': ", error.what());
  }
}

LinkPart part_of(ShapeDescription shape) {
  const Eigen::Vector3d& size = shape.size;
  switch (shape.kind) {
    case ShapeKind::kSphere:
      return LinkPart::sphere(checked_pose(shape.pose).translation(),
                              checked_size("a sphere's radius", size[0]));
    case ShapeKind::kCylinder:
      return LinkPart::cylinder(checked_pose(shape.pose),
                                checked_size("a cylinder's radius", size[0]),
                                checked_size("a cylinder's length", size[1]));
    case ShapeKind::kBox:
      for (int axis = 0; axis < 3; ++axis) checked_size("a box's side", size[axis]);
      return LinkPart::box(checked_pose(shape.pose), size);
    case ShapeKind::kMesh:
      break;
  }
  return mesh_part(std::move(shape.mesh));
}

std::string find_text(const std::string& parameter, const ros::NodeHandle& private_node) {
  std::string resolved, text;
  // For a/b, searchParam looks only for a: a/b may be missing there.
  if (!private_node.searchParam(parameter, resolved) || !private_node.hasParam(resolved)) {
    throw ToolError("is set neither in " + private_node.getNamespace() +
                    " nor in a namespace above; load the robot's URDF there, name the parameter "
                    "that holds it, or give the tool's urdf");
  }
  if (!private_node.getParam(resolved, text)) throw ToolError("is no text; must be a URDF");
  return text;
}

template <typename Range, typename Same>
bool are_same(const Range& a, const Range& b, const Same& same) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

bool is_same(const ConvexCore& a, const ConvexCore& b) {
  return std::equal(a.points.begin(), a.points.begin() + a.count, b.points.begin(),
                    b.points.begin() + b.count) &&
         a.rim == b.rim;
}

bool is_same(const LinkPart& a, const LinkPart& b) {
  if (!a.surface != !b.surface || a.radius != b.radius) return false;
  if (!a.surface) return is_same(a.core, b.core);
  return a.surface->vertices() == b.surface->vertices() && a.surface->faces() == b.surface->faces();
}

bool is_same(const ToolParameters& a, const ToolParameters& b) {
  const auto members = [](const ToolParameters& p) {
    return std::tie(p.name, p.trocar_frame, p.tip_frame, p.radius, p.tip_pose_topic,
                    p.base_pose_topic, p.links, p.robot_description, p.urdf, p.tf_prefix, p.margin,
                    p.max_near, p.freedom);
  };
  return members(a) == members(b);
}

bool is_same(const Tool& a, const Tool& b) {
  const auto same_part = [](const LinkPart& c, const LinkPart& d) { return is_same(c, d); };
  const auto same_link = [&](const Link& c, const Link& d) {
    return c.name == d.name && are_same(c.parts, d.parts, same_part);
  };
  return is_same(a.parameters, b.parameters) && a.joints == b.joints && a.fault == b.fault &&
         are_same(a.links, b.links, same_link);
}

std::optional<std::size_t> find(const std::vector<Tool>& tools, const std::string& name) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (tools[i].parameters.name == name) return i;
  }
  return std::nullopt;
}

}  // namespace

Link build_link(const std::string& name, LinkDescription description) {
  Link link{name, {}};
  try {
    for (ShapeDescription& shape : description.shapes) {
      link.parts.push_back(part_of(std::move(shape)));
    }
    if (link.parts.empty()) refuse("has no collision or visual geometry; name links that have");
  } catch (const ToolError& error) {
    refuse("link '", name, "': ", error.what());
  }
  return link;
}

Tool load_tool(const ToolParameters& parameters, const ros::NodeHandle& private_node) {
  return load_tool(
      parameters, [&](const std::string& parameter) { return find_text(parameter, private_node); });
}

Tool load_tool(const ToolParameters& parameters,
               const std::function<std::string(const std::string& parameter)>& find_text) {
  Tool tool;
  tool.parameters = parameters;
  if (parameters.links.empty()) return tool;
  const bool is_file = !parameters.urdf.empty();
  try {
    std::vector<LinkDescription> links =
        is_file ? read_robot_file(parameters.urdf, parameters.links)
                : read_robot_text(find_text(parameters.robot_description), parameters.links);
    for (std::size_t i = 0; i < links.size(); ++i) {
      tool.joints.push_back(links[i].joint);
      tool.links.push_back(build_link(parameters.links[i], std::move(links[i])));
    }
  } catch (const std::exception& error) {
    tool.links.clear();
    tool.joints.clear();
    const std::string fault = parameters.name + ": " + (is_file ? "urdf " : "parameter ") + "'" +
                              (is_file ? parameters.urdf : parameters.robot_description) +
                              "': " + error.what();
    tool.fault = plain_text(fault, kLongestMessage);
  }
  return tool;
}

ToolChanges compare_tools(const std::vector<Tool>& old_tools, const std::vector<Tool>& new_tools) {
  ToolChanges changes;
  std::vector<std::string> unchanged, changed, added, removed;
  for (const Tool& tool : new_tools) {
    const auto before = find(old_tools, tool.parameters.name);
    const bool is_kept = before && is_same(old_tools[*before], tool);
    changes.kept.push_back(is_kept ? before : std::nullopt);
    (is_kept ? unchanged : before ? changed : added).push_back("'" + tool.parameters.name + "'");
  }
  for (const Tool& tool : old_tools) {
    if (!find(new_tools, tool.parameters.name)) removed.push_back("'" + tool.parameters.name + "'");
  }
  for (const auto& [what, names] :
       {std::pair("unchanged: ", &unchanged), std::pair("changed: ", &changed),
        std::pair("new: ", &added), std::pair("removed: ", &removed)}) {
    if (names->empty()) continue;
    changes.summary += (changes.summary.empty() ? "" : "; ") + (what + listed(*names));
  }
  if (changes.summary.empty()) changes.summary = "there are no tools";
  return changes;
}

}  // namespace organ_collision
