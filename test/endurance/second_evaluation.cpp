#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "soak.hpp"
#include "test/proof/step_oracle.hpp"

namespace organ_collision::soak {
namespace {

using oracle::ToolStep;

// [m]
constexpr double kTolerance = 1e-7;
/// The node leaves out poses that change the way of a link by at most 1e-6 m (PathBuilder).
constexpr double kLinkTolerance = kTolerance + 1e-6;
/// What the search for contacts leaves undecided.
constexpr double kUndecided = 1e-8;
constexpr Tick kLongest = 50;
/// [m] Nothing of a tool is farther than this from its axis or from the origin of its link.
constexpr double kShaftReach = 3e-3, kJawReach = 11e-3;

bool is_swept(const ContactArray& answer) { return answer.mode == ContactArray::SWEPT; }

/// The tools of soak.py.
struct ToolShape {
  double radius = 0.0;  ///< [m] of the shaft; 0: there is none
  Eigen::Vector3d trocar = Eigen::Vector3d::Zero();
  std::vector<Link> links = {};

  double tolerance() const { return links.empty() ? kTolerance : kLinkTolerance; }
};

/// `smaller`: by how much its surface lies further inside [m].
ToolShape shape_of(const std::string& tool, double smaller = 0.0) {
  if (tool == "probe") return {2e-3 - smaller, kProbeTrocar};
  if (tool == "needle") return {1e-3 - smaller, kNeedleTrocar};
  if (tool == "stylus") return {1.5e-3 - smaller, kStylusTrocar};
  const Eigen::Vector3d size = Eigen::Vector3d(0.004, 0.003, 0.02).array() - 2.0 * smaller;
  return {0.0, {}, {{"jaw", {LinkPart::box(Eigen::Isometry3d::Identity(), size)}}}};
}

Eigen::Vector3d tip_of(const std::string& tool, const ToolPlaces& places) {
  if (tool == "probe") return places.probe_tip;
  if (tool == "needle") return places.needle_tip;
  return places.stylus_tip;
}

ToolWaypoint waypoint(const std::string& tool, const ToolShape& shape, double fraction,
                      const ToolPlaces& places) {
  if (shape.radius > 0.0) return {fraction, {shape.trocar, tip_of(tool, places)}, {}};
  return {fraction, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, {places.jaw}};
}

/// Through each pose that the simulator has sent.
ToolPath path_of(const Script& script, const ContactArray& answer, const ToolShape& shape) {
  const Tick begin = tick_of(answer.step_start), end = tick_of(answer.header.stamp);
  if (!is_swept(answer)) return {waypoint(answer.tool, shape, 0.0, script.tools(end))};
  ToolPath path = {waypoint(answer.tool, shape, 0.0, script.tools(begin))};
  for (Tick tick = begin + 1; tick < end; ++tick) {
    if (!script.has_poses(tick)) continue;
    const double fraction = static_cast<double>(tick - begin) / static_cast<double>(end - begin);
    path.push_back(waypoint(answer.tool, shape, fraction, script.tools(tick)));
  }
  path.push_back(waypoint(answer.tool, shape, 1.0, script.tools(end)));
  return path;
}

Eigen::AlignedBox3d box_around(const ToolPath& path, bool has_shaft) {
  Eigen::AlignedBox3d box;
  for (const ToolWaypoint& waypoint : path) {
    if (has_shaft) box.extend(waypoint.axis.trocar).extend(waypoint.axis.tip);
    for (const Eigen::Isometry3d& pose : waypoint.links) box.extend(pose.translation());
  }
  const double reach = has_shaft ? kShaftReach : kJawReach;
  box.min().array() -= reach;
  box.max().array() += reach;
  return box;
}

/// The organ's shapes at the start and at the end of a step, with some of the faces.
class Shapes {
 public:
  Shapes(const Script& script, const AnsweredStep& step)
      : now_(script.vertices(tick_of(step.answer->mesh_stamp))),
        triangles_(script.triangles(step.answer->topology)) {
    const bool moves = is_swept(*step.answer) && step.before->topology == step.answer->topology;
    before_ = moves ? script.vertices(tick_of(step.before->mesh_stamp)) : now_;
  }

  std::size_t face_count() const { return triangles_.size() / 3; }
  bool meets(std::size_t face, const Eigen::AlignedBox3d& box) const {
    Eigen::AlignedBox3d around;
    for (std::size_t i = 3 * face; i < 3 * face + 3; ++i) {
      around.extend(vertex(before_, triangles_[i])).extend(vertex(now_, triangles_[i]));
    }
    return around.intersects(box);
  }
  ToolStep step(const std::vector<std::size_t>& faces, ToolPath path, const ToolShape& tool) const {
    std::vector<std::uint32_t> triangles;
    for (const std::size_t face : faces) {
      triangles.insert(triangles.end(), &triangles_[3 * face], &triangles_[3 * face] + 3);
    }
    return {{before_, triangles}, {now_, triangles}, std::move(path), tool.radius, tool.links};
  }

 private:
  static Eigen::Vector3d vertex(const std::vector<float>& vertices, std::uint32_t index) {
    return Eigen::Map<const Eigen::Vector3f>(&vertices[3 * index]).cast<double>();
  }

  std::vector<float> now_, before_;
  std::vector<std::uint32_t> triangles_;
};

}  // namespace

std::string why_not_checkable(const Script& script, const AnsweredStep& step) {
  const ContactArray& answer = *step.answer;
  const Tick begin = tick_of(answer.step_start), end = tick_of(answer.header.stamp);
  if (!script.has_poses(end)) return "it ends between poses";
  if (answer.unresolved > 0) return "it has unresolved contacts";
  if (!is_swept(answer)) return "";
  if (!step.before || step.before->header.stamp != answer.step_start) return "its start is unknown";
  if (!script.has_poses(begin)) return "it begins between poses";
  if (end - begin > kLongest) return "it is long";
  return "";
}

std::optional<std::string> wrong_contacts(const Script& script, const AnsweredStep& step) {
  const ContactArray& answer = *step.answer;
  const Glitch glitch = script.glitch(tick_of(answer.mesh_stamp));
  if (glitch == Glitch::kHuge || glitch == Glitch::kNotFinite)
    return "an illegal shape is answered";
  const ToolShape tool = shape_of(answer.tool);
  const ToolPath path = path_of(script, answer, tool);
  const Shapes shapes(script, step);

  std::set<std::size_t> touched;
  for (const Contact& contact : answer.contacts) {
    if (contact.face >= shapes.face_count()) return "a contact has a face that does not exist";
    touched.insert(contact.face);
  }
  if (!touched.empty()) {
    const std::vector<std::size_t> faces(touched.begin(), touched.end());
    const ToolStep contacts = shapes.step(faces, path, tool);
    for (std::size_t i = 0; i < faces.size(); ++i) {  // One link: one contact for each face.
      if (!is_within(contacts, i, answer.contacts[i].fraction, tool.tolerance())) {
        return "a contact does not touch";
      }
    }
  }

  std::vector<std::size_t> near;
  const Eigen::AlignedBox3d box = box_around(path, tool.radius > 0.0);
  for (std::size_t face = 0; face < shapes.face_count(); ++face) {
    if (touched.count(face) == 0 && shapes.meets(face, box)) near.push_back(face);
  }
  if (near.empty()) return "";
  double closest = INFINITY;
  const ToolShape inside = shape_of(answer.tool, tool.tolerance());
  if (stays_above(shapes.step(near, path, inside), kUndecided, closest)) return "";
  if (closest < kUndecided) return "a touched face has no contact";
  return std::nullopt;
}

}  // namespace organ_collision::soak
