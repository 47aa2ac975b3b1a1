#include "contact_motion.hpp"

#include <algorithm>
#include <cmath>

#include "ros/interface/conversions.hpp"
#include "shaft_radius.hpp"

namespace organ_collision {
namespace {

/// [1] Cosine of the largest angle by which the normal of a pierced face turns in a step. If the
/// normal turned more, one of the two contacts is from before the axis pierced the face, and their
/// depths cannot be compared.
constexpr double kSame = 0.999;

}  // namespace

ContactMotion::Place ContactMotion::place_of(const Contact& contact, const Push& push,
                                             const KeptSides::Radius& radius) {
  Place place{contact.depth, std::nullopt, std::nullopt};
  if (!radius) return place;
  const Eigen::Vector3d normal = to_eigen(contact.normal);
  place.depth = std::min(contact.depth, *radius);
  place.offset = (*radius - place.depth) * normal;
  if (contact.depth >= *radius && push.counts)
    place.pierced = Pierced{normal, contact.depth, push.depth};
  return place;
}

double ContactMotion::path_length_between(const Place& before, const Place& now) {
  if (!before.offset || !now.offset) return std::abs(now.depth - before.depth);
  if (before.pierced && now.pierced && before.pierced->normal.dot(now.pierced->normal) > kSame) {
    return std::min(std::abs(now.pierced->depth - before.pierced->depth),
                    std::abs(now.pierced->push - before.pierced->push));
  }
  const Eigen::Vector3d change = *now.offset - *before.offset;
  const double nearer = now.depth - before.depth;
  const double farther = change.dot(before.offset->normalized());
  return std::max({0.5 * change.norm(), nearer, farther});
}

std::optional<double> ContactMotion::follow(const ContactArray& answer,
                                            const std::vector<Push>& pushes,
                                            const KeptSides::Radius& shaft_radius) {
  if (answer.mode == ContactArray::STATIC || answer.topology != topology_) last_.reset();
  topology_ = answer.topology;

  double way = 0.0;
  Places places;
  for (std::size_t i = 0; i < answer.contacts.size(); ++i) {
    const Contact& contact = answer.contacts[i];
    const Place now = place_of(contact, pushes[i], radius_at(contact, answer, shaft_radius));
    places.insert({{contact.face, contact.link}, now});
    if (!last_) continue;
    const auto before = last_->find({contact.face, contact.link});
    if (before == last_->end()) {
      // If the face was not touched when the step began, its whole depth arose in this step.
      way = std::max(way, contact.fraction > 0.0 ? contact.depth : now.depth);
    } else {
      way = std::max(way, path_length_between(before->second, now));
      last_->erase(before);
    }
  }
  const bool follows = last_.has_value();
  if (follows) {
    for (const auto& left : *last_) way = std::max(way, left.second.depth);
  }
  last_ = std::move(places);
  return follows ? std::optional<double>(way) : std::nullopt;
}

}  // namespace organ_collision
