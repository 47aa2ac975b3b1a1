#include "contact_query.hpp"

#include <chrono>
#include <stdexcept>
#include <vector>

#include "contact_array.hpp"
#include "query_conversions.hpp"

namespace organ_collision {
namespace {

std::vector<Contact> to_messages(const std::vector<FaceContact>& contacts) {
  std::vector<Contact> messages;
  messages.reserve(contacts.size());
  for (const FaceContact& contact : contacts) messages.push_back(to_message(contact));
  return messages;
}

}  // namespace

ContactQuery::ContactQuery(const PickerSettings& picker) : query_(picker) {
  const TriangleMesh face({-1.0f, -1.0f, 0.0f, 1.0f, -1.0f, 0.0f, 0.0f, 1.0f, 0.0f}, {0, 1, 2});
  const ShaftAxis above{{0.0, 0.0, 1.0}, {0.1, 0.0, 0.5}},
      through{{0.0, 0.0, 1.0}, {0.2, 0.0, -0.5}};
  CollisionRequest request;
  request.organ = &face;
  request.path = {{0.0, above}, {1.0, through}};
  request.radius = 0.01;
  request.regions = true;
  for (const QueryMode mode : {QueryMode::kStatic, QueryMode::kSwept, QueryMode::kPaperStatic,
                               QueryMode::kPaperSwept, QueryMode::kPaperNaive}) {
    request.mode = mode;
    query_.evaluate(request, result_);
  }
}

double ContactQuery::evaluate(const CollisionRequest& request, ContactArray& answer) {
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
  answer.unresolved = static_cast<std::uint32_t>(result_.unresolved);
  answer.contacts = to_messages(result_.contacts);
  for (const Region& region : result_.regions) answer.regions.push_back(to_message(region));
  answer.near = to_messages(result_.near);
  answer.near_left_out = static_cast<std::uint32_t>(result_.near_left_out);
  answer.near_unresolved = static_cast<std::uint32_t>(result_.near_unresolved);
  answer.clearance = to_message(result_.clearance);
  answer.placement = to_message(result_.placement);
  return query_time.count();
}

}  // namespace organ_collision
