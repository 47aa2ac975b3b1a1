#include "robot_model.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include "common/messages/text.hpp"
#include "robot_files.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d to_eigen(const urdf::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

/// While an object of this class lives, collects the errors that urdfdom logs through
/// console_bridge. Everything else that urdfdom logs is dropped.
class ScopedErrorCollector : public console_bridge::OutputHandler {
 public:
  explicit ScopedErrorCollector(std::vector<std::string>& errors) : errors_(errors) {
    console_bridge::useOutputHandler(this);
  }
  ~ScopedErrorCollector() override { console_bridge::restorePreviousOutputHandler(); }
  ScopedErrorCollector(const ScopedErrorCollector&) = delete;
  ScopedErrorCollector& operator=(const ScopedErrorCollector&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level == console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_.push_back(text);
  }

 private:
  std::vector<std::string>& errors_;
};

/// Refuses a link that urdfdom read only in part. When urdfdom cannot read a shape, it skips this
/// and all further shapes of the link. It then logs an error that names the link; the error before
/// it, if any, explains why.
void check_complete(const std::string& link, const std::vector<std::string>& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i].find("Link [" + link + "]") == std::string::npos) continue;
    const bool explained = i > 0 && errors[i - 1].find("Link [") == std::string::npos;
    throw ToolError(explained ? errors[i - 1] + "; " + errors[i] : errors[i]);
  }
}

/// How the mesh files that a URDF names are found.
struct MeshFiles {
  std::string folder;  ///< that of the URDF, with a slash at its end; empty: the URDF is no file
  std::function<void(const std::string& mesh)> about_to_read;  ///< called before a mesh is read

  /// The file with this name. A relative name begins at the URDF's folder.
  std::string find(const std::string& name) const {
    const bool is_whole = name.find("://") != std::string::npos || name.find('/') == 0;
    return is_whole ? name : folder + name;
  }
};

RobotShape shape_of(const urdf::Geometry& geometry, const urdf::Pose& origin,
                    const MeshFiles& files) {
  const urdf::Vector3& p = origin.position;
  const urdf::Rotation& q = origin.rotation;
  RobotShape shape;
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      shape.kind = RobotShape::SPHERE;
      shape.size[0] = static_cast<const urdf::Sphere&>(geometry).radius;
      break;
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      shape.kind = RobotShape::CYLINDER;
      shape.size = {{cylinder.radius, cylinder.length, 0.0}};
      break;
    }
    case urdf::Geometry::BOX: {
      const urdf::Vector3& sides = static_cast<const urdf::Box&>(geometry).dim;
      shape.kind = RobotShape::BOX;
      shape.size = {{sides.x, sides.y, sides.z}};
      break;
    }
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      files.about_to_read("mesh '" + mesh.filename + "'");
      const Eigen::Isometry3d T_link_mesh =
          Eigen::Translation3d(to_eigen(p)) * Eigen::Quaterniond(q.w, q.x, q.y, q.z);
      shape = read_mesh_file(files.find(mesh.filename), to_eigen(mesh.scale), T_link_mesh);
    }
  }
  shape.pose = {{p.x, p.y, p.z, q.x, q.y, q.z, q.w}};
  return shape;
}

/// The shapes of a link's collision elements, or of its visual elements.
template <typename Elements>
std::vector<RobotShape> shapes_of(const Elements& elements, const MeshFiles& files) {
  std::vector<RobotShape> shapes;
  for (const auto& element : elements) {
    shapes.push_back(shape_of(*element->geometry, element->origin, files));
  }
  return shapes;
}

/// Throws ToolError if there is no such link, or a shape or mesh cannot be read. `errors`: all
/// errors of urdfdom, also about links that it read only in part.
RobotLink read_link(const urdf::ModelInterface& model, const std::vector<std::string>& errors,
                    const std::string& name, const MeshFiles& files) {
  const urdf::LinkConstSharedPtr link = model.getLink(name);
  if (!link) {
    std::vector<std::string> legal;
    for (const auto& [known, of_robot] : model.links_) legal.push_back(known);
    throw ToolError("link '" + name + "' is unknown; " + suggestion(name, legal));
  }
  const std::string prefix = "link '" + name + "': ";
  try {
    check_complete(name, errors);
    const MeshFiles of_link{files.folder,
                            [&](const std::string& mesh) { files.about_to_read(prefix + mesh); }};
    RobotLink description;
    const urdf::JointSharedPtr& joint = link->parent_joint;
    if (joint && joint->type != urdf::Joint::FIXED) description.joint = joint->name;
    description.shapes = link->collision_array.empty() ? shapes_of(link->visual_array, of_link)
                                                       : shapes_of(link->collision_array, of_link);
    return description;
  } catch (const ToolError& error) {
    throw ToolError(prefix + error.what());
  }
}

}  // namespace

std::vector<RobotLink> read_links(const std::string& urdf, const std::vector<std::string>& links,
                                  const std::string& folder,
                                  const std::function<void(const std::string&)>& about_to_read) {
  std::vector<std::string> errors;
  urdf::ModelInterfaceSharedPtr model;
  {
    const ScopedErrorCollector collector(errors);
    model = urdf::parseURDF(urdf);
  }
  if (!model) throw ToolError("no legal URDF: " + listed(errors));
  std::vector<RobotLink> found;
  for (const std::string& name : links) {
    found.push_back(read_link(*model, errors, name, {folder, about_to_read}));
  }
  return found;
}

}  // namespace organ_collision
