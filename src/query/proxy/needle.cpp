#include "needle.hpp"

#include <algorithm>
#include <limits>

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] The tip presses on a face if the cosine of the angle between the axis and the contact's
/// normal is larger than this.
constexpr double kPressing = 0.5;
/// [1] The needle is lost if the distance from trocar to entry is less than this share of the
/// length of the hand's shaft. If it went on, the load at the entry would grow without bound.
constexpr double kShortestLever = 0.02;

/// [m] A needle pierces a face when the hand's tip is this far ahead of its tip, along the axis.
double threshold(const ProxySettings& settings) {
  return settings.puncture.value_or(std::numeric_limits<double>::infinity());
}

}  // namespace

std::optional<Needle> Needle::pierce(const ShaftAxis& proxy, const ShaftAxis& hand,
                                     const std::vector<ProxyFace>& contacts,
                                     const std::vector<ProxyOrgan>& organs,
                                     const ProxySettings& settings, Tissue& tissue) {
  const Vector3d direction = proxy.along().normalized();
  const double excess = direction.dot(hand.tip - proxy.tip);
  const bool is_pressing = std::any_of(contacts.begin(), contacts.end(), [&](const auto& held) {
    return held.load > 0.0 && held.contact.link == kShaft && held.contact.shaft == 1.0 &&
           held.contact.normal.dot(direction) > kPressing;
  });
  if (!is_pressing || !(excess >= threshold(settings))) return std::nullopt;
  const ShaftAxis ahead{proxy.trocar, proxy.tip + excess * direction};
  const std::vector<ProxyCrossing> crossings = tissue.cross(ahead);
  const double tip = proxy.along().norm() / ahead.along().norm();
  const auto entry = std::find_if(crossings.begin(), crossings.end(),
                                  [&](const ProxyCrossing& found) { return found.shaft >= tip; });
  if (entry == crossings.end()) return std::nullopt;
  const ProxyOrgan& organ = organs[entry->organ];
  Needle needle(organ.name, *entry, organ.shape->faces()[entry->face]);
  const bool is_held = needle.follow(hand, organs, settings, tissue) == Fate::kHeld;
  return is_held ? std::optional<Needle>(needle) : std::nullopt;
}

Needle::Fate Needle::follow(const ShaftAxis& hand, const std::vector<ProxyOrgan>& organs,
                            const ProxySettings& settings, Tissue& tissue) {
  if (!find_entry(organs)) return Fate::kLost;
  if (tissue.clearance(entry_.organ, kShaft) == 0.0) return Fate::kPulledOut;
  const Vector3d to_entry = entry_.point - hand.trocar;
  const Vector3d direction = to_entry.normalized();
  const double entry = to_entry.norm();
  if (!(entry > kShortestLever * hand.along().norm())) return Fate::kLost;
  const double hand_tip = direction.dot(hand.along());
  const double wanted =
      std::clamp(entry + inserted_, hand_tip - settings.friction, hand_tip + settings.friction);
  axis_ = {hand.trocar, hand.trocar + wanted * direction};
  const double tip = stop_at_faces(entry + inserted_, hand_tip, settings, tissue);
  inserted_ = tip - entry;
  axis_.tip = hand.trocar + tip * direction;
  if (inserted_ < 0.0) return Fate::kPulledOut;
  describe(hand, tissue);
  return Fate::kHeld;
}

/// Moves the entry to its place in the organ's present shape. Returns false if its face is gone.
bool Needle::find_entry(const std::vector<ProxyOrgan>& organs) {
  const auto organ = std::find_if(organs.begin(), organs.end(), [&](const ProxyOrgan& candidate) {
    return candidate.name == organ_;
  });
  if (organ == organs.end()) return false;
  const TriangleMesh& shape = *organ->shape;
  if (entry_.face >= shape.face_count() || shape.faces()[entry_.face] != corners_) return false;
  entry_.organ = static_cast<std::size_t>(organ - organs.begin());
  entry_.point =
      organ->T_organ_proxy.inverse() * point_at(shape.triangle(entry_.face), entry_.barycentric);
  return true;
}

/// [m] The distance from the trocar at which the tip ends. The tip moves from the distance `from`
/// to the tip of axis_, but stops at the first face that it does not pierce.
double Needle::stop_at_faces(double from, double hand_tip, const ProxySettings& settings,
                             Tissue& tissue) const {
  const double to = axis_.along().norm();
  if (!(to > from)) return to;
  const Vector3d direction = axis_.along() / to;
  const double most = tissue.clearance().most, length = to + most;
  const ShaftAxis ahead{axis_.trocar, axis_.tip + most * direction};
  double tip = to;
  for (const ProxyCrossing& found : tissue.cross(ahead)) {
    const double face = found.shaft * length;
    const double stop = face - tissue.clearance(found.organ, kShaft);
    if (face <= from || (is_entry(found) && inserted_ == 0.0) ||
        hand_tip - stop >= threshold(settings))
      continue;
    tip = std::min(tip, std::clamp(stop, from, to));
  }
  return tip;
}

void Needle::describe(const ShaftAxis& hand, Tissue& tissue) {
  const double length = axis_.along().norm();
  const Vector3d direction = axis_.along() / length;
  entry_.shaft = (entry_.point - axis_.trocar).norm() / length;
  const Vector3d pull = axis_.tip - hand.tip;
  const Vector3d lengthwise = direction.dot(pull) * direction;
  // Across its direction, the axis is a lever about the trocar.
  entry_.load = -(lengthwise + (pull - lengthwise) / entry_.shaft);
  crossings_ = {entry_};
  for (const ProxyCrossing& further : tissue.cross(axis_)) {
    if (!is_entry(further) && further.shaft > entry_.shaft) crossings_.push_back(further);
  }
}

}  // namespace organ_collision
