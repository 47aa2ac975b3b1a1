#include "tool.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"
#include "geometry/plausible_size.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "robot_reader_client.hpp"

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

Eigen::Isometry3d checked_pose(const RobotShape& shape) {
  const Eigen::Vector3d position(&shape.pose[0]);
  const Eigen::Quaterniond orientation(&shape.pose[3]);
  if (!is_in_range(position)) {
    refuse("a shape's origin is ", position.transpose(), "; must be finite and within ",
           tolerance::kFarthest, " m");
  }
  if (!(std::abs(orientation.norm() - 1.0) <= 1e-6)) {
    refuse("a shape's orientation is ", orientation.coeffs().transpose(),
           "; must be a unit quaternion, of finite angles");
  }
  return Eigen::Translation3d(position) * orientation.normalized();
}

LinkPart mesh_part(const RobotShape& shape) {
  std::vector<Eigen::Vector3d> vertices;
  for (std::size_t i = 0; i < shape.vertices.size(); i += 3) {
    vertices.emplace_back(&shape.vertices[i]);
  }
  std::vector<FaceIndices> faces;
  for (std::size_t i = 0; i < shape.triangles.size(); i += 3) {
    faces.push_back({shape.triangles[i], shape.triangles[i + 1], shape.triangles[i + 2]});
  }
  try {
    return LinkPart::mesh({std::move(vertices), std::move(faces)});
  } catch (const MeshError& error) {
    refuse("mesh '", shape.file, "': ", error.what());
  }
}

LinkPart part_of(const RobotShape& shape) {
  const Eigen::Vector3d size(&shape.size[0]);
  switch (shape.kind) {
    case RobotShape::SPHERE:
      return LinkPart::sphere(checked_pose(shape).translation(),
                              checked_size("a sphere's radius", size[0]));
    case RobotShape::CYLINDER:
      return LinkPart::cylinder(checked_pose(shape), checked_size("a cylinder's radius", size[0]),
                                checked_size("a cylinder's length", size[1]));
    case RobotShape::BOX:
      for (int axis = 0; axis < 3; ++axis) checked_size("a box's side", size[axis]);
      return LinkPart::box(checked_pose(shape), size);
    case RobotShape::MESH:
      return mesh_part(shape);
    default:
      refuse("the shape has the unknown kind ", int{shape.kind});
  }
}

std::string find_text(const std::string& parameter, const ros::NodeHandle& private_node) {
  std::string resolved, text;
  // For the name a/b, searchParam() looks only for a. So the parameter a/b may be missing there.
  if (!private_node.searchParam(parameter, resolved) || !private_node.hasParam(resolved)) {
    throw ToolError("is set neither in " + private_node.getNamespace() +
                    " nor in a namespace above; load the robot's URDF there, name the parameter "
                    "that holds it, or give the tool's urdf");
  }
  if (!private_node.getParam(resolved, text)) throw ToolError("is no text; must be a URDF");
  return text;
}

bool is_same(const Tool& a, const Tool& b) {
  const auto members = [](const Tool& tool) {
    const ToolParameters& p = tool.parameters;
    return std::tie(p.name, p.trocar_frame, p.tip_frame, p.radius, p.tip_pose_topic,
                    p.base_pose_topic, p.links, p.jaws, p.grasp_gap, p.robot_description, p.urdf,
                    p.tf_prefix, p.margin, p.max_near, p.freedom, p.lockstep, p.trocar_offset,
                    p.tip_offset, tool.fault, tool.fingerprint);
  };
  return members(a) == members(b);
}

std::optional<std::size_t> find(const std::vector<Tool>& tools, const std::string& name) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (tools[i].parameters.name == name) return i;
  }
  return std::nullopt;
}

}  // namespace

Link build_link(const std::string& name, const RobotLink& description) {
  Link link{name, {}};
  try {
    for (const RobotShape& shape : description.shapes) link.parts.push_back(part_of(shape));
    if (link.parts.empty()) refuse("has no collision or visual geometry; name links that have");
  } catch (const ToolError& error) {
    refuse("link '", name, "': ", error.what());
  }
  return link;
}

std::vector<Tool> load_tools(const std::vector<ToolParameters>& parameters,
                             const ros::NodeHandle& private_node) {
  std::vector<Tool> tools;
  for (const ToolParameters& of_tool : parameters) {
    tools.push_back(load_tool(of_tool, [&](const auto& p) { return find_text(p, private_node); }));
  }
  return tools;
}

