#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "least_constraint.hpp"
#include "mobility.hpp"
#include "tissue.hpp"

namespace organ_collision {

/// A place of a proxy.
struct ProxyPlace {
  ToolPose pose;
  /// [m] No face is nearer than this, as far as is known. Negative infinity: nothing is known.
  double clearance = -std::numeric_limits<double>::infinity();
};

/// How near a proxy comes to tissue [m], beyond its own radius.
struct ProxyClearance {
  double rest;  ///< where it stops
  /// Motions keep this distance. It is smaller, so that a motion along a curved surface need not
  /// follow each curve.
  double swept() const { return 0.6 * rest; }
  double least() const { return 0.5 * rest; }  ///< a nearer proxy is squeezed
};

/// Moves a proxy, and only along motions that were swept and touched nothing. Each function does a
/// bounded number of queries.
class ProxyMotion {
 public:
  /// The references must outlive this.
  ProxyMotion(const Mobility& mobility, Tissue& tissue) : mobility_(mobility), tissue_(tissue) {}

  void set_clearance(double clearance) { clearance_ = {clearance}; }

  /// The organs move from their shapes before to those now, and what the hand prescribes moves to
  /// the hand's. The proxy gives way as little as possible. Nothing if tissue cannot but move
  /// through it.
  std::optional<ProxyPlace> give_way(const ProxyPlace& start, const ToolPose& hand,
                                     const std::vector<OrganTick>& organs);

  /// The proxy moves straight to the hand, until it meets tissue. Returns whether it arrived.
  bool fly(ProxyPlace& place, const ToolPose& hand) { return fly(place, hand, clearance_.rest); }

  /// The proxy slides along the tissue to the place nearest the hand. `reach` [m]: about how far
  /// that may be. The hand prescribes the same as before.
  void slide(ProxyPlace& place, const ToolPose& hand, double reach);

  /// What is near the proxy after slide(): all within at least twice the clearance at rest. Empty
  /// after fly() has reached the hand.
  const std::vector<TissueContact>& contacts() const { return contacts_; }
  /// The walls that the contacts are.
  const std::vector<Wall>& walls() const { return walls_; }

 private:
  enum class Level { kSwept, kLeast };

  std::optional<ProxyPlace> give_way(const ProxyPlace& start, const ToolPose& hand,
                                     const std::vector<OrganTick>& organs, Level level, int pieces);
  std::optional<ProxyPlace> give_way(const ProxyPlace& start, const ToolPose& hand, Level level);
  bool fly(ProxyPlace& place, const ToolPose& hand, double growth);
  double share_of_give_way(const ToolPose& given) const;
  void look_around(ProxyPlace& place, double reach);
  void add_walls(const ToolPose& given, const ToolPose& pose,
                 const std::vector<TissueContact>& contacts);
  double growth_from(double clearance) const;
  std::optional<double> first_touch(double growth) const;

  const Mobility& mobility_;
  Tissue& tissue_;
  ProxyClearance clearance_{1e-4};
  LeastConstraint solver_;
  std::vector<TissueContact> contacts_;
  std::vector<Wall> walls_;
  std::vector<TissueContact> met_;  ///< on the last motion
  std::vector<ToolPose> way_, straight_;
};

/// Where a proxy comes from when it is placed anew. From there it moves to the hand like any proxy.
struct ProxyEntry {
  std::optional<ProxyPlace> place;
  std::string why_not;  ///< a sentence if there is no place
};

/// A tool through a trocar enters along its axis: it begins with its tip at the trocar. A free tool
/// begins where the hand is or, if it touches tissue there or is inside an organ, beyond all
/// organs, on the hand's side.
ProxyEntry enter(const ProxyTool& tool, const Mobility& mobility, const ToolPose& hand,
                 double clearance, const std::vector<OrganTick>& organs, Tissue& tissue);

}  // namespace organ_collision
