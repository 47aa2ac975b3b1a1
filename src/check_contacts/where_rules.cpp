#include "where_rules.hpp"

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "place_rules.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
namespace {

/// [m] Rounding of distances, and their rounding as a share of the distance from the frame's
/// origin.
constexpr double kRounding = 1e-6;
constexpr double kRoundingShare = 1e-9;

/// on_organ - on_tool = distance * normal.
void check_vector(const Clearance& clearance, Faults& faults) {
  const Eigen::Vector3d on_organ = to_eigen(clearance.on_organ);
  const Eigen::Vector3d between = on_organ - to_eigen(clearance.on_tool);
  const Eigen::Vector3d expected = clearance.distance * to_eigen(clearance.normal);
  if ((between - expected).norm() <= kRounding + kRoundingShare * on_organ.norm()) return;
  faults.add("clearance", "on_organ - on_tool of the clearance is ", between.transpose(),
             ", and distance * normal is ", expected.transpose(), "; must be the same");
}

void check_margin(const Clearance& clearance, Faults& faults) {
  const bool is_legal = clearance.unlimited ? clearance.margin == 0.0 : clearance.margin > 0.0;
  if (!is_legal || !std::isfinite(clearance.margin)) {
    faults.add("clearance", "margin of the clearance is ", clearance.margin,
               clearance.unlimited ? "; must be 0, because it is unlimited" : "; must be positive");
  }
  const bool has_distance = clearance.state == Clearance::KNOWN && !clearance.unlimited;
  if (has_distance && clearance.distance > clearance.margin + kRounding) {
    faults.add("clearance", "distance of the clearance is ", clearance.distance,
               "; must be at most its margin, ", clearance.margin);
  }
}

/// How `least` goes with `distance`.
void check_least(const ContactArray& answer, Faults& faults) {
  const Clearance& clearance = answer.clearance;
  if (answer.mode == ContactArray::STATIC) {
    if (clearance.least == clearance.distance && clearance.least_fraction == 0.0) return;
    faults.add("clearance", "least of the clearance is ", clearance.least, " at ",
               clearance.least_fraction, " of the step; must be its distance, ", clearance.distance,
               ", at 0, in a static answer");
  } else if (!answer.contacts.empty()) {
    if (clearance.least == 0.0) return;
    faults.add("clearance", "least of the clearance is ", clearance.least,
               "; must be 0, because faces were touched");
  } else if (!(clearance.least <= clearance.distance)) {
    faults.add("clearance", "least of the clearance is ", clearance.least,
               "; must be at most its distance, ", clearance.distance);
  }
}

/// What touches at the end of the step is a contact, and what is a contact in a static answer
/// touches.
void check_touch(const ContactArray& answer, Faults& faults) {
  const Clearance& clearance = answer.clearance;
  const double rounding = kRounding + kRoundingShare * to_eigen(clearance.on_organ).norm();
  const bool is_known = clearance.state == Clearance::KNOWN;
  if (is_known && answer.contacts.empty() && clearance.distance < -rounding) {
    faults.add("clearance", "distance of the clearance is ", clearance.distance,
               "; what it touches must be among the contacts");
  }
  const bool must_touch =
      answer.contacts.size() > answer.unresolved && answer.mode == ContactArray::STATIC;
  if (!must_touch || clearance.unresolved) return;
  if (!is_known || clearance.distance > rounding) {
    faults.add("clearance", answer.contacts.size() - answer.unresolved,
               " faces are touched, but the clearance is ",
               is_known ? std::to_string(clearance.distance) + " m" : "beyond its margin");
  }
}

void check_known(const ContactArray& answer, Faults& faults) {
  const Clearance& clearance = answer.clearance;
  const CheckedPlace place{"clearance", 0, clearance.face};
  check_face(place, faults);
  check_link(place, clearance.link, answer.links.size(), faults);
  check_finite(place, "distance", clearance.distance, faults);
  check_finite(place, "least", clearance.least, faults);
  check_share(place, "least_fraction", clearance.least_fraction, faults);
  check_finite(place, "on_organ", clearance.on_organ, faults);
  check_finite(place, "on_tool", clearance.on_tool, faults);
  check_unit(place, clearance.normal, faults);
  check_barycentric(place, clearance.barycentric, faults);
  check_vector(clearance, faults);
  check_least(answer, faults);
}

void check_crossings(const std::vector<Crossing>& crossings, Faults& faults) {
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const Crossing& crossing = crossings[i];
    const CheckedPlace place{"crossings", i, crossing.face};
    check_face(place, faults);
    check_barycentric(place, crossing.barycentric, faults);
    check_share(place, "shaft", crossing.shaft, faults);
    check_finite(place, "point", crossing.point, faults);
    if (crossing.direction != 1 && crossing.direction != -1) {
      faults.add("crossings", "direction of ", place, " is ", int{crossing.direction},
                 "; must be 1 or -1");
    }
    if (i > 0 && crossings[i - 1].shaft > crossing.shaft) {
      faults.add("crossings", place, " is at ", crossing.shaft, " of the shaft, after one at ",
                 crossings[i - 1].shaft, "; must go from trocar to tip");
    }
  }
}

void check_side(const char* what, std::uint8_t side, Faults& faults) {
  if (side <= ToolPlacement::ON_SURFACE) return;
  faults.add("placement", what, " of the placement is ", int{side}, "; must be from 0 to ",
             int{ToolPlacement::ON_SURFACE});
}

void check_length(const ToolPlacement& placement, Faults& faults) {
  const bool are_sides_known =
      placement.tip != ToolPlacement::UNKNOWN && placement.trocar != ToolPlacement::UNKNOWN;
  if (placement.length_known != are_sides_known) {
    faults.add("placement", "length_known is ", int{placement.length_known},
               ", with the sides of tip and trocar ", int{placement.tip}, " and ",
               int{placement.trocar}, "; must be 1 if both are known, else 0");
  }
  const double length = placement.length_inside;
  const bool is_legal = placement.length_known ? length >= 0.0 : length == 0.0;
  if (is_legal && std::isfinite(length)) return;
  faults.add("placement", "length_inside is ", length, "; must be ",
             placement.length_known ? "a length" : "0, because it is not known");
}

}  // namespace

void check_clearance_fields(const ContactArray& answer, Faults& faults) {
  const Clearance& clearance = answer.clearance;
  if (clearance.state > Clearance::KNOWN) {
    faults.add("clearance", "state of the clearance is ", int{clearance.state},
               "; must be from 0 to ", int{Clearance::KNOWN});
  }
  if (clearance.state != Clearance::NOT_ASKED) {
    check_margin(clearance, faults);
    check_touch(answer, faults);
  }
  if (clearance.state == Clearance::KNOWN) check_known(answer, faults);
}

void check_placement_fields(const ContactArray& answer, Faults& faults) {
  const ToolPlacement& placement = answer.placement;
  check_side("tip", placement.tip, faults);
  check_side("trocar", placement.trocar, faults);
  check_length(placement, faults);
  check_crossings(placement.crossings, faults);
  const bool has_shaft = !answer.links.empty() && answer.links.front().empty();
  if (has_shaft) return;
  if (placement.trocar != ToolPlacement::UNKNOWN || !placement.crossings.empty()) {
    faults.add("placement", "the tool has no shaft, but the placement has a side of its trocar or ",
               placement.crossings.size(), " crossings");
  }
}

}  // namespace organ_collision
