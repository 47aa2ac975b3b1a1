#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "volume_query.hpp"

namespace organ_collision::bench {

/// A way to find the faces of a deforming surface that meet a convex volume.
class Engine {
 public:
  virtual ~Engine() = default;

  /// The triangles, and the surface at rest as x y z x y z ... [m]: what may be prepared before the
  /// first shape comes. `organ` outlives the engine.
  virtual void set_topology(const OrganSurface& organ, const std::vector<float>& rest) = 0;
  /// A new shape, as a message brings it; `vertices` live on until the next.
  virtual void update(const SharedVertices& vertices) = 0;
  /// Replaces `faces` by those that meet the volume, by rising number.
  virtual void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) = 0;
};

/// GL_FEEDBACK behind cluster boxes: what the node does.
std::unique_ptr<Engine> make_ours();
/// GL_FEEDBACK behind outcodes of all vertices.
std::unique_ptr<Engine> make_ours_no_clusters();
/// GL_SELECT, a name and a glBegin for each face: what the paper does.
std::unique_ptr<Engine> make_select_paper();
/// FCL's AABB tree, refitted; the volume as a Convex.
std::unique_ptr<Engine> make_fcl();
/// Bullet's GImpact tree, refitted; box query and exact clip.
std::unique_ptr<Engine> make_bullet_gimpact();
/// Bullet's quantized tree, refitted; box query and exact clip.
std::unique_ptr<Engine> make_bullet_quantized();
/// Embree's tree, refitted; rtcCollide with the volume's box and exact clip.
std::unique_ptr<Engine> make_embree();
/// CGAL's AABB tree, rebuilt; box query and exact clip.
std::unique_ptr<Engine> make_cgal();
/// Outcodes of all vertices and faces; exact clip of what they leave.
std::unique_ptr<Engine> make_scan();

}  // namespace organ_collision::bench
