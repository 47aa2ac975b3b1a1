// Uses the library and the message types that catkin finds. Prints the message for the face that a
// resting shaft touches.
#include <organ_collision/ContactArray.h>

#include <iostream>
#include <organ_collision/query/collision_query.hpp>

int main() {
  const organ_collision::TriangleMesh organ(
      {-0.05f, -0.05f, 0.1f, 0.05f, -0.05f, 0.1f, 0.05f, 0.05f, 0.1f}, {0, 1, 2});
  organ_collision::CollisionRequest request;
  request.organ = &organ;
  request.radius = 0.005;
  request.path = organ_collision::resting_path({{{0.01, -0.01, 0.0}, {0.01, -0.01, 0.15}}});

  organ_collision::CollisionQuery query;
  organ_collision::CollisionResult result;
  query.evaluate(request, result);

  organ_collision::ContactArray message;
  for (const auto& touched : result.contacts) {
    message.contacts.emplace_back();
    message.contacts.back().face = touched.face;
  }
  std::cout << message;
}
