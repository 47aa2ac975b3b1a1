#include "robot_model.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <exception>
#include <utility>

#include "mesh_file.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

Vector3d to_eigen(const urdf::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

ShapePose to_eigen(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  return {to_eigen(pose.position), {q.w, q.x, q.y, q.z}};
}

/// While an object of this class lives, collects the errors that urdfdom logs through
/// console_bridge. What else it logs is left out.
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

using AboutToRead = std::function<void(const std::string&)>;

MeshDescription mesh(const urdf::Mesh& mesh, const ShapePose& pose,
                     const AboutToRead& about_to_read) {
  about_to_read("mesh '" + mesh.filename + "'");
  const Eigen::Isometry3d T_link_mesh = Eigen::Translation3d(pose.position) * pose.orientation;
  return read_mesh_file(mesh.filename, to_eigen(mesh.scale), T_link_mesh);
}

ShapeDescription shape(const urdf::Geometry& geometry, const ShapePose& pose,
                       const AboutToRead& about_to_read) {
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      return {
          ShapeKind::kSphere, pose, {static_cast<const urdf::Sphere&>(geometry).radius, 0.0, 0.0}};
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      return {ShapeKind::kCylinder, pose, {cylinder.radius, cylinder.length, 0.0}};
    }
    case urdf::Geometry::BOX:
      return {ShapeKind::kBox, pose, to_eigen(static_cast<const urdf::Box&>(geometry).dim)};
    case urdf::Geometry::MESH:
      break;
  }
  return {ShapeKind::kMesh,
          {},
          Vector3d::Zero(),
          mesh(static_cast<const urdf::Mesh&>(geometry), pose, about_to_read)};
}

/// The shapes of collision or visual elements.
template <typename Elements>
std::vector<ShapeDescription> shapes(const Elements& elements, const AboutToRead& about_to_read) {
  std::vector<ShapeDescription> shapes;
  for (const auto& element : elements) {
    shapes.push_back(shape(*element->geometry, to_eigen(element->origin), about_to_read));
  }
  return shapes;
}

std::vector<ShapeDescription> shapes(const urdf::Link& link, const AboutToRead& about_to_read) {
  if (!link.collision_array.empty()) return shapes(link.collision_array, about_to_read);
  return shapes(link.visual_array, about_to_read);
}

std::string moving_joint(const urdf::Link& link) {
  const urdf::JointSharedPtr& joint = link.parent_joint;
  return joint && joint->type != urdf::Joint::FIXED ? joint->name : "";
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

LinkDescription RobotModel::link(const std::string& name, const AboutToRead& about_to_read) const {
  const urdf::LinkConstSharedPtr link = model_->getLink(name);
  if (!link) {
    const std::vector<std::string> legal = link_names(*model_);
    throw ToolError("link '" + name + "' is unknown; nearest is '" + nearest_name(name, legal) +
                    "', legal are " + listed(legal));
  }
  const std::string prefix = "link '" + name + "': ";
  try {
    check_complete(name, errors_);
    return {moving_joint(*link),
            shapes(*link, [&](const std::string& mesh) { about_to_read(prefix + mesh); })};
  } catch (const ToolError& error) {
    throw ToolError(prefix + error.what());
  }
}

namespace {

std::string read_links(const std::string& urdf, const std::vector<std::string>& names,
                       const std::function<void(const std::string&)>& write) {
  const RobotModel robot(urdf);
  std::vector<LinkDescription> links;
  for (const std::string& name : names) {
    links.push_back(
        robot.link(name, [&](const std::string& what) { write(reading_record(what)); }));
  }
  return links_record(std::move(links));
}

}  // namespace

void answer_with_links(const std::function<std::string()>& urdf,
                       const std::vector<std::string>& links,
                       const std::function<void(const std::string&)>& write) {
  try {
    write(read_links(urdf(), links, write));
  } catch (const std::exception& error) {
    write(refusal_record(error.what()));
  }
}

}  // namespace organ_collision
