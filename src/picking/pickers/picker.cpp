#include "picker.hpp"

#include "feedback_picker.hpp"
#include "select_picker.hpp"

namespace organ_collision {
namespace {

std::unique_ptr<Picker> new_picker(PickerKind kind, GlContext& context) {
  if (kind == PickerKind::kSelect) return std::make_unique<SelectPicker>(context);
  return std::make_unique<FeedbackPicker>(context);
}

// A box of 2 m by 2 m by 2 m. A user plane cuts off one edge.
ViewingVolume check_volume() {
  ViewingVolume volume =
      ViewingVolume::orthographic({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                   Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
  volume.add_user_plane({Eigen::Vector3d(1, 1, 0).normalized(), 0.5});
  return volume;
}

// Face 0 passes by a corner of the box, face 1 lies at the edge that is cut off, face 2 is in view.
TriangleMesh check_mesh() {
  return {{-3,    0,    0, 0,     -3,   0,    -3,    -3,   1,     //
           0.9F,  0.6F, 0, 0.6F,  0.9F, 0,    0.9F,  0.9F, 0.5F,  //
           -0.5F, 3,    0, -0.5F, -3,   0.5F, 0.25F, -3,   0},
          {0, 1, 2, 3, 4, 5, 6, 7, 8}};
}

void check_picker(Picker& picker, const std::string& version) {
  std::vector<Candidate> candidates;
  picker.pick(check_volume(), check_mesh(), candidates);
  if (candidates.size() == 1 && candidates[0].face == 2) return;
  std::string picked;
  for (const Candidate& candidate : candidates) picked += " " + std::to_string(candidate.face);
  throw GlError(
      "OpenGL picking does not work here: of three faces only number 2 is in view, picked"
      " were:" +
      (picked.empty() ? " none" : picked) + "; OpenGL version: " + version +
      "; install libosmesa6 of Mesa 20 to 25.0");
}

}  // namespace

PickerKind picker_kind(const std::string& name) {
  if (name == "feedback") return PickerKind::kFeedback;
  if (name == "select") return PickerKind::kSelect;
  throw std::invalid_argument("picker is \"" + name + "\": must be \"feedback\" or \"select\"");
}

std::unique_ptr<Picker> make_picker(PickerKind kind, GlContext& context) {
  std::unique_ptr<Picker> picker = new_picker(kind, context);
  check_picker(*picker, context.version());
  return picker;
}

}  // namespace organ_collision
