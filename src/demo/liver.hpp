#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"
#include "organ_collision/geometry/tool/shaft.hpp"

class btSoftBody;
struct btSoftBodyWorldInfo;

namespace organ_collision {

/// A closed surface whose faces are oriented outwards. Positions in metres.
struct ClosedSurface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<FaceIndices> faces;

  Triangle triangle(std::size_t face) const {
    const FaceIndices& f = faces[face];
    return {vertices[f[0]], vertices[f[1]], vertices[f[2]]};
  }
};

/// [m] Approximate signed distance to the surface of the liver, negative inside.
/// x points to the patient's left, y to the head, z to the front. The right lobe is the larger one.
double liver_level(const Eigen::Vector3d& point);

/// The liver's surface at rest: 614 vertices, 1224 faces, 0.2 m from lobe to lobe. It begins as the
/// surface of a box of 19 x 10 x 4 cells, with 2 triangles for each square. The vertices are moved
/// onto liver_level = 0 and spread evenly there.
ClosedSurface make_liver_surface();

/// What is left of a surface, and for each of its vertices the number of one that moves alike.
struct CutSurface {
  ClosedSurface surface;
  std::vector<std::uint32_t> origins;
};

/// Takes away the faces beyond a plane: on its positive side. Vertices beyond it that other faces
/// have as well are moved onto it, and a fan of new faces closes the hole, which must be a single
/// and star-shaped one.
CutSurface cut_off(const ClosedSurface& whole, const Eigen::Hyperplane<double, 3>& plane);

/// How far a push moves a vertex.
struct VertexPush {
  std::uint32_t vertex;
  Eigen::Vector3d displacement;  ///< [m]
};

/// A liver of soft tissue, simulated as a soft body of Bullet. It keeps its volume and returns to
/// its shape. The ligaments at its back move it with the breath.
class LiverSoftBody {
 public:
  /// The liver at rest, exhaled.
  explicit LiverSoftBody(ClosedSurface surface);
  ~LiverSoftBody();

  /// Its surface at rest.
  const ClosedSurface& surface() const { return surface_; }

  /// Cuts off what is beyond a plane through the liver at rest. The rest moves on.
  void cut(const Eigen::Hyperplane<double, 3>& plane);

  /// Applies the pushes, then simulates `seconds` (> 0). A vertex that several pushes move is
  /// displaced by their mean.
  void step(double seconds, const std::vector<VertexPush>& pushes);

  /// The vertices x y z x y z ... [m], in the order of the surface.
  std::vector<float> vertices() const;

 private:
  void give_way(const std::vector<VertexPush>& pushes);
  void breathe();

  struct Ligament {
    int node;
    Eigen::Vector3d rest;  ///< [m]
  };
  ClosedSurface surface_;  ///< at rest
  std::unique_ptr<btSoftBodyWorldInfo> world_;
  std::unique_ptr<btSoftBody> body_;
  std::vector<Ligament> ligaments_;
  double time_ = 0.0;  ///< [s]
};

/// A laparoscopic instrument with a scripted motion through a fixed trocar, in the liver's frame.
struct ScriptedTool {
  std::string name;
  Eigen::Vector3d trocar;                  ///< [m]
  Eigen::Vector3d (*tip)(double seconds);  ///< [m] at a time since the start

  ShaftAxis at(double seconds) const { return {trocar, tip(seconds)}; }
};

/// [m] Radius of both tools.
inline constexpr double kToolRadius = 0.005;

/// [s] At each full second, the stabber passes through the left lobe in this time.
inline constexpr double kStabDuration = 0.005;

/// A hand holds this tool. It moves the tool slowly over the front of the right lobe, and presses
/// it into the lobe and lifts it in turn.
extern const ScriptedTool kPalpator;
/// This tool stabs through the left lobe, and rests in front of it and behind it in turn.
extern const ScriptedTool kStabber;

}  // namespace organ_collision
