#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "benchmark/scenes/volume_query.hpp"

namespace organ_collision::bench {

/// A collision engine: finds the faces of a deforming surface that meet a convex volume.
class Engine {
 public:
  virtual ~Engine() = default;

  /// Prepares for the organ's triangles, before the first shape arrives. `rest`: its vertices at
  /// rest, x y z x y z ... [m]. `organ` must outlive the engine.
  virtual void set_topology(const OrganSurface& organ, const std::vector<float>& rest) = 0;
  /// Takes a new shape, in the form in which a message delivers it. `vertices` must stay valid
  /// until the next update.
  virtual void update(const SharedVertices& vertices) = 0;
  /// Replaces `faces` by the sorted numbers of the faces that meet the volume.
  virtual void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) = 0;
};

/// The package's `feedback` picker, which the node uses: cluster boxes, outcodes, GL_FEEDBACK.
std::unique_ptr<Engine> make_ours();
/// The same on EGL, where OSMesa is missing.
std::unique_ptr<Engine> make_ours_egl();
/// The package's `cpu` picker: cluster boxes, outcodes, clipping in double precision, no OpenGL.
std::unique_ptr<Engine> make_cpu();
/// GL_FEEDBACK without clusters: outcodes of all vertices choose the faces that are drawn.
std::unique_ptr<Engine> make_ours_no_clusters();
/// The package's `select` picker, as in the paper: GL_SELECT, one name and one glBegin for each
/// face.
std::unique_ptr<Engine> make_select_paper();
/// FCL's AABB tree, refitted; the volume is a Convex.
std::unique_ptr<Engine> make_fcl();
/// Bullet's GImpact tree, refitted; box query and exact clip.
std::unique_ptr<Engine> make_bullet_gimpact();
/// Bullet's quantized tree, refitted; box query and exact clip.
std::unique_ptr<Engine> make_bullet_quantized();
/// Embree's tree, refitted; rtcCollide with the volume's box and exact clip.
std::unique_ptr<Engine> make_embree();
/// CGAL's AABB tree, rebuilt; box query and exact clip.
std::unique_ptr<Engine> make_cgal();
/// No tree: outcodes of all vertices, then an exact clip of the faces that they do not reject.
std::unique_ptr<Engine> make_scan();

}  // namespace organ_collision::bench
