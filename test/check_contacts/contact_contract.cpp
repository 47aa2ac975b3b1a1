#include "contact_contract.hpp"

#include <Eigen/Core>
#include <cmath>
#include <ostream>
#include <set>
#include <utility>

#include "common/messages/conversions.hpp"
#include "common/messages/failure_log.hpp"
#include "common/messages/text.hpp"
#include "organ_collision/query/contact.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;

/// [1] Lengths of normals, and barycentric coordinates, may be rounded by this much.
constexpr double kRounding = 1e-6;
/// [m] Distances, and places that must be the same, may differ by this much, and by this share of
/// their distance from the frame's origin.
constexpr double kSamePlace = 1e-6;
constexpr double kSameShare = 1e-9;
/// The largest legal value of the node's parameter max_faces.
constexpr std::uint32_t kMostFaces = 83333333;

/// [s] Times that must be the same may differ by this much.
constexpr double kSameTime = 1e-6;

double same_place(const Vector3d& place) { return kSamePlace + kSameShare * place.norm(); }

/// What a rule is checked on, for its sentence: "contacts[3] (face 17)".
struct Place {
  const char* list;
  std::size_t index;
  std::uint32_t face;
};

std::ostream& operator<<(std::ostream& stream, const Place& place) {
  return stream << place.list << '[' << place.index << "] (face " << place.face << ')';
}

/// Checks one answer. Each function collects what it finds in faults_.
class AnswerCheck {
 public:
  explicit AnswerCheck(const ContactArray& answer) : answer_(answer) {}

  Faults run() {
    const bool is_ok = answer_.status == ContactArray::OK;
    require(answer_.status < status_names().size(), "status", "status is ", int{answer_.status});
    require(!is_ok || answer_.mode <= ContactArray::PAPER_NAIVE, "mode", "mode is ",
            int{answer_.mode});
    is_ok ? check_success() : check_failure();
    return std::move(faults_);
  }

 private:
  template <typename... Parts>
  void require(bool is_kept, const char* rule, const Parts&... parts) {
    if (!is_kept) faults_.add(rule, parts...);
  }

  /// Of a failure, nothing is known.
  void check_failure() {
    require(!answer_.message.empty(), "messages", "status is ", int{answer_.status},
            ", and message is empty");
    require(answer_.contacts.empty() && answer_.regions.empty() && answer_.near.empty() &&
                answer_.unresolved == 0 && !answer_.near_more && answer_.near_unresolved == 0 &&
                answer_.released.empty() && answer_.clearance.state == Clearance::NOT_ASKED &&
                answer_.placement == ToolPlacement(),
            "failures", "status is ", int{answer_.status},
            ", but there are contacts, near faces, a clearance or a placement");
  }

  void check_success() {
    require(answer_.message.empty() != (answer_.path_incomplete != 0), "messages",
            "status is OK, path_incomplete is ", answer_.path_incomplete != 0, ", and message is '",
            answer_.message, "'");
    require(!answer_.header.frame_id.empty() && !answer_.organ.empty(), "names",
            "frame_id or organ is empty");
    const ros::Time start = answer_.step_start, end = answer_.header.stamp;
    require(is_static() ? start == end : start <= end, "stamps", "the step runs from ", start,
            " to ", end);
    if (answer_.mode >= ContactArray::PAPER_STATIC) return;
    check_touched_faces();
    check_near_faces();
    check_clearance();
  }

  bool is_static() const { return answer_.mode == ContactArray::STATIC; }

  // The rules of single fields.

  void check_finite(const Place& place, const char* field, const Vector3d& value) {
    require(value.allFinite(), "finite numbers", field, " of ", place, " is ", value.transpose());
  }
  void check_finite(const Place& place, const char* field, double value) {
    require(std::isfinite(value), "finite numbers", field, " of ", place, " is ", value);
  }

  void check_share(const Place& place, const char* field, double value) {
    require(value >= 0.0 && value <= 1.0, "shares", field, " of ", place, " is ", value,
            "; must be from 0 to 1");
  }

