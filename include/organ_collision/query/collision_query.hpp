#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/surface_topology.hpp"
#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/picking/picker_settings.hpp"
#include "organ_collision/query/clearance.hpp"
#include "organ_collision/query/contact.hpp"
#include "organ_collision/query/placement.hpp"

/// The libraries without ROS. Start at CollisionQuery.
namespace organ_collision {

/// What is asked about one step of a tool. The values are those of msg/ContactArray.msg.
enum class QueryMode : std::uint8_t {
  kStatic = 0,       ///< what the tool touches at the end of its path
  kSwept = 1,        ///< what the tool touches anywhere on its path
  kPaperStatic = 2,  ///< the faces in the static volume of the 1999 paper, without exact distances
  kPaperSwept = 3,   ///< the faces in the paper's swept volume, without exact distances
  kPaperNaive = 4    ///< the faces in the paper's naive swept volume, without exact distances
};

/// Whether a mode looks only at the end of the path.
constexpr bool is_static_mode(QueryMode mode) {
  return mode == QueryMode::kStatic || mode == QueryMode::kPaperStatic;
}

/// Whether a mode returns the faces in one of the paper's volumes, without exact distances.
constexpr bool is_paper_mode(QueryMode mode) {
  return mode != QueryMode::kStatic && mode != QueryMode::kSwept;
}

/// One question: which faces of an organ does a tool touch, or did it touch during one step? On
/// request also: how far is it, which faces are near, and on which side of the surface is it?
///
/// All lengths are in metres. All positions and poses are in the organ's frame. A request refers to
/// its meshes and links and does not own them: they must outlive the call of evaluate().
struct CollisionRequest {
  /// The organ's shape at the end of the step. Required.
  const TriangleMesh* organ = nullptr;
  /// The organ's shape at the start of the step, with the same faces. Each vertex moves linearly
  /// to its place in `organ`. Null: the organ rests. Static and paper modes ignore it.
  const TriangleMesh* organ_before = nullptr;
  /// An earlier shape, with the same faces. The velocities in the answer are those of the motion
  /// from it to `organ`, which may be longer or shorter than the step. Null: the tissue rests.
  const TriangleMesh* velocity_from = nullptr;
  double velocity_sec = 0.0;  ///< [s] the time from `velocity_from` to `organ`
  /// How the tool moved. Static modes look only at the last waypoint.
  ToolPath path;
  /// [m] The radius of the shaft: the tool touches every face that comes within this distance of
  /// its axis. 0: the tool has no shaft, only links.
  double radius = 0.0;
  /// The tool's links; every waypoint of `path` has a pose for each. Null: none. Paper modes ignore
  /// links.
  const std::vector<Link>* links = nullptr;
  /// What is asked: static, swept or one of the paper's modes.
  QueryMode mode = QueryMode::kStatic;
  /// Asks for the region of each contact: the part of its face in the viewing volume of the tool,
  /// in paper modes in the paper's volume.
  bool regions = false;

  /// [m] Asks for the clearance up to this distance. 0: not asked for.
  double margin = 0.0;
  /// Asks for the clearance without a limit.
  bool clearance = false;
  /// Asks for ToolClearance::closing_speed: an earlier pose of the tool.
  std::optional<ToolPose> pose_before;
  double pose_before_sec = 0.0;  ///< [s] the time from `pose_before` to the end of the step
  /// Asks for at most this many faces that are within the margin and not touched. 0: none.
  std::size_t max_near = 0;

  /// Asks on which side of the surface the tool is, and where its axis pierces the surface.
  bool placement = false;
  /// How the faces of `organ` join. Make the topology once for each mesh, not for each shape. Null:
  /// the placement has crossings, but its sides are unknown.
  const SurfaceTopology* surface_topology = nullptr;
  /// The tip at the end of the step, of a tool that has a tip but no shaft. Only the placement uses
  /// it.
  std::optional<Eigen::Vector3d> tip;
};

/// The velocity [m/s] of a point of a face that goes straight from one shape to another with the
/// same faces within `seconds` > 0. `barycentric`: the point's coordinates in the face.
Eigen::Vector3d velocity_between(const TriangleMesh& from, const TriangleMesh& to, double seconds,
                                 std::uint32_t face, const Eigen::Vector3d& barycentric);

/// Whether a request asks how far the tool is from the organ.
inline bool asks_for_clearance(const CollisionRequest& request) {
  return request.clearance || request.margin > 0.0;
}

/// The depths of the part of a face that is inside a viewing volume of the paper, as in the hit
/// record of GL_SELECT. They are measured along the viewing direction, from the plane of the
/// trocar [m].
struct ViewRange {
  double min;  ///< the least depth
  double max;  ///< the greatest depth
};

/// The answer to a request.
struct CollisionResult {
  /// One contact for each face and link that touch, sorted by face, then link.
  std::vector<FaceContact> contacts;
  /// One region for each contact, in the order of `contacts`. No region if the request did not ask
  /// for regions. A single region may be an empty polygon.
  std::vector<Region> regions;
  /// In the paper's modes, one range for each contact, in the order of `contacts`: of a contact,
  /// only its face is set there. Empty in the other modes.
  std::vector<ViewRange> view_ranges;
  /// The number of contacts whose is_resolved is false; see FaceContact.
  std::size_t unresolved = 0;

