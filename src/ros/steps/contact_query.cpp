#include "contact_query.hpp"

#include <chrono>
#include <stdexcept>

#include "contact_array.hpp"
#include "query_conversions.hpp"

namespace organ_collision {

ContactQuery::ContactQuery(PickerKind picker) : query_(picker) {
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

void ContactQuery::evaluate(const CollisionRequest& request, ContactArray& answer) {
  const auto start = std::chrono::steady_clock::now();
  try {
    query_.evaluate(request, result_);
  } catch (const std::invalid_argument& error) {
    return set_failure(answer, ContactArray::INVALID_REQUEST, error.what());
  } catch (const GlError& error) {
    return set_failure(answer, ContactArray::PICKER_FAILED, error.what());
  }
  query_times_.add(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());

  answer.status = ContactArray::OK;
  answer.unresolved = static_cast<std::uint32_t>(result_.unresolved);
  for (const FaceContact& contact : result_.contacts)
    answer.contacts.push_back(to_message(contact));
  for (const Region& region : result_.regions) answer.regions.push_back(to_message(region));
}

}  // namespace organ_collision
