#include "grasp.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

double cosine(double degrees) { return std::cos(degrees * std::acos(-1.0) / 180.0); }

/// Whether contacts with these normals and the vector `d` between them [m] oppose each other.
bool oppose(const Vector3d& first, const Vector3d& second, const Vector3d& d, double least_cosine) {
  const double length = d.norm();
  if (length < kSamePlace) return first.dot(second) <= -least_cosine;
  return first.dot(d) >= least_cosine * length && -second.dot(d) >= least_cosine * length;
}

/// The contacts of the second jaw, in boxes within boxes. If each jaw has some 500 contacts, a
/// comparison of all pairs takes as long as the query that found them, and the tree a tenth of
/// that.
class ContactTree {
 public:
  explicit ContactTree(const std::vector<JawContact>& contacts)
      : contacts_(contacts), order_(contacts.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    if (!contacts.empty()) add_node(0, order_.size());
  }

  /// Replaces `best` by a pair of the contact `from`, whose index is `index`, if there is a better
  /// one. The pairs with the indices before must have been tried.
  void improve(const JawContact& from, std::size_t index, double least_cosine,
               OpposingPair& best) const {
    for (std::size_t i = 0; i < nodes_.size();) {
      const Node& node = nodes_[i];
      if (!may_improve(node, from, least_cosine, best.distance)) {
        i = node.next;
        continue;
      }
      const std::size_t end = node.is_leaf ? node.end : node.begin;
      for (std::size_t k = node.begin; k < end; ++k) {
        const JawContact& to = contacts_[order_[k]];
        const Vector3d d = to.on_organ - from.on_organ;
        const OpposingPair pair{index, order_[k], d.norm()};
        const bool is_better = std::tie(pair.distance, pair.first, pair.second) <
                               std::tie(best.distance, best.first, best.second);
        if (is_better && oppose(from.normal, to.normal, d, least_cosine)) best = pair;
      }
      ++i;
    }
  }

 private:
  static constexpr std::size_t kLeafSize = 8;

  /// The nodes below a node follow it, up to the node with the index `next`.
  struct Node {
    Eigen::AlignedBox3d box;
    std::size_t begin, end;  ///< its places in `order_`
    std::size_t next = 0;
    bool is_leaf = true;
  };

  void add_node(std::size_t begin, std::size_t end) {
    Eigen::AlignedBox3d box;
    for (std::size_t k = begin; k < end; ++k) box.extend(contacts_[order_[k]].on_organ);
    const std::size_t index = nodes_.size();
    nodes_.push_back({box, begin, end});
    if (end - begin > kLeafSize) {
      nodes_[index].is_leaf = false;
      const std::size_t middle = (begin + end) / 2;
      Eigen::Index axis = 0;
      box.sizes().maxCoeff(&axis);
      const auto at = [&](std::size_t place) { return order_.begin() + static_cast<long>(place); };
      std::nth_element(at(begin), at(middle), at(end), [&](std::size_t a, std::size_t b) {
        return contacts_[a].on_organ[axis] < contacts_[b].on_organ[axis];
      });
      add_node(begin, middle);
      add_node(middle, end);
    }
    nodes_[index].next = nodes_.size();
  }

  /// False if no contact in the box is nearer than `distance`, or all are outside the cone around
  /// the normal of `from`. The slack is for rounding.
  static bool may_improve(const Node& node, const JawContact& from, double least_cosine,
                          double distance) {
    const double slack = 1e-9 * (1.0 + from.on_organ.cwiseAbs().maxCoeff());
    const double nearest = node.box.exteriorDistance(from.on_organ) - slack;
    if (nearest > distance) return false;
    const Vector3d middle = node.box.center() - from.on_organ;
    const double along =
        from.normal.dot(middle) + 0.5 * from.normal.cwiseAbs().dot(node.box.sizes()) + slack;
    return nearest < kSamePlace || along >= least_cosine * nearest;
  }

  const std::vector<JawContact>& contacts_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace

std::optional<OpposingPair> grasped_pair(const std::vector<JawContact>& first,
                                         const std::vector<JawContact>& second, bool grasped) {
  static const double kGrasp = cosine(kGraspAngleDeg), kRelease = cosine(kReleaseAngleDeg);
  if (first.empty() || second.empty()) return std::nullopt;
  OpposingPair best{0, 0, std::numeric_limits<double>::infinity()};
  const ContactTree tree(second);
  for (std::size_t i = 0; i < first.size(); ++i) {
    tree.improve(first[i], i, grasped ? kRelease : kGrasp, best);
  }
  return std::isfinite(best.distance) ? std::optional(best) : std::nullopt;
}

}  // namespace organ_collision