  void check_unit(const Place& place, const Vector3d& normal) {
    require(std::abs(normal.norm() - 1.0) <= kRounding, "unit normals", "normal of ", place, " is ",
            normal.transpose(), ", of length ", normal.norm());
  }

  void check_face(const Place& place) {
    require(place.face < kMostFaces, "indices", place, ": no organ may have more than ", kMostFaces,
            " faces");
  }

  void check_link(const Place& place, std::int32_t link) {
    require(link >= kShaft && link < static_cast<std::int64_t>(answer_.links.size()), "indices",
            "link of ", place, " is ", link, "; `links` has ", answer_.links.size(), " names");
  }

  void check_barycentric(const Place& place, const boost::array<double, 3>& barycentric) {
    const Eigen::Map<const Vector3d> shares(barycentric.data());
    const bool is_inside = shares.minCoeff() >= -kRounding && shares.maxCoeff() <= 1.0 + kRounding;
    require(shares.allFinite() && is_inside && std::abs(shares.sum() - 1.0) <= kRounding,
            "barycentric coordinates", "barycentric of ", place, " is ", shares.transpose());
  }

  // The rules of lists and groups.

  void check_list(const char* list, const std::vector<Contact>& contacts) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Contact& contact = contacts[i];
      const Place place{list, i, contact.face};
      const Vector3d point = to_eigen(contact.point), end = to_eigen(contact.on_organ);
      check_face(place);
      check_link(place, contact.link);
      check_share(place, "fraction", contact.fraction);
      check_share(place, "shaft", contact.shaft);
      check_finite(place, "point", point);
      check_finite(place, "on_organ", end);
      check_finite(place, "velocity", to_eigen(contact.velocity));
      check_finite(place, "depth", contact.depth);
      check_unit(place, to_eigen(contact.normal));
      check_barycentric(place, contact.barycentric);
      if (!is_static()) continue;  // A static answer has no time but the end of the step.
      require(contact.fraction == 0.0, "static answers", "fraction of ", place, " is ",
              contact.fraction);
      require(!((end - point).norm() > same_place(point)), "static answers", "on_organ of ", place,
              " is ", end.transpose(), ", and point is ", point.transpose());
    }
  }

  void check_touched_faces() {
    const std::vector<Contact>& contacts = answer_.contacts;
    check_list("contacts", contacts);
    for (const Contact& contact : contacts) {
      require(!is_static() || contact.touching, "static answers", "face ", contact.face,
              " is a contact, but not touching");
    }
    for (std::size_t i = 1; i < contacts.size(); ++i) {
      const Contact &before = contacts[i - 1], &contact = contacts[i];
      require(std::pair(before.face, before.link) < std::pair(contact.face, contact.link),
              "order of contacts", "contacts[", i, "] is of face ", contact.face, ", link ",
              contact.link, ", after face ", before.face, ", link ", before.link);
    }
    const std::size_t regions = answer_.regions.size();
    require(regions == 0 || regions == contacts.size(), "regions", regions, " regions of ",
            contacts.size(), " contacts");
    require(answer_.unresolved <= contacts.size(), "unresolved", "unresolved is ",
            answer_.unresolved, " of ", contacts.size(), " contacts");
  }

  /// A near face is named once, and is not touched. The nearest comes first.
  void check_near_faces() {
    const std::vector<Contact>& near = answer_.near;
    check_list("near", near);
    std::set<std::uint32_t> known;
    for (const Contact& contact : answer_.contacts) known.insert(contact.face);
    for (std::size_t i = 0; i < near.size(); ++i) {
      const Place place{"near", i, near[i].face};
      require(i == 0 || near[i - 1].depth >= near[i].depth, "order of near faces", place, " is at ",
              -near[i].depth, " m, after one that is farther");
      require(!near[i].touching && known.insert(near[i].face).second, "near faces", place,
              " is touched, or named twice");
    }
  }

  void check_clearance() {
    const Clearance& clearance = answer_.clearance;
    if (clearance.state != Clearance::KNOWN) return;
    const Place place{"clearance", 0, clearance.face};
    check_face(place);
    check_link(place, clearance.link);
    check_finite(place, "distance", clearance.distance);
    check_finite(place, "closing_speed", clearance.closing_speed);
    check_finite(place, "on_organ", to_eigen(clearance.on_organ));
    check_finite(place, "on_tool", to_eigen(clearance.on_tool));
    check_share(place, "least_fraction", clearance.least_fraction);
    check_unit(place, to_eigen(clearance.normal));
    check_barycentric(place, clearance.barycentric);
    require(!answer_.contacts.empty() || clearance.least <= clearance.distance, "clearance",
            "least of the clearance is ", clearance.least, ", and its distance ",
            clearance.distance);
  }

  const ContactArray& answer_;
  Faults faults_;
};

}  // namespace

