#include "answer_rules.hpp"

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>

#include <Eigen/Core>
#include <boost/array.hpp>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <set>
#include <utility>

#include "ros/messages/conversions.hpp"
#include "ros/messages/text.hpp"

namespace organ_collision {

/// What a rule is checked on, for its sentence: "contacts[3] (face 17)".
struct CheckedPlace {
  const char* list;
  std::size_t index;
  std::uint32_t face;
};

std::ostream& operator<<(std::ostream& stream, const CheckedPlace& place);

// The rules of single fields. Each adds a fault if its rule is broken.

void check_finite(const CheckedPlace& place, const char* field, double value, Faults& faults);
void check_finite(const CheckedPlace& place, const char* field, const geometry_msgs::Point& value,
                  Faults& faults);
/// In [0, 1].
void check_share(const CheckedPlace& place, const char* field, double value, Faults& faults);
/// Of length 1, to within 1e-6.
void check_unit(const CheckedPlace& place, const geometry_msgs::Vector3& normal, Faults& faults);
/// In [0, 1] with the sum 1, to within 1e-6.
void check_barycentric(const CheckedPlace& place, const boost::array<double, 3>& barycentric,
                       Faults& faults);
/// The index of one of the tool's links.
void check_link(const CheckedPlace& place, std::uint32_t link, std::size_t links, Faults& faults);
/// A face that an organ may have.
void check_face(const CheckedPlace& place, Faults& faults);

namespace {

/// [1] Lengths of normals, and barycentric coordinates, may be rounded by this much.
constexpr double kRounding = 1e-6;
/// The largest legal value of the node's parameter max_faces.
constexpr std::uint32_t kMostFaces = 83333333;

}  // namespace

std::ostream& operator<<(std::ostream& stream, const CheckedPlace& place) {
  return stream << place.list << '[' << place.index << "] (face " << place.face << ')';
}

void check_finite(const CheckedPlace& place, const char* field, double value, Faults& faults) {
  if (std::isfinite(value)) return;
  faults.add("finite numbers", field, " of ", place, " is ", value, "; must be finite");
}

void check_finite(const CheckedPlace& place, const char* field, const geometry_msgs::Point& value,
                  Faults& faults) {
  const Eigen::Vector3d point = to_eigen(value);
  if (point.allFinite()) return;
  faults.add("finite numbers", field, " of ", place, " is ", point.transpose(), "; must be finite");
}

void check_share(const CheckedPlace& place, const char* field, double value, Faults& faults) {
  if (value >= 0.0 && value <= 1.0) return;
  faults.add("shares", field, " of ", place, " is ", value, "; must be from 0 to 1");
}

void check_unit(const CheckedPlace& place, const geometry_msgs::Vector3& normal, Faults& faults) {
  const Eigen::Vector3d vector = to_eigen(normal);
  if (std::abs(vector.norm() - 1.0) <= kRounding) return;
  faults.add("unit normals", "normal of ", place, " is ", vector.transpose(), ", of length ",
             vector.norm(), "; must be 1");
}

void check_barycentric(const CheckedPlace& place, const boost::array<double, 3>& barycentric,
                       Faults& faults) {
  const Eigen::Map<const Eigen::Vector3d> shares(barycentric.data());
  const bool is_inside = shares.minCoeff() >= -kRounding && shares.maxCoeff() <= 1.0 + kRounding;
  if (shares.allFinite() && is_inside && std::abs(shares.sum() - 1.0) <= kRounding) return;
  faults.add("barycentric coordinates", "barycentric of ", place, " is ", shares.transpose(),
             "; must be from 0 to 1 each, and 1 together");
}

void check_link(const CheckedPlace& place, std::uint32_t link, std::size_t links, Faults& faults) {
  if (link < links) return;
  faults.add("indices", "link of ", place, " is ", link, "; `links` has ", links, " names");
}

void check_face(const CheckedPlace& place, Faults& faults) {
  if (place.face < kMostFaces) return;
  faults.add("indices", place, ": no organ may have more than ", kMostFaces, " faces");
}

/// The rules of `contacts`, `regions`, `unresolved`, `near`, `near_left_out` and `near_unresolved`
/// of an answer with status OK.
void check_touched_faces(const ContactArray& answer, Faults& faults);
void check_near_faces(const ContactArray& answer, Faults& faults);

namespace {

/// [m] Places that must be the same may differ by this much, and by this share of their distance
/// from the frame's origin.
constexpr double kSamePlace = 1e-6;
constexpr double kSameShare = 1e-9;
/// [m] A face at this depth may count as touched or as near.
constexpr double kTouching = 1e-9;

bool is_of_shaft(const Contact& contact, const ContactArray& answer) {
  return contact.link < answer.links.size() && answer.links[contact.link].empty();
}

void check_contact(const Contact& contact, const CheckedPlace& place, const ContactArray& answer,
                   Faults& faults) {
  check_face(place, faults);
  check_link(place, contact.link, answer.links.size(), faults);
  check_share(place, "fraction", contact.fraction, faults);
  check_share(place, "shaft", contact.shaft, faults);
  check_finite(place, "point", contact.point, faults);
  check_finite(place, "end_point", contact.end_point, faults);
  check_finite(place, "depth", contact.depth, faults);
  check_finite(place, "view_min", contact.view_min, faults);
  check_finite(place, "view_max", contact.view_max, faults);
  check_unit(place, contact.normal, faults);
  check_barycentric(place, contact.barycentric, faults);
  if (!is_of_shaft(contact, answer) && contact.shaft != 0.0) {
    faults.add("places on shafts", "shaft of ", place, " is ", contact.shaft,
               "; must be 0, because this is a contact of a link");
  }
}

/// In a static answer, there is no time but the end of the step.
void check_static(const Contact& contact, const CheckedPlace& place, Faults& faults) {
  if (contact.fraction != 0.0) {
    faults.add("static answers", "fraction of ", place, " is ", contact.fraction,
               "; must be 0 in a static answer");
  }
  const Eigen::Vector3d point = to_eigen(contact.point), end = to_eigen(contact.end_point);
  if ((end - point).norm() > kSamePlace + kSameShare * point.norm()) {
    faults.add("static answers", "end_point of ", place, " is ", end.transpose(), ", and point is ",
               point.transpose(), "; must be the same in a static answer");
  }
}

void check_list(const char* list, const std::vector<Contact>& contacts, const ContactArray& answer,
                Faults& faults) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const CheckedPlace place{list, i, contacts[i].face};
    check_contact(contacts[i], place, answer, faults);
    if (answer.mode == ContactArray::STATIC) check_static(contacts[i], place, faults);
  }
}

