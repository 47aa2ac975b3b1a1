#include "contact_array.hpp"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <tuple>

#include "common/messages/finite.hpp"
#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"
#include "query/make_request.hpp"

namespace organ_collision {
namespace {

// The constants of the messages equal the enumerators, so that a cast converts them.
static_assert(Clearance::NOT_ASKED == static_cast<int>(ClearanceState::kNotAsked) &&
              Clearance::BEYOND_MARGIN == static_cast<int>(ClearanceState::kBeyondMargin) &&
              Clearance::KNOWN == static_cast<int>(ClearanceState::kKnown));
static_assert(ToolPlacement::UNKNOWN == static_cast<int>(Side::kUnknown) &&
              ToolPlacement::OUTSIDE == static_cast<int>(Side::kOutside) &&
              ToolPlacement::INSIDE == static_cast<int>(Side::kInside) &&
              ToolPlacement::ON_SURFACE == static_cast<int>(Side::kOnSurface));

/// Copies a place on a face: the face, its vertices and the barycentric coordinates.
template <typename Source, typename Message>
void set_place(const Source& source, Message& message) {
  message.face = source.face;
  for (std::size_t i = 0; i < 3; ++i) message.vertices[i] = source.vertices[i];
  for (std::size_t i = 0; i < 3; ++i) message.barycentric[i] = source.barycentric[i];
}

/// The time at a fraction of an answer's step.
ros::Time time_at(const ContactArray& answer, double fraction) {
  const std::uint64_t start = answer.step_start.toNSec(), end = answer.header.stamp.toNSec();
  ros::Time time;
  time.fromNSec(start + static_cast<std::uint64_t>(fraction * static_cast<double>(end - start)));
  return time;
}

/// The numbers of the faces that still touch when the step ends, each once, in rising order.
std::vector<std::uint32_t> touched_faces(const std::vector<Contact>& contacts) {
  std::vector<std::uint32_t> faces;
  for (const Contact& contact : contacts) {
    if (!contact.touching || (!faces.empty() && faces.back() == contact.face)) continue;
    faces.push_back(contact.face);
  }
  return faces;
}

}  // namespace

void set_failure(ContactArray& answer, std::uint8_t status, const std::string& message) {
  answer.status = status;
  answer.message = plain_text(message, kLongestMessage);
  answer.contacts.clear();
  answer.released.clear();
  answer.regions.clear();
  answer.unresolved = 0;
  answer.near.clear();
  answer.near_more = false;
  answer.near_unresolved = 0;
  answer.around.clear();
  answer.around_up_to = 0.0;
  answer.clearance = {};
  answer.placement = {};
  answer.view_min.clear();
  answer.view_max.clear();
  answer.path_incomplete = false;
}

void set_memory(ContactArray& answer, const ContactArray* last) {
  if (answer.status != ContactArray::OK) return;
  static const std::vector<Contact> kNone;
  const std::vector<Contact>& known = last ? last->contacts : kNone;
  auto before = known.begin();  // Both lists are sorted by face, then link.
  for (Contact& now : answer.contacts) {
    const auto precedes = [](const Contact& a, const Contact& b) {
      return std::tie(a.face, a.link) < std::tie(b.face, b.link);
    };
    before = std::lower_bound(before, known.end(), now, precedes);
    const bool goes_on =
        before != known.end() && !precedes(now, *before) && before->touching && now.fraction == 0.0;
    now.since = goes_on ? before->since : time_at(answer, now.fraction);
  }
  const std::vector<std::uint32_t> touched_before = touched_faces(known);
  const std::vector<std::uint32_t> touched_now = touched_faces(answer.contacts);
  std::set_difference(touched_before.begin(), touched_before.end(), touched_now.begin(),
                      touched_now.end(), std::back_inserter(answer.released));
}

void count_failure(FailureLog& log, std::uint8_t status, const std::string& message) {
  if (status != ContactArray::OK) log.add(reason_of(status), message);
}

std::string stale_fault(const std::string& organ, const OrganShape& shape, ros::Time now,
                        double timeout_sec) {
  if (!(timeout_sec > 0.0 && shape.age(now) > timeout_sec)) return "";
  return concatenate("the last shape of organ '", organ, "' came ", duration_text(shape.age(now)),
                     " ago; at most ", timeout_sec, " s are allowed (mesh_timeout_sec)");
}

Contact to_message(const FaceContact& contact) {
  Contact message;
  set_place(contact, message);
  message.link = contact.link;
  message.touching = contact.touching;
  message.fraction = contact.fraction;
  message.point = tf2::toMsg(contact.point);
  message.normal = to_vector(contact.normal);
  message.shaft = contact.shaft;
  message.depth = contact.depth;
  message.behind = contact.behind;
  message.on_organ = tf2::toMsg(contact.on_organ);
  message.velocity = to_vector(contact.velocity);
  message.on_tool = tf2::toMsg(contact.on_tool());
  return message;
}

Clearance to_message(const ToolClearance& clearance) {
  Clearance message;
  set_place(clearance, message);
  message.state = static_cast<std::uint8_t>(clearance.state);
  message.margin = clearance.margin;
  message.unlimited = clearance.unlimited;
  message.distance = clearance.distance;
  message.least = clearance.least;
  message.least_fraction = clearance.least_fraction;
  message.link = clearance.link;
  message.on_organ = tf2::toMsg(clearance.on_organ);
  message.on_tool = tf2::toMsg(clearance.on_tool);
  message.normal = to_vector(clearance.normal);
  message.normal_defined = clearance.normal_defined;
  message.unresolved = !clearance.is_resolved;
  message.closing_speed = clearance.closing_speed;
  return message;
}

Crossing to_message(const AxisCrossing& crossing) {
  Crossing message;
  set_place(crossing, message);
  message.shaft = crossing.shaft;
  message.point = tf2::toMsg(crossing.point);
  message.direction = crossing.direction;
  return message;
}

ToolPlacement to_message(const AxisPlacement& placement) {
  ToolPlacement message;
  message.tip = static_cast<std::uint8_t>(placement.tip);
  message.trocar = static_cast<std::uint8_t>(placement.trocar);
  message.crossings.reserve(placement.crossings.size());
  for (const AxisCrossing& crossing : placement.crossings) {
    message.crossings.push_back(to_message(crossing));
  }
  message.length_known = placement.length_known;
  message.length_inside = placement.length_inside;
  return message;
}

geometry_msgs::Polygon to_message(const Region& region) {
  geometry_msgs::Polygon message;
  for (const auto& corner : region) {
    geometry_msgs::Point32& point = message.points.emplace_back();
    point.x = static_cast<float>(corner.x());
    point.y = static_cast<float>(corner.y());
    point.z = static_cast<float>(corner.z());
  }
  return message;
}

ContactQuery::ContactQuery(const PickerSettings& picker) : query_(picker) {
  const TriangleMesh face({-1.0f, -1.0f, 0.0f, 1.0f, -1.0f, 0.0f, 0.0f, 1.0f, 0.0f}, {0, 1, 2});
  const ShaftAxis above{{0.0, 0.0, 1.0}, {0.1, 0.0, 0.5}},
      through{{0.0, 0.0, 1.0}, {0.2, 0.0, -0.5}};
  for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept, QueryMode::kPaperStatic,
                               QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    query_.evaluate(make_request({&face}, {0.01}, {mode, true}, {{0.0, above}, {1.0, through}}),
                    result_);
  }
}

