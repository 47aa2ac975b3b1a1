#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "benchmark/scenes/organ_surface.hpp"
#include "benchmark/scenes/volume_query.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

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
/// The package's `select` picker, as in the paper: GL_SELECT, one name and one draw call for each
/// face.
std::unique_ptr<Engine> make_select_paper();
/// FCL's AABB tree, refitted; the volume is a Convex.
std::unique_ptr<Engine> make_fcl();
/// FCL's tree of oriented boxes (OBBRSS), refitted. It stands in for RAPID, the paper's peer, which
/// only rebuilds its tree.
std::unique_ptr<Engine> make_fcl_obb();
/// The same, rebuilt for each shape, as in the paper.
std::unique_ptr<Engine> make_fcl_obb_rebuilt();
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

/// Distances beyond this need not be told [m].
inline constexpr double kWhereLimit = 0.02;

/// What a locator told of a tool. A member is set only if the locator tells such things.
struct Location {
  std::optional<double>
      shaft_distance;                  ///< [m] from the shaft's surface; infinite: beyond the limit
  std::optional<double> tip_distance;  ///< [m] from the tip as a point; infinite: beyond the limit
  std::optional<bool> tip_inside;      ///< on which side of the surface the tip is
};

/// An engine that tells where a tool is, or a part of that, while the organ deforms.
class Locator {
 public:
  virtual ~Locator() = default;

  /// Prepares for the organ's triangles, before the first shape arrives. `organ` must outlive the
  /// locator.
  virtual void set_topology(const OrganSurface& organ) = 0;
  /// Takes a new shape, in the form in which a message delivers it. `vertices` must stay valid
  /// until the next update.
  virtual void update(const SharedVertices& vertices) = 0;
  /// Locates a shaft of this radius [m].
  virtual Location locate(const ShaftAxis& axis, double radius) = 0;
};

/// The package: static contacts, the clearance up to kWhereLimit, and the placement.
std::unique_ptr<Locator> make_our_locator();
/// The package: static contacts and the nearest 100 faces within kWhereLimit.
std::unique_ptr<Locator> make_our_near_locator();
/// FCL's AABB tree, refitted: the distance of a capsule.
std::unique_ptr<Locator> make_fcl_locator();
/// Embree's tree of triangles, refitted: a point query around the tip, up to kWhereLimit.
std::unique_ptr<Locator> make_embree_locator();
/// CGAL's Side_of_triangle_mesh, rebuilt: the side of the tip.
std::unique_ptr<Locator> make_cgal_locator();

}  // namespace organ_collision::bench