  /// If asked for: the faces within the margin that the tool does not touch during the step,
  /// nearest first, at most CollisionRequest::max_near of them. Each face occurs once, with the
  /// link that comes nearest to it. The fields are those of a contact, at the time of the closest
  /// approach instead of the first touch. `depth` is minus the distance at that time.
  std::vector<FaceContact> near;
  /// Whether further faces within the margin are left out of `near`, because it has max_near faces.
  bool near_more = false;
  /// At most so many faces were not measured to the end, because the query reached its work limit.
  /// If it is above 0, nearer faces may be missing in `near`, and its distances are upper bounds.
  std::size_t near_unresolved = 0;
  /// With near faces: the nearest faces in different directions at the end of the step, touched
  /// ones too, sorted by link, then distance. `depth` is minus the distance. Each other face up to
  /// `around_up_to` is farther from a link than one of the link's faces here, in the same
  /// direction: beyond the plane at right angles to its normal, at 4/5 of its distance or more.
  std::vector<FaceContact> around;
  /// [m] The least distance plus 0.01, or the margin if that is less. It is lower where many fine
  /// faces are that near, because the work of a query is bounded, but at least the least distance.
  /// 0 without near faces. It may be 0 while the tool touches.
  double around_up_to = 0.0;
  /// How many faces had to be looked at one by one.
  PickCounts picked;
  /// If asked for: how far the tool is from the organ.
  ToolClearance clearance;
  /// If asked for: on which side of the surface the tool is.
  AxisPlacement placement;
};

/// Finds the faces of an organ that a tool touches. OpenGL picking finds the candidate faces. Exact
/// distances then decide which of them the tool touches. No face that the tool touches is missed
/// (see doc/theory/exactness.md). The modes of the 1999 paper are the exception: they return the
/// faces in the paper's volumes, and these volumes miss some faces.
///
/// This example prints the faces that a swept shaft touches (complete: test/install/consumer):
/// \code
///   const organ_collision::TriangleMesh organ(
///       {-0.05f, -0.05f, 0.1f, 0.05f, -0.05f, 0.1f, 0.05f, 0.05f, 0.1f}, {0, 1, 2});
///   organ_collision::CollisionRequest request;
///   request.organ = &organ;
///   request.radius = 0.005;
///   request.mode = organ_collision::QueryMode::kSwept;
///   // Each waypoint: the fraction of the step, then trocar and tip of the shaft's axis.
///   request.path = {{0.0, {{0.0, 0.0, 0.0}, {0.15, 0.01, 0.15}}},
///                   {1.0, {{0.0, 0.0, 0.0}, {-0.15, 0.01, 0.15}}}};
///
///   organ_collision::CollisionQuery query;
///   organ_collision::CollisionResult result;
///   query.evaluate(request, result);
///   for (const auto& contact : result.contacts) std::cout << contact.face << '\n';
/// \endcode
///
/// Threads: any thread may create, use and destroy a query, but only one thread at a time.
/// Different queries may run in different threads at the same time, on the same meshes and links,
/// as long as these do not change.
///
/// OpenGL: a query owns its context, which is current in the calling thread only while one of its
/// functions runs. If OpenGL fails, the query throws GlError, and the next call gets a new context.
/// Creating a query takes about 30 ms. A query keeps its memory between calls, and
/// a result that is used again keeps its own, so repeated calls rarely allocate.
class CollisionQuery {
 public:
  /// `settings` decide how candidates are picked and how fast the query is. They never change the
  /// contacts. Throws GlError if OpenGL picking does not work in this process.
  explicit CollisionQuery(const PickerSettings& settings = {});
  ~CollisionQuery();
  /// Leaves the other query without state: it may only be destroyed or assigned to.
  CollisionQuery(CollisionQuery&&) noexcept;
  /// Destroys this query's OpenGL context and takes over that of the other query.
  CollisionQuery& operator=(CollisionQuery&&) noexcept;

  /// Replaces `result` by the answer to `request`. After an exception `result` is empty: there is
  /// no answer, which is not the same as no contact.
  ///
  /// Throws GlError if OpenGL failed. Throws std::invalid_argument, naming the value and what is
  /// legal, for a request that has no answer:
  /// - the organ is missing, or organ_before or velocity_from has other faces;
  /// - the mode is not a value of QueryMode;
  /// - the radius is negative, not finite or above tolerance::kFarthest, or 0 without links;
  /// - a coordinate is not finite, or its magnitude is above tolerance::kFarthest;
  /// - the path is empty, or its fractions do not rise from 0 to 1;
  /// - a waypoint lacks the pose of a link, or has a pose whose linear part is not a rotation;
  /// - in a paper mode: the tool has no shaft, its trocar moves in a swept mode, or it is too short
  ///   or too thin for the paper's volumes;
  /// - the margin is negative or not finite; or near faces are asked for, but no margin is given;
  /// - pose_before lacks a link or is not finite, or the time since it or velocity_from is not > 0;
  /// - clearance, near faces or placement are asked for in a paper mode;
  /// - the placement's topology has another number of vertices than the organ, or the tip is not
  ///   finite.
  void evaluate(const CollisionRequest& request, CollisionResult& result);

  /// The GL_VERSION and the platform of the query's OpenGL context, or a text: there is none.
  const std::string& gl_version() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace organ_collision