double ContactQuery::evaluate(const CollisionRequest& request, ContactArray& answer,
                              const std::string& unknown) {
  const auto start = std::chrono::steady_clock::now();
  try {
    query_.evaluate(request, result_);
  } catch (const std::invalid_argument& error) {
    set_failure(answer, ContactArray::INVALID_REQUEST, error.what());
    return 0.0;
  } catch (const GlError& error) {
    set_failure(answer, ContactArray::PICKER_FAILED, error.what());
    return 0.0;
  }
  const std::chrono::duration<double> query_time = std::chrono::steady_clock::now() - start;

  answer.status = ContactArray::OK;
  answer.path_incomplete = !unknown.empty();
  answer.message = plain_text(unknown, kLongestMessage);
  answer.unresolved = static_cast<std::uint32_t>(result_.unresolved);
  for (const FaceContact& at : result_.contacts) answer.contacts.push_back(to_message(at));
  for (const Region& region : result_.regions) answer.regions.push_back(to_message(region));
  for (const FaceContact& at : result_.near) answer.near.push_back(to_message(at));
  for (const FaceContact& at : result_.around) answer.around.push_back(to_message(at));
  answer.around_up_to = result_.around_up_to;
  for (const ViewRange& range : result_.view_ranges) {
    answer.view_min.push_back(range.min);
    answer.view_max.push_back(range.max);
  }
  answer.near_more = result_.near_more;
  answer.near_unresolved = static_cast<std::uint32_t>(result_.near_unresolved);
  answer.clearance = to_message(result_.clearance);
  answer.placement = to_message(result_.placement);
  if (!is_finite(answer)) {
    set_failure(answer, ContactArray::INVALID_REQUEST,
                "no answer: a place or a distance in it is not a finite number");
    return 0.0;
  }
  return query_time.count();
}

}  // namespace organ_collision
