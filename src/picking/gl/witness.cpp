#include "witness.hpp"

#include <vector>

#include "feedback.hpp"
#include "picking/volumes/middle_face.hpp"

namespace organ_collision {
namespace {

bool is_blind(GlContext& context) {
  if (!context.is_current()) return true;
  const ViewingVolume box =
      ViewingVolume::orthographic({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                   Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
  DrawnFaces face;
  face.add(middle_face(box), kWitness);
  std::vector<float> buffer(100);
  return draw_feedback(context, box, face, buffer) == 0;
}

}  // namespace

void fail_if_blind(GlContext& context) {
  if (!is_blind(context)) return;
  context.fail(
      "OpenGL does not return a face that is in view, so its answer means nothing: its context or "
      "framebuffer was lost or taken; the next query gets a new one");
}

}  // namespace organ_collision
