#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// A vertex that counts as another one at the same place.
struct SeamVertex {
  std::uint32_t vertex;  ///< its index
  std::uint32_t first;   ///< the first vertex at that place
};

/// How the faces of a mesh join. If the surface is not closed by its indices alone, vertices that
/// are at the same place when this is made count as one vertex, and stay one when the mesh deforms.
///
/// Any triangles are allowed: several components, cavities, degenerate faces and faces that occur
/// more than once.
class SurfaceTopology {
 public:
  /// `faces` refer to `vertices`: x y z x y z ... [m], finite.
  SurfaceTopology(const std::vector<FaceIndices>& faces, const std::vector<float>& vertices);

  /// Whether each directed edge occurs as often as its opposite. Only a closed surface has an inner
  /// side and a volume.
  bool is_closed() const { return open_edges_ == 0; }
  /// The number of edges that occur more often in one direction than in the other.
  std::size_t open_edge_count() const { return open_edges_; }

  /// For each vertex, the first one of those that count as one: itself, if there is no other. Where
  /// a deformed mesh has them at different places, the first one counts. Vertices that no face uses
  /// are left out.
  const std::vector<std::uint32_t>& welded() const { return welded_; }
  /// The same face, between welded vertices.
  FaceIndices welded(const FaceIndices& face) const {
    return {welded_[face[0]], welded_[face[1]], welded_[face[2]]};
  }
  /// All vertices that count as another one, by rising index. Copies of a topology share the list.
  const std::shared_ptr<const std::vector<SeamVertex>>& seams() const { return seams_; }

 private:
  std::vector<std::uint32_t> welded_;
  std::shared_ptr<const std::vector<SeamVertex>> seams_;
  std::size_t open_edges_;
};

/// [m^3] The volume that a closed surface encloses. Negative if its faces point inward. Parts that
/// are enclosed several times count as often. 0 if the surface is not closed. `faces` are those of
/// `topology`, and `vertices` are their present positions [m].
double signed_volume(const SurfaceTopology& topology, const std::vector<FaceIndices>& faces,
                     const std::vector<float>& vertices);

}  // namespace organ_collision
