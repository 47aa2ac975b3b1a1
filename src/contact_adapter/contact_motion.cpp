#include "contact_motion.hpp"

#include <algorithm>
#include <cmath>

#include "ros/interface/conversions.hpp"
#include "shaft_radius.hpp"

namespace organ_collision {
namespace {

/// [1] Cosine of the largest angle by which the normal of a pierced face turns in a step. If the
/// normal turned more, one of the two contacts is from before the face was pierced, and their
/// depths cannot be compared.
constexpr double kSame = 0.999;
/// [1] The same for links, after the first touch. Then the face pierces the link, and the contact's
/// normal is that of the face. Only if this changes nothing, the depths can be compared.
constexpr double kExactlySame = 1.0 - 1e-9;

std::optional<double> known_distance(const Clearance& clearance) {
  if (clearance.state != Clearance::KNOWN || clearance.unresolved) return std::nullopt;
  return clearance.distance;
}

}  // namespace

ContactMotion::Place ContactMotion::place_of(const Contact& contact, const Push& push,
                                             const KeptSides::Radius& radius) {
  Place place{to_eigen(contact.normal), contact.depth, contact.fraction > 0.0, std::nullopt,
              std::nullopt};
  if (!radius) return place;
  place.depth = std::min(contact.depth, *radius);
  place.offset = (*radius - place.depth) * place.normal;
  if (contact.depth >= *radius && push.counts) place.pierced = Pierced{contact.depth, push.depth};
  return place;
}

double ContactMotion::path_length_between(const Place& before, const Place& now) {
  const double agreement = before.normal.dot(now.normal);
  if (!before.offset || !now.offset) {
    const bool is_same = agreement > (before.is_new ? kExactlySame : kSame);
    return is_same ? std::abs(now.depth - before.depth) : 0.0;
  }
  if (before.pierced && now.pierced && agreement > kSame) {
    return std::min(std::abs(now.pierced->depth - before.pierced->depth),
                    std::abs(now.pierced->push - before.pierced->push));
  }
  const Eigen::Vector3d change = *now.offset - *before.offset;
  const double nearer = now.depth - before.depth;
  const double farther = change.dot(before.offset->normalized());
  return std::max({0.5 * change.norm(), nearer, farther});
}

/// [m] A lower bound of the motion if the face was not touched in the last answer.
double ContactMotion::path_length_to(const Contact& contact, const Place& now) {
  // If the face was not touched when the step began, its whole depth arose in this step.
  if (contact.fraction > 0.0) return contact.depth;
  // A face that pierces a link at once may be as deep as the link is thick.
  return now.offset ? now.depth : 0.0;
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
      way = std::max(way, path_length_to(contact, now));
    } else {
      way = std::max(way, path_length_between(before->second, now));
      last_->erase(before);
    }
  }
  const bool follows = last_.has_value();
  if (follows) {
    for (const auto& [face, left] : *last_) {
      // How far a face that the tool passed through is from it is not known.
      if (left.offset && !left.offset->isZero(0.0)) way = std::max(way, left.depth);
    }
  }
  const std::optional<double> distance = known_distance(answer.clearance);
  if (follows && distance && last_distance_) {
    way = std::max(way, std::abs(*distance - *last_distance_));
  }
  last_ = std::move(places);
  last_distance_ = distance;
  return follows ? std::optional<double>(way) : std::nullopt;
}

}  // namespace organ_collision
