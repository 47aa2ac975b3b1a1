#include "organ_collision/ros/evaluator.hpp"

#include <chrono>
#include <stdexcept>

#include "organ_collision/ros/answers.hpp"
#include "organ_collision/ros/conversions.hpp"

namespace organ_collision {

void Evaluator::evaluate(const CollisionRequest& request, ContactArray& answer) {
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
  for (const FaceContact& contact : result_.contacts)
    answer.contacts.push_back(to_message(contact));
  for (const Region& region : result_.regions) answer.regions.push_back(to_message(region));
}

}  // namespace organ_collision