Faults check_answer(const ContactArray& answer) { return AnswerCheck(answer).run(); }

Faults ContactContract::check(const ContactArray& answer, const std::string& publisher) {
  Faults faults = check_answer(answer);
  if (answer.mode > ContactArray::SWEPT && answer.status == ContactArray::OK) {
    faults.add("mode", "mode is ", int{answer.mode}, "; steps are STATIC (0) or SWEPT (1)");
  }
  if (answer.status == ContactArray::OK && answer.tool.empty()) {
    faults.add("names", "tool is empty");
  }
  Stream& stream = streams_[publisher];
  follow(answer, stream);
  if (answer.status != ContactArray::OK) return faults;
  const auto last = stream.last.find({answer.organ, answer.tool});
  const bool is_swept = answer.mode == ContactArray::SWEPT;
  if (!is_swept) {
    check_memory(answer, nullptr, faults);
  } else if (last != stream.last.end()) {
    check_start(answer, last->second, faults);
    const bool is_same_mesh = last->second.topology == answer.topology;
    check_memory(answer, is_same_mesh ? &last->second : nullptr, faults);
  }
  LastAnswer now{answer.header.stamp, answer.topology, {}};
  for (const Contact& contact : answer.contacts) {
    if (contact.touching) now.touching[{contact.face, contact.link}] = contact.since;
  }
  stream.last[{answer.organ, answer.tool}] = std::move(now);
  return faults;
}

/// After a gap, and after a restart of the publisher, nothing is known of the last steps.
void ContactContract::follow(const ContactArray& answer, Stream& stream) {
  const std::uint32_t seq = answer.header.seq;
  if (stream.seq && seq != *stream.seq + 1) {
    if (seq > *stream.seq) lost_ += seq - *stream.seq - 1;
    stream.last.clear();
  }
  stream.seq = seq;
}

/// A swept step begins where the last successful one ended.
void ContactContract::check_start(const ContactArray& answer, const LastAnswer& last,
                                  Faults& faults) {
  if (last.end == answer.step_start) return;
  faults.add("steps that join", "the step begins at ", answer.step_start,
             ", and the last successful one ended at ", last.end, "; must be the same");
}

/// What an answer remembers of the last one. `last`: null if it begins anew.
void ContactContract::check_memory(const ContactArray& answer, const LastAnswer* last,
                                   Faults& faults) {
  const double duration = answer.header.stamp.toSec() - answer.step_start.toSec();
  std::set<std::uint32_t> touched, released;
  for (const Contact& contact : answer.contacts) {
    if (contact.touching) touched.insert(contact.face);
    double since = contact.fraction * duration;  // [s] after the start of the step
    if (last && contact.fraction == 0.0) {
      const auto before = last->touching.find({contact.face, contact.link});
      if (before != last->touching.end()) {
        since = before->second.toSec() - answer.step_start.toSec();
      }
    }
    const double told = contact.since.toSec() - answer.step_start.toSec();
    if (std::abs(told - since) <= kSameTime) continue;
    faults.add("memory", "since of face ", contact.face, " is ", told,
               " s after the start of the step; must be ", since);
  }
  if (last) {
    for (const auto& [face_and_link, since] : last->touching) {
      if (touched.count(face_and_link.first) == 0) released.insert(face_and_link.first);
    }
  }
  if (std::equal(released.begin(), released.end(), answer.released.begin(),
                 answer.released.end())) {
    return;
  }
  faults.add("memory", answer.released.size(), " faces are released; must be ", released.size());
}

}  // namespace organ_collision
