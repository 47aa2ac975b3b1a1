#pragma once

#include <cstddef>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "organ_collision/query/haptic_proxy.hpp"
#include "patch_finder.hpp"
#include "query/make_request.hpp"

namespace organ_collision {

/// The distances that a proxy keeps from tissue [m], measured from the surface of its tool. Each
/// organ and part of the tool has its own clearance. Motions count in scaled distances instead, in
/// which all of them are the least one, `rest`.
struct ProxyClearance {
  double rest;        ///< the least clearance: the proxy stops at this distance
  double most = 0.0;  ///< the largest clearance
  /// A moving proxy keeps this distance. It is smaller than `rest`, so that a motion along a curved
  /// surface need not follow each curve.
  double swept() const { return 0.6 * rest; }
  double least() const { return 0.5 * rest; }  ///< a proxy nearer than this is squeezed
  double told() const { return 2.0 * rest; }   ///< the answer tells of tissue up to this distance

  /// The scaled distance of a part with the clearance `own`. It is proportional to the distance up
  /// to `own`, and then rises as the distance does. As `rest` is at most `own`, no motion changes
  /// the scaled distance by more than the distance.
  double scaled(double distance, double own) const {
    return distance < own ? distance * (rest / own) : distance - (own - rest);
  }
  /// The inverse of scaled().
  double distance(double scaled, double own) const {
    return scaled < rest ? scaled * (own / rest) : scaled + (own - rest);
  }
};

/// How an organ moves in one tick. The caller owns the shapes.
struct OrganTick {
  const TriangleMesh* before = nullptr;  ///< null: the organ has no earlier shape to move from
  const TriangleMesh* now = nullptr;
  const SurfaceTopology* topology = nullptr;  ///< of `now`; null: inside and outside are unknown
  Eigen::Isometry3d T_before = Eigen::Isometry3d::Identity();  ///< T_organ_proxy at the start
  Eigen::Isometry3d T_now = Eigen::Isometry3d::Identity();     ///< T_organ_proxy at the end
  Side keep = Side::kOutside;                                  ///< as ProxyOrgan::keep
  bool is_new = true;  ///< it has not been checked yet whether the proxy is on the side to keep
  bool holds_more = false;  ///< it holds a part of the tool that it did not hold in the last tick
  std::vector<double> clearances = {};  ///< as ProxyOrgan::clearances; empty: the least clearance
  const ProxyOrgan* given = nullptr;    ///< has its `advance`; null: it is not late
  const ProxyOrgan* last = nullptr;     ///< the organ at the last tick; null: there was none

  bool is_moving() const {
    return (before && before != now) || T_before.matrix() != T_now.matrix();
  }
};

/// A contact in the proxy's frame. `organ` is the index of the touched organ in set_organs().
struct TissueContact {
  std::size_t organ = 0;
  FaceContact contact;
  /// [m] The distance along the normal from the tool to the face when the motion ends. The tool
  /// counts without its growth. If the growth is negative, a link's part counts as its middle line.
  double distance = 0.0;
  double clearance = 0.0;  ///< [m] as ProxyFace::clearance
  double scaled = 0.0;     ///< [m] the scaled distance; what the tissue came nearer does not count
  double spare() const { return distance - clearance; }  ///< [m] negative: the tool must give way
};

/// Finds which faces of all organs a tool touches. The tool may be grown by a distance [m]. It then
/// touches each face that comes within this distance of it. A negative growth makes the shaft
/// thinner, and replaces each part of a link by the middle line of its box. All poses, contacts and
/// crossings are in the proxy's frame.
class Tissue {
 public:
  /// `tool` must outlive this. Throws GlError.
  Tissue(const ProxyTool& tool, const PickerSettings& picker);

  /// [1] A tick begins no further search after so many tests of a face against a part of the tool.
  /// A test takes about 0.3 us, of a mesh longer.
  static constexpr std::size_t kMostTests = 50'000;
  /// Begins a tick, which may make so many tests.
  void start_tick(std::size_t tests = kMostTests) {
    tests_ = tests;
    tests_made_ = 0;
  }
  /// Whether the tests of this tick are used up.
  bool is_used_up() const { return tests_ == 0; }
  /// How many tests this tick has made.
  std::size_t tests_made() const { return tests_made_; }

