#include "request_check.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/concatenate.hpp"
#include "geometry/plausible_size.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "picking/volumes/paper_volumes.hpp"

namespace organ_collision {
namespace {

/// Throws unless the condition holds. The text is made only then.
template <typename... Parts>
void require(bool condition, const Parts&... text) {
  if (!condition) throw std::invalid_argument(concatenate(text...));
}

/// `name`: the parts of the point's name, which are put together only for a refusal.
template <typename... Parts>
void check_point(const Eigen::Vector3d& point, const Parts&... name) {
  require(is_in_range(point), name..., " is (", point.x(), ", ", point.y(), ", ", point.z(),
          "); must be finite and within ", tolerance::kFarthest, " m");
}

/// Checks the poses of all links. `of`: the parts of the name of what has them.
template <typename... Parts>
void check_links(const std::vector<Link>& links, const std::vector<Eigen::Isometry3d>& poses,
                 const Parts&... of) {
  require(poses.size() == links.size(), of..., " has poses of ", poses.size(),
          " links; the tool has ", links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    check_point(poses[i].translation(), links[i].name, " of ", of...);
    const Eigen::Matrix3d& rotation = poses[i].linear();
    const double determinant = rotation.determinant();
    require((rotation * rotation.transpose()).isIdentity(kRotationTolerance) && determinant > 0.0,
            "the orientation of ", links[i].name, " of ", of..., " has the determinant ",
            determinant, "; must be a rotation: orthonormal within ", kRotationTolerance,
            ", right-handed");
  }
}

template <typename... Parts>
void check_axis(const ShaftAxis& axis, const Parts&... of) {
  check_point(axis.trocar, "trocar of ", of...);
  check_point(axis.tip, "tip of ", of...);
}

void check_joints(const ToolWaypoint& waypoint, std::size_t index) {
  for (const ShaftArc& arc : waypoint.arcs) {
    require(std::isfinite(arc.deviation()), "an arc to waypoint ", index,
            " is not finite; its joints must be");
  }
  const std::size_t count = waypoint.joints.size();
  require(count == 0 || count == waypoint.links.size(), "waypoint ", index, " has joints of ",
          count, " links, and poses of ", waypoint.links.size());
}

void check_path(const CollisionRequest& request) {
  const ToolPath& path = request.path;
  require(!path.empty(), "the tool's path is empty; it has at least one waypoint");
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (request.radius > 0.0) {
      check_axis(path[i].axis, "waypoint ", i);
    }
    check_joints(path[i], i);
    if (request.links) check_links(*request.links, path[i].links, "waypoint ", i);
    require(path[i].links.size() == path[0].links.size(), "waypoint ", i, " has poses of ",
            path[i].links.size(), " links, and the first one of ", path[0].links.size());
    if (i == 0) continue;
    require(path[i].fraction > path[i - 1].fraction, "waypoint ", i, " is at fraction ",
            path[i].fraction, " after ", path[i - 1].fraction, "; fractions must rise");
  }
  const double begin = path.front().fraction, end = path.back().fraction;
  require(path.size() == 1 || (begin == 0.0 && end == 1.0), "the path runs from fraction ", begin,
          " to ", end, "; must be from 0 to 1");
}

void check_radius(const CollisionRequest& request) {
  const bool has_links = request.links && !request.links->empty();
  if (has_links && request.radius == 0.0) {
    require(!is_paper_mode(request.mode),
            "the paper's modes need a shaft; the tool has links alone");
  } else {
    require(request.radius > 0.0 && is_in_range(request.radius), "radius is ", request.radius,
            " m; must be positive, finite and within ", tolerance::kFarthest, " m");
  }
}

void check_clearance(const CollisionRequest& request) {
  require(request.margin >= 0.0 && std::isfinite(request.margin), "margin is ", request.margin,
          " m; must be 0 (off) or positive, and finite");
  require(request.max_near == 0 || request.margin > 0.0, "max_near is ", request.max_near,
          " and margin is 0; faces are near within a margin, which must be positive then");
  require(!is_paper_mode(request.mode) || !asks_for_clearance(request),
          "the paper's modes have no clearance and no near faces; the modes static and swept do");
}

void check_seconds(double seconds, const char* name) {
  require(std::isfinite(seconds) && seconds > 0.0, name, " is ", seconds,
          " s; must be positive and finite");
}

void check_velocities(const CollisionRequest& request) {
  if (const TriangleMesh* const from = request.velocity_from) {
    check_seconds(request.velocity_sec, "velocity_sec");
    require(from->same_faces(*request.organ), "the shape from which velocities count has ",
            from->face_count(), " other faces than the present one, which has ",
            request.organ->face_count());
  }
  if (!request.pose_before) return;
  check_seconds(request.pose_before_sec, "pose_before_sec");
  if (request.radius > 0.0) check_axis(request.pose_before->axis, "pose_before");
  if (request.links) check_links(*request.links, request.pose_before->links, "pose_before");
}

void check_placement(const CollisionRequest& request) {
  require(!is_paper_mode(request.mode), "placement is asked for; the paper's modes have none");
  if (const SurfaceTopology* const topology = request.surface_topology) {
    const std::size_t of_organ = request.organ->vertex_count(), own = topology->welded().size();
    require(own == of_organ, "the placement's topology has ", own,
            " vertices; must be as many as the organ has, ", of_organ);
  }
  if (request.tip) check_point(*request.tip, "the placement's tip");
}

}  // namespace

