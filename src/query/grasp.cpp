#include "grasp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// [m] Contacts that are nearer than this have no line between them: only their normals count.
constexpr double kSamePlace = 1e-6;
/// [1] Squares of equal lengths differ by less.
constexpr double kRounding = 1.0 + 1e-12;
/// How far jaws that hold may open until they let go.
constexpr double kLeastOpening = 1e-3, kMostOpening = 2.0;  // [m], [thickness]
/// From which growth of the distance on the jaws count as opened when tissue is let go.
constexpr double kOpenedBy = 2e-4, kOpenedTimes = 1.05;  // [m], [1]

double cosine(double degrees) { return std::cos(degrees * std::acos(-1.0) / 180.0); }

/// Whether the contacts are on opposite sides of one face, which both jaws touch.
bool are_on_one_face(const JawContact& first, const JawContact& second) {
  return first.face == second.face && first.normal.dot(second.normal) < 0.0;
}

/// Calls use(i, k) for each contact of the first jaw and each of the second on the same face. Both
/// are sorted by face.
template <typename Use>
void for_each_on_one_face(const std::vector<JawContact>& first,
                          const std::vector<JawContact>& second, const Use& use) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    while (begin < second.size() && second[begin].face < first[i].face) ++begin;
    for (std::size_t k = begin; k < second.size() && second[k].face == first[i].face; ++k)
      use(i, k);
  }
}

/// A contact of a jaw, and where it is along an axis.
struct Along {
  double place;  ///< [m]
  std::size_t number;
  Vector3d on_organ, normal;  ///< as in JawContact
};

/// Whether both normals point at the other contact. `d`: from the first contact to the second [m],
/// `squared` [m^2] the square of its length.
bool oppose(const Along& first, const Along& second, const Vector3d& d, double squared,
            double least_cosine) {
  if (squared < kSamePlace * kSamePlace) return first.normal.dot(second.normal) <= -least_cosine;
  const double along = std::min(first.normal.dot(d), -second.normal.dot(d));
  return along * std::abs(along) >= least_cosine * least_cosine * squared;
}

std::vector<Along> sort_along(const Vector3d& axis, const std::vector<JawContact>& contacts) {
  std::vector<Along> sorted;
  sorted.reserve(contacts.size());
  for (const JawContact& contact : contacts) {
    sorted.push_back({axis.dot(contact.on_organ), sorted.size(), contact.on_organ, contact.normal});
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const Along& a, const Along& b) { return a.place < b.place; });
  return sorted;
}

/// The unit vector from the first jaw's contacts to the second's; zero if they are at one place.
Vector3d axis_between(const std::vector<JawContact>& first, const std::vector<JawContact>& second) {
  const auto sum_of = [](const std::vector<JawContact>& contacts) {
    Vector3d sum(0.0, 0.0, 0.0);
    for (const JawContact& contact : contacts) sum += contact.on_organ;
    return sum;
  };
  return (sum_of(second) * static_cast<double>(first.size()) -
          sum_of(first) * static_cast<double>(second.size()))
      .normalized();
}

/// Where the contacts would be if their jaws had other poses [m].
std::vector<Vector3d> carried(const std::vector<JawContact>& contacts,
                              const std::vector<Isometry3d>& from,
                              const std::vector<Isometry3d>& to) {
  std::vector<Vector3d> places;
  for (const JawContact& contact : contacts) {
    places.push_back(to[contact.link] * (from[contact.link].inverse() * contact.on_organ));
  }
  return places;
}

}  // namespace

CarriedPair::CarriedPair(const JawsAnswer& answer, const OpposingPair& pair)
    : thickness_(pair.distance) {
  const JawContact& first = answer.contacts[0][pair.first];
  const JawContact& second = answer.contacts[1][pair.second];
  std::array<Vector3d, 2> places = {first.on_organ, second.on_organ};
  // The two places on one face count as one, which is in their middle.
  if (are_on_one_face(first, second)) places.fill(0.5 * (first.on_organ + second.on_organ));
  links_ = {first.link, second.link};
  for (std::size_t jaw = 0; jaw < 2; ++jaw) {
    in_link_[jaw] = answer.links[links_[jaw]].inverse() * places[jaw];
  }
}

double CarriedPair::distance(const std::vector<Isometry3d>& links) const {
  return (links[links_[1]] * in_link_[1] - links[links_[0]] * in_link_[0]).norm();
}

GraspMemory::Event GraspMemory::follow(const JawsAnswer& now, const GraspLimits& limits) {
  keep_widest(now, limits.hold);
  return held_ ? go_on(now, limits) : begin(now, limits);
}

