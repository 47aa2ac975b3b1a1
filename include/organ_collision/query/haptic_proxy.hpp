#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
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
#include "organ_collision/query/placement.hpp"

namespace organ_collision {

/// What a proxy does. The values are those of msg/ProxyState.msg.
enum class ProxyStatus : std::uint8_t {
  kNoAnswer = 0,  ///< there is no proxy
  kFree = 1,      ///< the proxy is where the hand is
  kTouching = 2,  ///< tissue holds the proxy back
  /// Tissue closes in from several sides. The proxy is nearer to tissue than half the clearance, at
  /// the place where the nearest tissue is as far away as possible.
  kSqueezed = 3,
  kPunctured = 4  ///< a needle has entered the tissue, and the place of its entry holds it
};

/// In which ways tissue can push the proxy away from the hand.
enum class ProxyFreedom : std::uint8_t {
  /// A shaft through a trocar. The tip is free in three directions. The proxy always has the trocar
  /// of the hand. Links turn with the shaft.
  kTrocar,
  /// A tool without a trocar: three translations and three rotations. The joints between its links
  /// always have the angles of the hand.
  kFree
};

/// The tool of the hand. The proxy has the same shape.
struct ProxyTool {
  double radius = 0.0;           ///< [m] radius of the shaft; 0: the tool has no shaft
  std::vector<Link> links = {};  ///< the links, in the order of ToolPose::links
  ProxyFreedom freedom = ProxyFreedom::kTrocar;  ///< how it can be pushed; kTrocar needs a shaft
};

/// How a proxy behaves. It is pure geometry: a force is a stiffness [N/m] times a length, so forces
/// are given as lengths here.
struct ProxySettings {
  /// [m] The proxy stops this far from tissue, unless ProxyOrgan::clearances says otherwise. Unless
  /// its state is kSqueezed or kPunctured, it is never nearer than half of this distance.
  double clearance = 1e-4;
  /// [m] If the tip, the centre or the trocar of the hand moves farther than this between two
  /// ticks, or a free tool turns by more than this divided by ProxyAnswer::size, the proxy is
  /// placed anew: it is forgotten and comes to the hand on the side that ProxyOrgan::keep names.
  double jump = 0.05;
  /// [m] The needle pierces the tissue if the tip of the hand is this far beyond the tip of the
  /// proxy, along the axis. It is the threshold of the force divided by the stiffness. Not set: the
  /// tool never pierces. Only for a shaft through a trocar.
  std::optional<double> puncture = {};
  /// [m] ProxyAnswer::contacts lists tissue up to this distance, and at least up to its clearance
  /// plus the least clearance of all, which is twice the clearance if there is only one. 0: no rows
  /// are looked for, which saves time; what holds the proxy is listed.
  double row_reach = 0.0;
  bool hand_rows = false;  ///< whether ProxyAnswer::hand_contacts is filled
  /// [m] A needle in tissue slides along its axis if the tip of the hand is this far from the tip
  /// of the proxy, along the axis. It is the friction divided by the stiffness.
  double friction = 0.0;
};

/// An organ at one tick.
struct ProxyOrgan {
  /// The organ is taken to move from the shape that had this name at the last tick to the present
  /// one. If the triangles differ, it is taken to be another organ.
  std::string name;
  /// The organ's shape, in the organ's frame. Required. The proxy keeps it until the next tick.
  std::shared_ptr<const TriangleMesh> shape;
  /// How the faces of the shape join. Used to tell on which side the proxy is, when it is placed
  /// anew, and once when the organ, its triangles or this member are new. Null: not known yet.
  const SurfaceTopology* topology = nullptr;
  /// The transform from the proxy's frame to the organ's frame.
  Eigen::Isometry3d T_organ_proxy = Eigen::Isometry3d::Identity();
  /// The side of the surface on which the whole proxy stays: kOutside, or kInside for a hollow
  /// organ, whose wall then holds the tool. kUnknown: the side on which the tool starts, that is
  /// the side of its trocar or else of its first link at the first tick and after a reset or a jump
  /// of the hand. A surface that is not closed has no sides: the proxy keeps the side on which it
  /// starts.
  Side keep = Side::kOutside;
  /// [m] The clearance that the shaft, and then each link, keeps from this organ. 0: the organ does
  /// not hold this part of the tool. Empty: ProxySettings::clearance, for all of them.
  std::vector<double> clearances = {};
  /// [m] How far tissue has come towards the tool, along the normal of a contact in the proxy's
  /// frame, since the shape was measured. The clearance at the contact grows by how much nearer its
  /// face then is, up to `most_advance`. It is also asked for the corners of faces, with any
  /// normal; face, vertices, barycentric, point and on_organ are then those of the corner. Only
  /// called within follow(). Null: the shape is not late.
  std::function<double(const FaceContact&)> advance = {};
  double most_advance = 0.0;  ///< [m] the most that `advance` counts
  /// [m/s] How fast tissue comes towards the tool, asked for in the same way. A row does not stand
  /// for faces that will be nearer within 0.1 s. Null: the tissue rests.
  std::function<double(const FaceContact&)> approach = {};
  double most_approach = 0.0;  ///< [m/s] the most that `approach` counts
};

/// A face near a proxy, and the load that it bears.
struct ProxyFace {
  std::size_t organ = 0;  ///< the place of the organ in the list given to follow()
  /// The nearest points of the proxy and a face, in the proxy's frame. `depth` is minus the
  /// distance, and `fraction` is 0. Of each locally convex patch, the nearest face is listed up to
  /// the distance of ProxySettings::row_reach, so the nearest face of all always is. If the proxy
  /// is still on its way, the nearest faces are listed. Nothing is listed for a needle in tissue.
  FaceContact contact;
  /// [m] The distance that is kept here now: the clearance of the organ and the link, and what the
  /// tissue has come nearer (ProxyOrgan::advance).
  double clearance = 0.0;
  /// [m] The force of the proxy on the tissue, divided by the stiffness. It acts at contact.point,
  /// along contact.normal. Not negative.
  double load = 0.0;
};

/// Where a needle goes through tissue.
struct ProxyCrossing {
  std::size_t organ = 0;   ///< the place of the organ in the list given to follow()
  std::uint32_t face = 0;  ///< the number of the face that was pierced
  /// The barycentric coordinates of the crossing in the face. They do not change after the entry.
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  /// The place of the crossing on the axis, in [0, 1] from trocar to tip.
  double shaft = 0.0;
  /// [m] The crossing at this tick, in the proxy's frame.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// [m] The force of the needle on the tissue, divided by the stiffness. It acts at `point`. The
  /// axis is a lever with its pivot at the trocar: across the axis, `shaft` times the load is minus
  /// the pull on the hand.
  Eigen::Vector3d load = Eigen::Vector3d::Zero();
};

/// The answer to one tick. Lengths are in metres, points and vectors in the proxy's frame.
struct ProxyAnswer {
  ProxyStatus state = ProxyStatus::kNoAnswer;  ///< what the proxy does
  /// Where the proxy is. It has the joint angles and the trocar of the hand, and the same order of
  /// links.
  ToolPose proxy;
  /// Whether the proxy was placed anew in this tick. The reasons are: it is the first tick, the
  /// hand jumped, tissue moved through the proxy, or new tissue came where the proxy was.
  bool is_placed_anew = false;
  /// Why the proxy was placed anew, or why there is no proxy, or that contacts may be missing
  /// because the work of a tick is bounded. Otherwise empty.
  std::string message;
  /// [m] The force on the hand divided by the stiffness: from `center` to the centre of the proxy.
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  /// [m^2] The torque on the hand about `center`, divided by the stiffness: the rotation vector
  /// from the hand to the proxy times the square of `size`. Zero for a tool through a trocar.
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();
  /// Where the pull acts on the hand: the tip of a tool through a trocar, the centre of a free one.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  /// [m] The radius of gyration of a free tool. A rotation by an angle counts as a translation by
  /// that angle times the size.
  double size = 0.0;
  /// The faces near the proxy, and their loads, the nearest first.
  std::vector<ProxyFace> contacts;
  /// If ProxySettings::hand_rows is set: the same for the hand as it is, without loads. Empty if
  /// the way from the proxy to the hand meets tissue.
  std::vector<ProxyFace> hand_contacts;
  /// Where a needle goes through tissue, from entry to tip. Empty unless the needle has pierced.
  std::vector<ProxyCrossing> crossings;
  /// How many faces were tested one by one against parts of the tool: the work of the tick.
  std::size_t tests = 0;
};

/// A virtual tool that follows the hand, but stops at tissue (a god-object: Zilles and Salisbury
/// 1995; Ruspini, Kolarov and Khatib 1997; with continuous motion Redon, Kheddar and Coquillart
/// 2002, Ortega, Redon and Coquillart 2007). A spring between hand and proxy gives the force. The
/// force holds even if a fast hand passes through thin tissue within one step. See doc/haptics.md.
///
/// At each tick, the hand has a new pose and the organs may have new shapes. The proxy moves only
/// along motions that touch nothing. Each motion is tested as a whole: the organ moves linearly
/// from shape to shape, the tool as ToolPath says. Of the places that it can reach, it seeks the
/// one nearest the hand (Gauss' principle of least constraint). The work of a tick is bounded, so
/// it may need several ticks to get there.
///
/// Threads and OpenGL: as for CollisionQuery.
class HapticProxy {
 public:
  /// Throws GlError if OpenGL picking does not work in this process, and std::invalid_argument,
  /// naming the value and what is legal, if the tool or a setting is illegal.
  HapticProxy(ProxyTool tool, const ProxySettings& settings, const PickerSettings& picker = {});
  ~HapticProxy();
  /// Leaves the other proxy without state: it may only be destroyed or assigned to.
  HapticProxy(HapticProxy&&) noexcept;
  /// Destroys this proxy's OpenGL context and takes over that of the other one.
  HapticProxy& operator=(HapticProxy&&) noexcept;

  /// Moves the proxy. `hand`: the hand's pose in the proxy's frame, with a pose for each link;
  /// `organs`: all organs, in any order, with different names. The answer is valid until the next
  /// call.
  ///
  /// Throws GlError if OpenGL failed, and std::invalid_argument if the hand or an organ is illegal
  /// as in CollisionQuery. The proxy and the organs that it knows then stay as they were.
  const ProxyAnswer& follow(const ToolPose& hand, const std::vector<ProxyOrgan>& organs);

  /// Forgets the proxy: the next tick places it anew.
  void reset();

  /// Changes the settings; the proxy keeps its place. Throws std::invalid_argument.
  void set_settings(const ProxySettings& settings);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace organ_collision
