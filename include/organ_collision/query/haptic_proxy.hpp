#pragma once

#include <Eigen/Geometry>
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
#include "organ_collision/query/contact.hpp"

namespace organ_collision {

/// What a proxy does. The values are those of msg/ProxyState.msg.
enum class ProxyStatus : std::uint8_t {
  kNoAnswer = 0,  ///< there is no proxy
  kFree = 1,      ///< the proxy is where the hand is
  kTouching = 2,  ///< tissue holds the proxy back
  /// Tissue closes in from several sides. The proxy is nearer to it than half the clearance, at the
  /// place where the nearest tissue is as far away as possible.
  kSqueezed = 3,
  kPunctured = 4  ///< a needle has entered the tissue, and the place of its entry holds it
};

/// In which ways tissue can push the proxy away from the hand.
enum class ProxyFreedom : std::uint8_t {
  /// A shaft through a trocar. The tip is free in three directions. The trocar is that of the hand.
  /// Links turn with the shaft.
  kTrocar,
  /// A free tool: three translations and three rotations. The joints between its links are those of
  /// the hand.
  kFree
};

/// The tool that a proxy stands for.
struct ProxyTool {
  double radius = 0.0;                           ///< [m] of the shaft; 0: the tool has no shaft
  std::vector<Link> links = {};                  ///< in the order of ToolPose::links
  ProxyFreedom freedom = ProxyFreedom::kTrocar;  ///< kTrocar needs a shaft
};

/// How a proxy behaves. It is pure geometry: a force is a stiffness [N/m] times a length, so forces
/// are given as lengths here.
struct ProxySettings {
  /// [m] The proxy stops this far from tissue. Unless it is SQUEEZED, it is never nearer than half
  /// of this.
  double clearance = 1e-4;
  /// [m] If the tip, the centre or the trocar of the hand moves farther than this between two
  /// ticks, or a free hand turns by more than this divided by its size, the proxy is placed anew.
  double jump = 0.05;
  /// [m] The needle pierces the tissue if the hand's tip is this far beyond the proxy's, along the
  /// axis: the threshold of the force divided by the stiffness. Not set: never. Only for a shaft
  /// through a trocar.
  std::optional<double> puncture = {};
  /// [m] Once it has pierced, the needle slides along its axis if the hand's tip is this far from
  /// the proxy's along the axis: the friction divided by the stiffness.
  double friction = 0.0;
};

/// An organ at one tick.
struct ProxyOrgan {
  /// Tells from which shape of the last tick the organ moved to this one. A shape with other
  /// triangles is another organ.
  std::string name;
  /// The organ's shape, in the organ's frame. Required. The proxy keeps it until the next tick.
  std::shared_ptr<const TriangleMesh> shape;
  /// How the faces of the shape join. Only for placing a free tool anew. Null: a free tool that
  /// touches nothing is taken to be outside.
  const SurfaceTopology* topology = nullptr;
  /// From the proxy's frame to the organ's.
  Eigen::Isometry3d T_organ_proxy = Eigen::Isometry3d::Identity();
};

/// A place where tissue holds a proxy.
struct ProxyContact {
  std::size_t organ = 0;  ///< its place in the list of organs
  /// The nearest points of the proxy and a face that is nearer than twice the clearance or, if the
  /// proxy is still on its way, among the nearest. None are listed for a free proxy that flew, or
  /// for a needle in tissue. In the proxy's frame. `depth` is minus the distance, `fraction` is 0.
  FaceContact contact;
  /// [m] The force of the proxy on the tissue, divided by the stiffness. It acts at contact.point,
  /// along contact.normal. Not negative.
  double load = 0.0;
};

/// Where a needle goes through tissue.
struct ProxyCrossing {
  std::size_t organ = 0;   ///< its place in the list of organs
  std::uint32_t face = 0;  ///< the number of the face that was pierced
  /// Of the place in the face; it stays the same.
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  /// The place on the axis, in [0, 1] from trocar to tip.
  double shaft = 0.0;
  /// [m] The place now, in the proxy's frame.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// [m] The force of the needle on the tissue, divided by the stiffness. It acts at `point`.
  /// Across the axis, `shaft` times the load is minus the pull on the hand: the axis is a lever.
  Eigen::Vector3d load = Eigen::Vector3d::Zero();
};

/// The answer to one tick. Lengths are in metres, points and vectors in the proxy's frame.
struct ProxyAnswer {
  ProxyStatus state = ProxyStatus::kNoAnswer;  ///< what the proxy does
  /// Where the proxy is. Its joints, its trocar and its links' order are those of the hand.
  ToolPose proxy;
  /// Whether the proxy was placed anew in this tick: the first one, the hand jumped, tissue moved
  /// through the proxy, or new tissue came where it was.
  bool is_placed_anew = false;
  /// Why, if it was; or why there is no proxy. A sentence.
  std::string message;
  /// [m] The force on the hand divided by the stiffness: from the hand's `center` to the proxy's.
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  /// [m^2] The torque on the hand about `center`, divided by the stiffness: the rotation vector
  /// from the hand to the proxy times the square of `size`. Zero for a tool through a trocar.
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();
  /// Where the pull acts on the hand: the tip of a tool through a trocar, the centre of a free one.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  /// [m] The radius of gyration of a free tool: how a rotation compares with a translation.
  double size = 0.0;
  /// Sorted by organ, then face, then link.
  std::vector<ProxyContact> contacts;
  /// From the entry to the tip; empty unless the needle has pierced.
  std::vector<ProxyCrossing> crossings;
};

/// A virtual tool that follows the hand, but stops at tissue (a god-object: Zilles and Salisbury
/// 1995; Ruspini, Kolarov and Khatib 1997; with continuous motion Redon, Kheddar and Coquillart
/// 2002, Ortega, Redon and Coquillart 2007). A spring between hand and proxy gives a force that
/// does not let go where a fast hand is through thin tissue after one step. See doc/haptics.md.
///
/// At each tick, the hand has a new pose and the organs may have new shapes. The proxy moves only
/// along motions that were swept and touched nothing: the organ moves linearly from shape to shape,
/// the tool as ToolPath says. Of the places that it can reach, it seeks the one nearest the hand
/// (Gauss' principle of least constraint). The work of a tick is bounded, so it may need several
/// ticks to get there.
///
/// Threads and OpenGL: as for CollisionQuery.
class HapticProxy {
 public:
  /// Throws GlError if OpenGL picking does not work in this process, and std::invalid_argument,
  /// naming the value and what is legal, if the tool or a setting is illegal.
  HapticProxy(ProxyTool tool, const ProxySettings& settings, const PickerSettings& picker = {});
  ~HapticProxy();
  /// A proxy from which another one was moved may only be destroyed or assigned to.
  HapticProxy(HapticProxy&&) noexcept;
  /// Destroys this proxy's OpenGL context and takes over that of the other one.
  HapticProxy& operator=(HapticProxy&&) noexcept;

  /// Moves the proxy. `hand`: the hand's pose in the proxy's frame, with a pose for each link;
  /// `organs`: all organs, in any order, with different names. The answer is valid until the next
  /// call.
  ///
  /// Throws GlError if OpenGL failed, and std::invalid_argument if the hand or an organ is illegal
  /// as in CollisionQuery. Then the proxy stays as it was, and so do the organs for it.
  const ProxyAnswer& follow(const ToolPose& hand, const std::vector<ProxyOrgan>& organs);

  /// Forgets the proxy: the next tick places it anew.
  void reset();

  /// Changes the settings. The proxy stays. Throws std::invalid_argument.
  void set_settings(const ProxySettings& settings);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace organ_collision
