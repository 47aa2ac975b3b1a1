#include "organ_collision/ros/robot_model.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <sstream>

#include "organ_collision/geometry/tolerances.hpp"
#include "organ_collision/ros/mesh_file.hpp"
#include "organ_collision/ros/spelling.hpp"
#include "organ_collision/ros/tool_error.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d to_eigen(const urdf::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

Eigen::Isometry3d to_eigen(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  return Eigen::Translation3d(to_eigen(pose.position)) * Eigen::Quaterniond(q.w, q.x, q.y, q.z);
}

/// Takes what urdfdom says through console_bridge, for as long as it lives.
class ScopedErrorCollector : public console_bridge::OutputHandler {
 public:
  explicit ScopedErrorCollector(std::vector<std::string>& errors)
      : errors_(errors), former_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~ScopedErrorCollector() override { console_bridge::useOutputHandler(former_); }
  ScopedErrorCollector(const ScopedErrorCollector&) = delete;
  ScopedErrorCollector& operator=(const ScopedErrorCollector&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* file,
           int line) override {
    if (level == console_bridge::CONSOLE_BRIDGE_LOG_ERROR) {
      errors_.push_back(text);
    } else if (former_) {
      former_->log(text, level, file, line);
    }
  }

 private:
  std::vector<std::string>& errors_;
  console_bridge::OutputHandler* former_;
};

/// urdfdom goes on after a shape that it cannot read, but without this and all further ones of the
/// link; its last error names the link, and the one before says why.
void check_complete(const std::string& link, const std::vector<std::string>& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i].find("Link [" + link + "]") == std::string::npos) continue;
    const bool explained = i > 0 && errors[i - 1].find("Link [") == std::string::npos;
    throw ToolError(explained ? errors[i - 1] + "; " + errors[i] : errors[i]);
  }
}

double checked_size(const std::string& what, double size) {
  if (size > 0.0 && size <= tolerance::kFarthest) return size;
  std::ostringstream message;
  message << what << " is " << size << "; must be more than 0 and at most " << tolerance::kFarthest
          << " m";
  throw ToolError(message.str());
}

Eigen::Isometry3d checked_origin(const urdf::Pose& pose) {
  const Vector3d position = to_eigen(pose.position);
  if ((position.array().abs() <= tolerance::kFarthest).all()) return to_eigen(pose);
  std::ostringstream message;
  message << "a shape's origin is " << position.transpose() << "; must be finite and within "
          << tolerance::kFarthest << " m";
  throw ToolError(message.str());
}

LinkPart sphere(const urdf::Sphere& sphere, const Eigen::Isometry3d& T_link_shape) {
  return LinkPart::sphere(T_link_shape.translation(),
                          checked_size("a sphere's radius", sphere.radius));
}

LinkPart cylinder(const urdf::Cylinder& cylinder, const Eigen::Isometry3d& T_link_shape) {
  return LinkPart::cylinder(T_link_shape, checked_size("a cylinder's radius", cylinder.radius),
                            checked_size("a cylinder's length", cylinder.length));
}

LinkPart box(const urdf::Box& box, const Eigen::Isometry3d& T_link_shape) {
  for (const double side : {box.dim.x, box.dim.y, box.dim.z}) checked_size("a box's side", side);
  return LinkPart::box(T_link_shape, to_eigen(box.dim));
}

LinkPart part(const urdf::Geometry& shape, const Eigen::Isometry3d& T_link_shape) {
  switch (shape.type) {
    case urdf::Geometry::SPHERE:
      return sphere(static_cast<const urdf::Sphere&>(shape), T_link_shape);
    case urdf::Geometry::CYLINDER:
      return cylinder(static_cast<const urdf::Cylinder&>(shape), T_link_shape);
    case urdf::Geometry::BOX:
      return box(static_cast<const urdf::Box&>(shape), T_link_shape);
    case urdf::Geometry::MESH:
      break;
  }
  const auto& mesh = static_cast<const urdf::Mesh&>(shape);
  return LinkPart::mesh(read_mesh_file(mesh.filename, to_eigen(mesh.scale), T_link_shape));
}

/// Of collision or visual elements.
template <typename Elements>
std::vector<LinkPart> parts(const Elements& elements) {
  std::vector<LinkPart> parts;
  for (const auto& element : elements) {
    parts.push_back(part(*element->geometry, checked_origin(element->origin)));
  }
  return parts;
}

std::vector<LinkPart> parts(const urdf::Link& link) {
  if (!link.collision_array.empty()) return parts(link.collision_array);
  if (!link.visual_array.empty()) return parts(link.visual_array);
  throw ToolError("has no collision or visual geometry; name links that have");
}

std::vector<std::string> link_names(const urdf::ModelInterface& model) {
  std::vector<std::string> names;
  for (const auto& [name, link] : model.links_) names.push_back(name);
  return names;
}

}  // namespace

RobotModel::RobotModel(const std::string& urdf) {
  {
    const ScopedErrorCollector collector(errors_);
    model_ = urdf::parseURDF(urdf);
  }
  if (!model_) throw ToolError("no legal URDF: " + listed(errors_));
}

Link RobotModel::link(const std::string& name) const {
  const urdf::LinkConstSharedPtr link = model_->getLink(name);
  if (!link) {
    const std::vector<std::string> legal = link_names(*model_);
    throw ToolError("link '" + name + "' is unknown; nearest is '" + nearest_name(name, legal) +
                    "', legal are " + listed(legal));
  }
  try {
    check_complete(name, errors_);
    return {name, parts(*link)};
  } catch (const ToolError& error) {
    throw ToolError("link '" + name + "': " + error.what());
  }
}

std::string RobotModel::moving_joint(const std::string& link) const {
  const urdf::JointSharedPtr joint = model_->getLink(link)->parent_joint;
  return joint && joint->type != urdf::Joint::FIXED ? joint->name : "";
}

}  // namespace organ_collision