  void set_clearance(const ProxyClearance& clearance) { clearance_ = clearance; }
  const ProxyClearance& clearance() const { return clearance_; }
  /// [m] The clearance of a part of the tool from an organ. 0: the organ does not hold the part.
  double clearance(const OrganTick& organ, std::int32_t link) const;
  double clearance(std::size_t organ, std::int32_t link) const {
    return clearance((*organs_)[organ], link);
  }

  /// The organs of this tick. `organs` must stay valid until the next call of set_organs().
  void set_organs(const std::vector<OrganTick>& organs) { organs_ = &organs; }

  enum class Organs { kRest, kMove };
  /// What the tool, grown by the scaled distance `growth` [m], touches on its way along the poses,
  /// or at a single pose. The organs rest in their shapes now, or move to these shapes while the
  /// tool moves from the first one of two poses to the second one.
  void touch(const std::vector<ToolPose>& way, double growth, std::vector<TissueContact>& contacts,
             Organs organs = Organs::kRest);

  /// The tissue near the tool at a pose, that with the least spare() first: of each locally convex
  /// patch only the nearest face. `limits`: for a part with the least clearance. The search goes as
  /// far beyond each larger clearance, and at least to the distance `reach` [m]. If there is a
  /// reach, the contacts become rows: none stands for tissue that will soon be nearer. The organs
  /// rest in their shapes now. Returns false if the tests of the tick were used up: nearer faces
  /// may then be missing.
  bool look(const ToolPose& pose, const PatchFinder::Limits& limits,
            std::vector<TissueContact>& contacts, double reach = 0.0);

  /// [m] No point of the tool moves farther than this on the straight way between two poses.
  double farthest_move(const ToolPose& from, const ToolPose& to) const;

  /// The places of the tool whose sides of an organ count: the axis of the shaft, and a point of
  /// each part of each link, as an axis without a length. Parts that the organ does not hold have
  /// none.
  std::vector<ShaftAxis> places_of(const ToolPose& pose, const OrganTick& organ) const;
  /// Whether one of these places is known to be on the side of the
  /// organ that the proxy must not be on, or crosses its surface.
  bool is_on_wrong_side(const ToolPose& pose, bool only_first = false);
  /// The side of an organ on which a place begins.
  Side side(const OrganTick& organ, const ShaftAxis& place) {
    return placement(organ, place, organ.topology).trocar;
  }

  /// Where an axis crosses the surfaces of organs (that hold the shaft, if there is one), from
  /// trocar to its tip. The crossings have no loads.
  std::vector<ProxyCrossing> cross(const ShaftAxis& axis);

  /// [m] The most negative growth. It makes the shaft as thin as its axis.
  double least_growth() const;

 private:
  AskedTool grow(const OrganTick& organ, double growth);
  void set_limits(const OrganTick& organ, const PatchFinder::Limits& limits, double reach);
  TissueContact& add(std::size_t organ, const FaceContact& found, double grown_by,
                     std::vector<TissueContact>& contacts) const;
  void count(std::size_t tests);
  const AxisPlacement& placement(const OrganTick& organ, const ShaftAxis& axis,
                                 const SurfaceTopology* topology);

  const ProxyTool& tool_;
  ProxyClearance clearance_{1e-4};
  std::vector<Link> grown_links_;
  std::vector<double> grown_by_;    ///< [m] the growth of the shaft and of each link
  std::vector<Link> middle_lines_;  ///< the links, each part replaced by its middle line
  const std::vector<OrganTick>* organs_ = nullptr;
  CollisionQuery query_;
  CollisionResult result_;
  PatchFinder patches_;
  std::vector<PatchFinder::Limits> limits_;  ///< of the shaft and the links
  std::size_t tests_ = kMostTests;           ///< that are left
  std::size_t tests_made_ = 0;
  std::vector<PatchFinder::Found> found_;
};

}  // namespace organ_collision
