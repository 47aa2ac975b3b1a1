#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/link.hpp"
#include "organ_collision/geometry/tool/tool_path.hpp"
#include "organ_collision/picking/picker_kind.hpp"
#include "organ_collision/picking/region.hpp"
#include "organ_collision/query/contact.hpp"

namespace organ_collision {

/// Values as in msg/ContactArray.msg.
enum class QueryMode : std::uint8_t {
  kStatic = 0,       ///< what the tool touches at the end of its path
  kSwept = 1,        ///< what it touches anywhere on its path
  kPaperStatic = 2,  ///< the faces in the 1999 paper's own volumes, unrefined
  kPaperSwept = 3,
  kPaperNaive = 4
};

/// What a tool did in one step, and which organ it may have touched.
struct CollisionRequest {
  const TriangleMesh* organ = nullptr;  ///< the organ's shape at the end of the step
  const TriangleMesh* organ_before =
      nullptr;          ///< at its start, with the same faces; null: it rests
  ToolPath path;        ///< in the organ's frame; static modes look at the last waypoint only
  double radius = 0.0;  ///< [m] of the shaft; 0: the tool has links alone
  const std::vector<Link>* links = nullptr;  ///< each with its pose in every waypoint; null: none
  QueryMode mode = QueryMode::kStatic;
  bool regions = false;  ///< also clip each contact's face to the tool's viewing volume
};

struct CollisionResult {
  std::vector<FaceContact> contacts;  ///< by rising face, then link; one for each
  std::vector<Region> regions;        ///< empty unless asked for; else one for each contact
  std::size_t unresolved = 0;         ///< of the contacts, as in msg/ContactArray.msg
};

/// Finds the faces that a tool touches: picked by GL, confirmed by exact distances.
/// Owns its GL context, which is current in the calling thread only while a function runs: any
/// thread may make, use and destroy it, one at a time. Keeps its buffers between queries.
class CollisionQuery {
 public:
  /// Throws GlError where GL picking does not work here.
  explicit CollisionQuery(PickerKind kind = PickerKind::kFeedback);
  ~CollisionQuery();
  CollisionQuery(CollisionQuery&&) noexcept;
  CollisionQuery& operator=(CollisionQuery&&) noexcept;

  /// Throws std::invalid_argument naming the value for a request that has no answer (radius not
  /// positive where there are no links, coordinates not finite, links without pose or with one that
  /// is no rotation, path empty or with fractions that do not rise from 0 to 1,
  /// earlier shape of other faces, paper volume of a tool that is too short or too thin), GlError
  /// when the picker failed. `result` is empty after either.
  void evaluate(const CollisionRequest& request, CollisionResult& result);

  /// GL_VERSION of its context.
  const std::string& gl_version() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace organ_collision
