// A program without ROS that asks how far a shaft is from an organ, and whether it is inside.
#include <iostream>
#include <organ_collision/query/collision_query.hpp>

int main() {
  // A tetrahedron whose faces point outward.
  const organ_collision::TriangleMesh organ(
      {0.0f, 0.0f, 0.0f, 0.4f, 0.0f, 0.0f, 0.0f, 0.4f, 0.0f, 0.0f, 0.0f, 0.4f},
      {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});

  organ_collision::CollisionRequest request;
  request.organ = &organ;
  request.radius = 0.005;
  request.path = {{0.0, {{0.06, 0.05, 0.2}, {0.06, 0.07, 0.02}}}};

  // Once for each mesh, not for each shape:
  const organ_collision::SurfaceTopology surface_topology(organ.faces(), organ.vertices());

  request.margin = 0.05;  // [m] The clearance is measured up to this distance,
  request.max_near = 10;  // and so are the nearest faces, at most ten.
  request.placement = true;
  request.surface_topology = &surface_topology;

  organ_collision::CollisionQuery query;
  organ_collision::CollisionResult result;
  query.evaluate(request, result);
  if (result.clearance.state == organ_collision::ClearanceState::kKnown) {
    std::cout << "clearance " << result.clearance.distance << " m\n";
  }
  if (result.placement.tip == organ_collision::Side::kInside) std::cout << "inside\n";
  std::cout << result.near.size() << " near faces\n";
}
