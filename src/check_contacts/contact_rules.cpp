#include "contact_rules.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <set>
#include <utility>

#include "place_rules.hpp"
#include "ros/interface/conversions.hpp"

namespace organ_collision {
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

}  // namespace organ_collision