Tool load_tool(const ToolParameters& parameters, const FindText& find_text) {
  Tool tool;
  tool.parameters = parameters;
  if (parameters.links.empty()) return tool;
  const bool is_file = !parameters.urdf.empty();
  try {
    const std::vector<RobotLink> links =
        is_file ? read_robot(parameters.urdf, "", parameters.links)
                : read_robot("-", find_text(parameters.robot_description), parameters.links);
    tool.fingerprint = std::hash<std::string>()(reply_of(links));
    for (std::size_t i = 0; i < links.size(); ++i) {
      tool.joints.push_back(links[i].joint);
      tool.links.push_back(build_link(parameters.links[i], links[i]));
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

std::vector<std::string> doubts(const Tool& tool) {
  const ToolParameters& parameters = tool.parameters;
  std::vector<std::string> found;
  const auto add = [&found](const std::string& doubt) {
    if (!doubt.empty()) found.push_back(doubt);
  };
  if (parameters.has_shaft())
    add(doubt_about_radius("tool '" + parameters.name + "'", parameters.radius));
  for (const Link& link : tool.links) {
    double size = 0.0;
    for (const LinkPart& part : link.parts) {
      size = std::max(size, 2.0 * (part.bounds.half_size.maxCoeff() + part.radius));
    }
    add(doubt_about_link(parameters.name, link.name, size));
  }
  return found;
}

std::string doubt_about_place(const ToolParameters& tool, const ShaftAxis& axis,
                              const std::vector<Eigen::Isometry3d>& links,
                              const Eigen::Isometry3d& T_organ_tool, const std::string& organ,
                              const Eigen::AlignedBox3f& box) {
  double farthest = 0.0;
  const auto look_at = [&](const Eigen::Vector3d& place) {
    farthest = std::max(farthest, box.cast<double>().exteriorDistance(T_organ_tool * place));
  };
  for (const Eigen::Isometry3d& link : links) look_at(link.translation());
  if (tool.has_shaft()) {
    look_at(axis.trocar);
    look_at(axis.tip);
  }
  return doubt_about_distance(tool.name, organ, farthest);
}

ToolInfo info_of(const Tool& tool) {
  const ToolParameters& parameters = tool.parameters;
  ToolInfo info;
  info.name = parameters.name;
  info.kind = parameters.links.empty() ? ToolInfo::SHAFT : ToolInfo::LINKS;
  info.trocar_frame = parameters.trocar_frame;
  info.tip_frame = parameters.tip_frame;
  info.trocar_offset = to_vector(parameters.trocar_offset);
  info.tip_offset = to_vector(parameters.tip_offset);
  info.pose_topic = parameters.tip_pose_topic;
  info.links = parameters.links;
  info.first_jaw = parameters.jaws[0];
  info.second_jaw = parameters.jaws[1];
  info.radius = parameters.radius;
  info.margin = parameters.margin;
  info.max_near = static_cast<std::uint32_t>(parameters.max_near);
  info.fault = tool.fault;
  return info;
}

ToolChanges compare_tools(const std::vector<Tool>& old_tools, const std::vector<Tool>& new_tools) {
  ToolChanges changes;
  std::vector<std::string> unchanged, changed, added, removed;
  for (const Tool& tool : new_tools) {
    const auto before = find(old_tools, tool.parameters.name);
    const bool is_kept = before && is_same(old_tools[*before], tool);
    changes.kept.push_back(is_kept ? before : std::nullopt);
    (is_kept ? unchanged : before ? changed : added).push_back(tool.parameters.name);
  }
  for (const Tool& tool : old_tools) {
    if (!find(new_tools, tool.parameters.name)) removed.push_back(tool.parameters.name);
  }
  for (const auto& [what, names] :
       {std::pair("unchanged: ", &unchanged), std::pair("changed: ", &changed),
        std::pair("new: ", &added), std::pair("removed: ", &removed)}) {
    if (names->empty()) continue;
    changes.summary += (changes.summary.empty() ? "" : "; ") + (what + quoted(*names));
  }
  if (changes.summary.empty()) changes.summary = "there are no tools";
  return changes;
}

}  // namespace organ_collision