/// Grasped: a pair opposes in two answers after each other, and does not oppose only because jaws
/// that have opened are still there.
GraspMemory::Event GraspMemory::begin(const JawsAnswer& now, const GraspLimits& limits) {
  pair_ = find_pair(now, limits.gap, false);
  const bool opposed = std::exchange(opposed_, pair_.has_value()) && now.same_triangles;
  if (!pair_) opened_.reset();
  const bool is_open = opened_ && !(opened_->distance(now.links) < 2.0 * opened_->thickness());
  if (!pair_ || !opposed || is_open) return Event::kNone;
  opened_.reset();
  const CarriedPair first(now, *pair_);
  held_ = Held{first, first, first.distance(now.links), {}};
  return Event::kGrasped;
}

/// Released: no pair has opposed for long enough, or the jaws have opened.
GraspMemory::Event GraspMemory::go_on(const JawsAnswer& now, const GraspLimits& limits) {
  pair_ = find_pair(now, limits.gap, true);
  if (pair_ && pair_->distance < held_->thinnest.thickness()) {
    held_->thinnest = CarriedPair(now, *pair_);
  }
  const double width = held_->first.distance(now.links);
  held_->narrowest = std::min(held_->narrowest, width);
  const bool is_lost = !pair_ && held_->without && now.stamp - *held_->without >= limits.hold;
  if (pair_) held_->without.reset();
  if (!pair_ && !held_->without) held_->without = now.stamp;
  const CarriedPair thinnest = held_->thinnest;
  const bool has_opened =
      thinnest.distance(now.links) > std::max(kMostOpening * thinnest.thickness(), kLeastOpening);
  if (!is_lost && !has_opened) return Event::kNone;
  const double least = held_->narrowest;
  const bool opens = width > least + kOpenedBy && width > kOpenedTimes * least;
  held_.reset();
  opposed_ = find_pair(now, limits.gap, false).has_value();
  if (has_opened && opposed_) opened_ = thinnest;
  return has_opened || opens ? Event::kOpened : Event::kSlipped;
}

/// Finds the widest pose since both jaws touch. A short break of touch does not begin it anew.
void GraspMemory::keep_widest(const JawsAnswer& now, std::chrono::nanoseconds hold) {
  const bool both_touch = !now.contacts[0].empty() && !now.contacts[1].empty();
  if (!both_touch && !apart_) apart_ = now.stamp;
  if (apart_ && now.stamp - *apart_ >= hold) widest_.reset();
  if (!both_touch) return;
  apart_.reset();
  const double width = (now.centers[1] - now.centers[0]).norm();
  if (!widest_ || width > widest_->width) widest_ = WidestPose{width, now.links};
}

/// `holds`: the jaws grasp already, so that they let go later than they would begin. So bumps of
/// the surface do not make a grasp begin and end again and again.
std::optional<OpposingPair> GraspMemory::find_pair(const JawsAnswer& now, double gap,
                                                   bool holds) const {
  const double least_cosine = cosine(holds ? 55.0 : 45.0), reach = holds ? 1.5 * gap : gap;
  const std::vector<JawContact>& first = now.contacts[0];
  const std::vector<JawContact>& second = now.contacts[1];
  std::vector<Vector3d> first_wide, second_wide;  // Where the contacts were in the widest pose.
  if (gap > 0.0 && widest_) {
    first_wide = carried(first, now.links, widest_->links);
    second_wide = carried(second, now.links, widest_->links);
  }
  OpposingPair best{0, 0, std::numeric_limits<double>::infinity()};
  const auto keep_nearer = [&](const OpposingPair& pair) {
    const auto rank = [](const OpposingPair& p) { return std::tie(p.distance, p.first, p.second); };
    if (rank(pair) < rank(best)) best = pair;
  };
  for_each_on_one_face(first, second, [&](std::size_t i, std::size_t k) {
    if (are_on_one_face(first[i], second[k])) keep_nearer({i, k, 0.0});
  });
  // Places that are farther apart along an axis than the best pair are not nearer than it. Between
  // the jaws, this leaves few of all pairs.
  const Vector3d axis = axis_between(first, second);
  const std::vector<Along> of_first = sort_along(-axis, first);
  const std::vector<Along> of_second = sort_along(axis, second);
  for (const Along& a : of_first) {
    for (const Along& b : of_second) {
      const double apart = b.place + a.place;
      if (apart > best.distance) break;
      const Vector3d d = b.on_organ - a.on_organ;
      const double squared = d.squaredNorm();
      if (squared > kRounding * best.distance * best.distance) continue;
      const auto closed_on_it = [&] {
        return !first_wide.empty() && squared <= reach * reach &&
               (second_wide[b.number] - first_wide[a.number]).squaredNorm() > 4.0 * gap * gap;
      };
      if (oppose(a, b, d, squared, least_cosine) || closed_on_it()) {
        keep_nearer({a.number, b.number, std::sqrt(squared)});
      }
    }
  }
  return std::isfinite(best.distance) ? std::optional(best) : std::nullopt;
}

}  // namespace organ_collision