void check_order(const std::vector<Contact>& contacts, Faults& faults) {
  for (std::size_t i = 1; i < contacts.size(); ++i) {
    const Contact &before = contacts[i - 1], &contact = contacts[i];
    if (std::pair(before.face, before.link) >= std::pair(contact.face, contact.link)) {
      faults.add("order of contacts", "contacts[", i, "] is of face ", contact.face, ", link ",
                 contact.link, ", after face ", before.face, ", link ", before.link,
                 "; must rise by face, then link");
    }
    if (before.face == contact.face && before.vertices != contact.vertices) {
      faults.add("corners of a face", "contacts[", i, "] has other vertices than contacts[", i - 1,
                 "], and both are of face ", contact.face);
    }
  }
}

void check_near_order(const std::vector<Contact>& near, Faults& faults) {
  for (std::size_t i = 1; i < near.size(); ++i) {
    if (near[i - 1].depth >= near[i].depth) continue;
    faults.add("order of near faces", "near[", i, "] is at ", -near[i].depth, " m, after one at ",
               -near[i - 1].depth, " m; the nearest must come first");
  }
}

/// A near face is named once, is not touched, and is within the margin.
void check_nearness(const ContactArray& answer, Faults& faults) {
  std::set<std::uint32_t> known;
  for (const Contact& contact : answer.contacts) known.insert(contact.face);
  const double margin = answer.clearance.margin;
  for (std::size_t i = 0; i < answer.near.size(); ++i) {
    const Contact& near = answer.near[i];
    const CheckedPlace place{"near", i, near.face};
    if (!known.insert(near.face).second) {
      faults.add("near faces", place, " is touched, or named twice; must be near only");
    }
    if (near.depth > kTouching) {
      faults.add("near faces", "depth of ", place, " is ", near.depth,
                 "; must be minus a distance");
    }
    if (margin > 0.0 && -near.depth > margin + kTouching) {
      faults.add("near faces", place, " is at ", -near.depth, " m; the margin is ", margin, " m");
    }
  }
}

}  // namespace

void check_touched_faces(const ContactArray& answer, Faults& faults) {
  check_list("contacts", answer.contacts, answer, faults);
  check_order(answer.contacts, faults);
  const std::size_t contacts = answer.contacts.size(), regions = answer.regions.size();
  if (regions != 0 && regions != contacts) {
    faults.add("regions", regions, " regions of ", contacts, " contacts; must be none or as many");
  }
  if (answer.unresolved > contacts) {
    faults.add("unresolved", "unresolved is ", answer.unresolved, " of ", contacts, " contacts");
  }
}

void check_near_faces(const ContactArray& answer, Faults& faults) {
  check_list("near", answer.near, answer, faults);
  check_near_order(answer.near, faults);
  check_nearness(answer, faults);
  const bool tells_of_near =
      !answer.near.empty() || answer.near_left_out > 0 || answer.near_unresolved > 0;
  if (tells_of_near && answer.clearance.state == Clearance::NOT_ASKED) {
    faults.add("near faces", "there are near faces, but nobody asked for the clearance");
  }
}

