#include "first_touch.hpp"
#include "organ_collision/geometry/tolerances.hpp"
#include "swept_box.hpp"

namespace organ_collision {
namespace {

/// Searches for the closest approach of one core and one face on one leg.
class ApproachSearch {
 public:
  ApproachSearch(const CoreMotion& core, const FaceMotion& face, double distance_bound,
                 WorkBudget& budget)
      : core_(core),
        face_(face),
        farthest_move_(core.farthest_move() + face.farthest_move()),
        least_(distance_bound),
        budget_(budget) {}

  std::optional<ClosestApproach> find() {
    if (farthest_move_ == 0.0) {
      consider(0.0, closest_points(core_.start(), face_.start, least_));
      return found_;
    }
    const Instant start(0.0, core_, face_, least_ + farthest_move_);
    if (start.closest.distance > least_ + farthest_move_) {
      budget_.spend(start.closest.steps);
      return std::nullopt;
    }
    consider(start);
    if (!found_ && FixedPlane(start.normal, core_).keeps_beyond(face_, limit())) {
      return std::nullopt;
    }
    const Instant end(1.0, core_, face_);
    consider(end);
    search(start, end, 0);
    return found_;
  }

 private:
  /// [m] Only smaller distances than this are still of interest.
  double limit() const { return least_ - tolerance::kApproach; }

  void consider(double time, const ClosestPoints& closest) {
    budget_.spend(closest.steps);
    if (closest.distance > least_) return;
    least_ = closest.distance;
    found_ = {time, closest};
  }
  void consider(const Instant& instant) { consider(instant.time, instant.closest); }

  /// Whether the distance certainly stays above the limit between two instants.
  bool stays_above_limit(const Instant& from, const Instant& to) const {
    const double move = farthest_move_ * (to.time - from.time);
    const bool is_too_slow = 0.5 * (from.closest.distance + to.closest.distance - move) > limit();
    return is_too_slow || clear_share(from, to, core_, limit()) > 1.0;
  }

  /// Looks for smaller distances between two instants. Begins with the half of the interval at
  /// whose end the distance is smaller, so that the limit falls soon.
  void search(const Instant& from, const Instant& to, int halvings) {
    constexpr int kMaxHalvings = 60;  // The bound by speed ends the search earlier.
    if (limit() <= 0.0 || halvings == kMaxHalvings) return;
    budget_.spend(1);
    if (stays_above_limit(from, to)) return;
    if (budget_.is_used_up()) return budget_.add_cut();
    const Instant middle(0.5 * (from.time + to.time), core_, face_);
    consider(middle);
    const bool begins_early = from.closest.distance < to.closest.distance;
    if (begins_early) search(from, middle, halvings + 1);
    search(middle, to, halvings + 1);
    if (!begins_early) search(from, middle, halvings + 1);
  }

  const CoreMotion& core_;
  const FaceMotion& face_;
  const double farthest_move_;
  double least_;  ///< [m] the smallest distance found so far, first the bound
  std::optional<ClosestApproach> found_;
  WorkBudget& budget_;
};

/// Searches for the closest approach of one face and the triangles of a surface, down its tree of
/// boxes.
class SurfaceSearch {
 public:
  SurfaceSearch(const ToolSurface& surface, const RigidMotion& motion, const FaceMotion& face,
                double distance_bound, WorkBudget& budget)
      : surface_(surface), motion_(motion), face_(face), least_(distance_bound), budget_(budget) {}

  std::optional<ClosestApproach> find() {
    visit(0, distance_bound(0));
    return found_;
  }

 private:
  /// [m] A lower bound of the distance between the face and the triangles below a node.
  double distance_bound(std::uint32_t node) const {
    budget_.spend(1);
    return SweptBox(surface_.nodes()[node].box, motion_, 0.0).distance_bound(face_);
  }

  void visit(std::uint32_t index, double distance_bound_of_node) {
    if (distance_bound_of_node > least_) return;
    if (budget_.is_used_up()) return budget_.add_cut();
    const ToolSurface::Node& node = surface_.nodes()[index];
    const bool is_leaf = node.second == 0;
    if (is_leaf) {
      for (std::uint32_t triangle = node.begin; triangle < node.end; ++triangle) measure(triangle);
      return;
    }
    const double first = distance_bound(index + 1), second = distance_bound(node.second);
    if (first <= second) visit(index + 1, first);
    visit(node.second, second);
    if (first > second) visit(index + 1, first);
  }

  void measure(std::uint32_t triangle) {
    const CoreMotion core(ConvexCore(surface_.triangle(triangle)), motion_);
    const auto approach = closest_approach(core, face_, least_, budget_);
    if (!approach) return;
    least_ = approach->closest.distance;
    found_ = approach;
  }

  const ToolSurface& surface_;
  const RigidMotion& motion_;
  const FaceMotion& face_;
  double least_;  ///< [m] the smallest distance found so far, first the bound
  std::optional<ClosestApproach> found_;
  WorkBudget& budget_;
};

}  // namespace

std::optional<ClosestApproach> closest_approach(const CoreMotion& core, const FaceMotion& face,
                                                double distance_bound, WorkBudget& budget) {
  return ApproachSearch(core, face, distance_bound, budget).find();
}

std::optional<ClosestApproach> closest_approach(const ToolSurface& surface,
                                                const RigidMotion& motion, const FaceMotion& face,
                                                double distance_bound, WorkBudget& budget) {
  return SurfaceSearch(surface, motion, face, distance_bound, budget).find();
}

}  // namespace organ_collision
