// A program without ROS that uses the installed libraries. Prints the faces that a swept shaft went
// through.
#include <iostream>
#include <organ_collision/query/collision_query.hpp>

int main() {
  // A sheet of two faces at z = 0.1 m, and one of a single face beyond the tool's reach.
  const organ_collision::TriangleMesh organ(
      {-0.05f, -0.05f, 0.1f,   0.05f, -0.05f, 0.1f,   0.05f, 0.05f, 0.1f,  -0.05f, 0.05f,
       0.1f,   -0.05f, -0.05f, 0.3f,  0.05f,  -0.05f, 0.3f,  0.00f, 0.05f, 0.3f},
      {0, 1, 2, 0, 2, 3, 4, 5, 6});

  // Within one step the tip moves from the right of the sheet to its left.
  organ_collision::CollisionRequest request;
  request.organ = &organ;
  request.radius = 0.005;
  request.mode = organ_collision::QueryMode::kSwept;
  request.path = {{0.0, {{0.0, 0.0, 0.0}, {0.15, 0.01, 0.15}}},
                  {1.0, {{0.0, 0.0, 0.0}, {-0.15, 0.01, 0.15}}}};

  organ_collision::CollisionQuery query;
  organ_collision::CollisionResult result;
  query.evaluate(request, result);
  for (const auto& contact : result.contacts) std::cout << contact.face << '\n';
}