void check(const CollisionRequest& request) {
  require(request.organ != nullptr, "the request names no organ");
  require(request.mode <= QueryMode::kPaperNaive, "mode is ", static_cast<int>(request.mode),
          "; legal are 0 to 4");
  check_radius(request);
  check_path(request);
  check_clearance(request);
  if (is_paper_mode(request.mode) && !is_static_mode(request.mode)) {
    const Eigen::Vector3d &from = request.path.front().axis.trocar,
                          &to = request.path.back().axis.trocar;
    require(from == to, "the trocar moves by ", (to - from).norm(),
            " m during the step; it must rest in the paper's modes");
  }
  if (const TriangleMesh* const before = request.organ_before) {
    require(before->same_faces(*request.organ), "the organ's earlier shape has ",
            before->face_count(), " other faces than the present one, which has ",
            request.organ->face_count());
  }
  check_velocities(request);
  if (request.placement) check_placement(request);
}

ViewingVolume paper_volume(const CollisionRequest& request) {
  const ShaftMotion motion{request.path.front().axis, request.path.back().axis};
  if (request.mode == QueryMode::kPaperSwept) return paper_swept_volume(motion, request.radius);
  if (request.mode == QueryMode::kPaperNaive) return paper_naive_volume(motion, request.radius);
  return paper_static_volume(motion.end, request.radius);
}

void check_tool(const ProxyTool& tool) {
  require(std::isfinite(tool.radius) && tool.radius >= 0.0, "the radius of the proxy's tool is ",
          tool.radius, " m; it must be >= 0 and finite");
  if (tool.radius > 0.0) return;
  const bool has_parts = std::any_of(tool.links.begin(), tool.links.end(),
                                     [](const Link& link) { return !link.parts.empty(); });
  require(has_parts,
          "the proxy's tool has neither a shaft nor links with parts; give it a radius > 0 or "
          "links");
  require(tool.freedom == ProxyFreedom::kFree,
          "the proxy's tool has no shaft (its radius is 0), so it cannot go through a trocar; let "
          "it be free");
}

void check_settings(const ProxyTool& tool, const ProxySettings& settings) {
  const auto is_positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  require(is_positive(settings.clearance), "the clearance is ", settings.clearance,
          " m; it must be > 0 and finite");
  require(settings.row_reach >= 0.0 && std::isfinite(settings.row_reach), "the row_reach is ",
          settings.row_reach, " m; it must be >= 0 and finite");
  require(settings.jump > 0.0, "the jump is ", settings.jump, " m; it must be > 0");
  require(settings.friction == 0.0 || is_positive(settings.friction), "the friction is ",
          settings.friction, " m; it must be >= 0 and finite");
  if (!settings.puncture) return;
  require(*settings.puncture > 0.0, "the puncture is ", *settings.puncture, " m; it must be > 0");
  require(tool.freedom == ProxyFreedom::kTrocar,
          "a puncture is set for a free tool; only a shaft through a trocar can pierce tissue");
}

void check_hand(const ProxyTool& tool, const ToolPose& hand) {
  if (tool.radius > 0.0) check_axis(hand.axis, "the hand's pose");
  check_links(tool.links, hand.links, "the hand's pose");
}

void check_organs(const ProxyTool& tool, const std::vector<ProxyOrgan>& organs) {
  for (const ProxyOrgan& organ : organs) {
    require(organ.shape != nullptr, "organ '", organ.name, "' has no shape");
    const Eigen::Matrix3d turned = organ.T_organ_proxy.linear();
    require(organ.T_organ_proxy.matrix().allFinite() && turned.isUnitary(kRotationTolerance) &&
                turned.determinant() > 0.0,
            "the frame of organ '", organ.name,
            "' has a pose that is not finite, or whose linear part is not a rotation");
    require(organ.keep != Side::kOnSurface, "organ '", organ.name,
            "' is to keep a proxy on its surface; legal are the outside, the inside and unknown");
    const std::size_t parts = 1 + tool.links.size(), count = organ.clearances.size();
    require(count == 0 || count == parts, "organ '", organ.name, "' has ", count,
            " clearances; it must have none, or one of the shaft and one of each link: ", parts);
    for (const double clearance : organ.clearances) {
      require(clearance >= 0.0 && std::isfinite(clearance), "a clearance of organ '", organ.name,
              "' is ", clearance, " m; it must be >= 0 and finite");
    }
    require(organ.most_advance >= 0.0 && std::isfinite(organ.most_advance), "organ '", organ.name,
            "' has advanced by ", organ.most_advance, " m at most; it must be >= 0 and finite");
    require(organ.most_approach >= 0.0 && std::isfinite(organ.most_approach), "organ '", organ.name,
            "' approaches at ", organ.most_approach, " m/s at most; it must be >= 0 and finite");
    const auto same_name =
        std::count_if(organs.begin(), organs.end(),
                      [&](const ProxyOrgan& other) { return other.name == organ.name; });
    require(same_name == 1, "two organs have the name '", organ.name, "'");
  }
}

}  // namespace organ_collision
