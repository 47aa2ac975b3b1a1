#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "least_constraint.hpp"
#include "mobility.hpp"
#include "tissue.hpp"

namespace organ_collision {

/// The shape at a time in [0, 1] between two shapes with the same faces. Vertices move linearly.
std::unique_ptr<const TriangleMesh> shape_between(const TriangleMesh& before,
                                                  const TriangleMesh& now, double time);

/// Where a proxy is, and how far it is from tissue there.
struct ProxyPlace {
  ToolPose pose;
  /// [m] The proxy is at least this scaled distance from every face. Negative infinity: it is
  /// unknown.
  double clearance = -std::numeric_limits<double>::infinity();
};

/// Moves a proxy. A swept collision query checks each motion, and the proxy moves only as far as it
/// touches nothing. Each function makes a bounded number of queries. After Tissue::kMostTests, a
/// proxy stays where it is proven to be free.
class ProxyMotion {
 public:
  /// `mobility` and `tissue` must outlive this object.
  ProxyMotion(const Mobility& mobility, Tissue& tissue) : mobility_(mobility), tissue_(tissue) {}

  void set_clearance(const ProxyClearance& clearance) {
    clearance_ = clearance;
    tissue_.set_clearance(clearance);
  }

  /// The place where a proxy starts when it is placed anew. From there it moves to the hand like
  /// any proxy. A tool through a trocar starts with its tip at the trocar. A free tool starts where
  /// the hand is. If it touches tissue there or is on the wrong side of an organ, it starts beyond
  /// all organs, on the hand's side, or inside the organ that it must not leave. If there is no
  /// place on the right side of all organs, the result is empty, and `why_not` says why.
  std::optional<ProxyPlace> enter(ProxyFreedom freedom, const ToolPose& hand,
                                  const std::vector<OrganTick>& organs, std::string& why_not);

  /// Moves the proxy while the organs move from their last shapes to their present ones, and its
  /// joints and its trocar move to those of the hand. The proxy gives way to tissue as little as
  /// possible. Returns nothing if tissue would pass through the proxy in each motion that it tries.
  std::optional<ProxyPlace> give_way(const ProxyPlace& start, const ToolPose& hand,
                                     const std::vector<OrganTick>& organs);

  /// The proxy moves straight to the hand, until it meets tissue. Returns whether it arrived.
  bool fly(ProxyPlace& place, const ToolPose& hand);

  /// The proxy slides along the tissue to the place nearest the hand. `reach` [m]: about how far
  /// away this place may be. The joints and the trocar of `place` must be those of `hand`.
  void slide(ProxyPlace& place, const ToolPose& hand, double reach);

  /// The tissue near the proxy after slide(), or after fly() has reached the hand, that with the
  /// least spare() first: of each locally convex patch the nearest face, if it is within at least
  /// twice the clearance at rest, as a scaled distance.
  const std::vector<TissueContact>& contacts() const { return contacts_; }
  /// The walls that belong to contacts(), in the same order.
  const std::vector<Wall>& walls() const { return walls_; }

 private:
  enum class Level { kSwept, kLeast };

  std::optional<ProxyPlace> give_way(const ProxyPlace& start, const ToolPose& hand,
                                     const std::vector<OrganTick>& organs, Level level, int pieces);
  std::optional<ProxyPlace> give_way(const ProxyPlace& start, const ToolPose& hand, Level level);
  std::optional<ProxyPlace> first_free(const std::vector<ToolPose>& poses);
  std::vector<ToolPose> starts(const ToolPose& hand, const std::vector<OrganTick>& organs) const;
  bool fly(ProxyPlace& place, const ToolPose& hand, double growth);
  double share_of_give_way(const ToolPose& given) const;
  bool look_around(ProxyPlace& place, double distance);
  void stay_at(ProxyPlace& place, const ProxyPlace& start);
  bool is_clear(const ProxyPlace& from, const ProxyPlace& to, double growth) const;
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
  std::vector<TissueContact> met_;  ///< what the last motion touched
  std::vector<ToolPose> way_, straight_;
};

}  // namespace organ_collision
