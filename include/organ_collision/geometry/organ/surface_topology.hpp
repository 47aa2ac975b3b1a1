#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "organ_collision/geometry/organ/face_clusters.hpp"

namespace organ_collision {

/// A vertex that counts as another vertex at the same place.
struct SeamVertex {
  std::uint32_t vertex;  ///< its own index
  std::uint32_t first;   ///< index of the first vertex at that place, as which it counts
};

/// How the faces of a mesh join. If the indices alone do not close the surface, vertices that are
/// at the same place when this object is made count as one vertex. They still do so when the mesh
/// deforms.
///
/// Any triangles are allowed: several components, cavities, degenerate faces and faces that occur
/// more than once.
class SurfaceTopology {
 public:
  /// `faces` refer to `vertices`: x y z x y z ... [m], finite.
  SurfaceTopology(const std::vector<FaceIndices>& faces, const std::vector<float>& vertices);

  /// Whether each edge occurs equally often in both directions. Only a closed surface has an inner
  /// side and a volume.
  bool is_closed() const { return open_edges_ == 0; }
  /// The number of edges that occur more often in one direction than in the other.
  std::size_t open_edge_count() const { return open_edges_; }

  /// For each vertex, the index of the vertex as which it counts: the first vertex at its place,
  /// which may be itself. If they are at different places in a deformed mesh, the place of the
  /// first one counts. A vertex that no face uses counts as itself.
  const std::vector<std::uint32_t>& welded() const { return welded_; }
  /// The face, with the vertices as which its corners count.
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

/// [m^3] The volume that a closed surface encloses. Negative if its faces point inward. Space that
/// is enclosed several times counts several times. 0 if the surface is not closed. `faces` are
/// those of `topology`, and `vertices` are their present positions [m].
double signed_volume(const SurfaceTopology& topology, const std::vector<FaceIndices>& faces,
                     const std::vector<float>& vertices);

}  // namespace organ_collision