/// The rules of `clearance` and `placement` of an answer with status OK.
void check_clearance_fields(const ContactArray& answer, Faults& faults);
void check_placement_fields(const ContactArray& answer, Faults& faults);

namespace {

/// [m] Rounding of distances, and their rounding as a share of the distance from the frame's
/// origin.
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

namespace {

void check_text(const char* what, const std::string& text, std::size_t most, Faults& faults) {
  if (text.size() <= most && plain_text(text, most) == text) return;
  faults.add("texts", what, " is '", plain_text(text, kLongestName), "', of ", text.size(),
             " bytes; must be plain text of at most ", most, " bytes");
}

/// The names of an answer that is OK are legal and not empty.
void check_name(const char* what, const std::string& name, Faults& faults) {
  if (name.empty()) faults.add("names", what, " is empty");
  if (const std::string fault = name_fault(name); !fault.empty()) {
    faults.add("names", what, " ", fault);
  }
}

/// Only a shaft has no name, and it comes first.
void check_links(const ContactArray& answer, Faults& faults) {
  if (answer.links.empty()) faults.add("names", "links is empty; a tool has a shaft or links");
  for (std::size_t i = 0; i < answer.links.size(); ++i) {
    const bool is_shaft = i == 0 && answer.links[i].empty();
    if (!is_shaft) check_name("a link", answer.links[i], faults);
  }
}

/// Of a failure, nothing is known.
void check_failure(const ContactArray& answer, Faults& faults) {
  if (answer.message.empty()) {
    faults.add("messages", "status is ", int{answer.status}, ", and message is empty");
  }
  check_text("frame_id", answer.header.frame_id, kLongestName, faults);
  check_text("organ", answer.organ, kLongestName, faults);
  check_text("tool", answer.tool, kLongestName, faults);
  const ToolPlacement& placement = answer.placement;
  const bool is_empty =
      answer.contacts.empty() && answer.regions.empty() && answer.near.empty() &&
      answer.unresolved == 0 && answer.near_left_out == 0 && answer.near_unresolved == 0 &&
      answer.clearance.state == Clearance::NOT_ASKED && placement.tip == ToolPlacement::UNKNOWN &&
      placement.trocar == ToolPlacement::UNKNOWN && placement.crossings.empty() &&
      !placement.length_known && placement.length_inside == 0.0;
  if (!is_empty) {
    faults.add("failures", "status is ", int{answer.status},
               ", but there are contacts, near faces, a clearance or a placement");
  }
}

bool is_paper_answer(const ContactArray& answer) {
  return answer.mode >= ContactArray::PAPER_STATIC;
}

/// The start and the end of the step.
void check_times(const ContactArray& answer, Faults& faults) {
  const ros::Time start = answer.step_start, end = answer.header.stamp;
  if (start > end) {
    faults.add("stamps", "the step runs from ", start, " to ", end, "; must not run backwards");
  }
  if (answer.mode == ContactArray::STATIC && start != end) {
    faults.add("stamps", "step_start is ", start, ", and the stamp is ", end,
               "; must be the same in a static answer");
  }
}

void check_success(const ContactArray& answer, Faults& faults) {
  if (answer.message.empty() == answer.path_incomplete) {
    faults.add("messages", "status is OK, path_incomplete is ", answer.path_incomplete != 0,
               ", and message is '", plain_text(answer.message, kLongestName),
               "'; must be empty unless path_incomplete is true");
  }
  check_name("frame_id", answer.header.frame_id, faults);
  check_name("organ", answer.organ, faults);
  check_links(answer, faults);
  check_times(answer, faults);
  if (is_paper_answer(answer)) return;
  check_touched_faces(answer, faults);
  check_near_faces(answer, faults);
  check_clearance_fields(answer, faults);
  check_placement_fields(answer, faults);
}

}  // namespace

Faults check_answer(const ContactArray& answer) {
  Faults faults;
  if (answer.status > ContactArray::INVALID_TOOL) {
    faults.add("status", "status is ", int{answer.status}, "; must be from 0 to ",
               int{ContactArray::INVALID_TOOL});
  }
  if (answer.mode > ContactArray::PAPER_NAIVE && answer.status == ContactArray::OK) {
    faults.add("mode", "mode is ", int{answer.mode}, "; must be from 0 to ",
               int{ContactArray::PAPER_NAIVE});
  }
  check_text("message", answer.message, kLongestMessage, faults);
  if (answer.status == ContactArray::OK) {
    check_success(answer, faults);
  } else {
    check_failure(answer, faults);
  }
  return faults;
}

}  // namespace organ_collision
