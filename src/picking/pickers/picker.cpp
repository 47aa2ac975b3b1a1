#include "picker.hpp"

#include <algorithm>
#include <stdexcept>

#include "picking/culling/outcodes.hpp"

namespace organ_collision {

void sort_by_face(std::vector<Candidate>& candidates) {
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.face < b.face; });
}

namespace {

/// The candidate of a face whose part in the volume, in shifted coordinates, is `polygon`.
Candidate candidate(std::uint32_t face, const Region& polygon, const ViewingVolume& volume) {
  double nearest = 1.0, farthest = 0.0;  // window depths
  for (const Eigen::Vector3d& corner : polygon) {
    const Eigen::Vector4d clip = volume.clip() * corner.homogeneous();
    const double depth = 0.5 * (clip.z() / clip.w() + 1.0);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  return {face, volume.view_depth(nearest), volume.view_depth(farthest)};
}

/// Picks without OpenGL. For a part, the candidates are all faces that outcodes do not reject. GL
/// would leave fewer of them, but exact distances decide in any case. For a given volume, the faces
/// are clipped in double precision.
class CpuPicker final : public Picker {
 public:
  void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
            std::vector<Candidate>& candidates) override {
    candidates.clear();
    outcodes_.assign(volume, OrganMotion(mesh));
    outcodes_.for_each_face([&](const FaceClusters::Face& face) {
      ++counts_.undrawn;
      const Region part = clipped(shifted(mesh.triangle(face.corners), volume.origin()), volume);
      if (!part.empty()) candidates.push_back(candidate(face.number, part, volume));
    });
    sort_by_face(candidates);
  }

  void pick(const PartSweep& part, const OrganMotion& organ,
            std::vector<Candidate>& candidates) override {
    candidates.clear();
    outcodes_.assign(part.volume({}), organ);
    outcodes_.for_each_face([&](const FaceClusters::Face& face) {
      candidates.push_back({face.number, 0.0, 0.0});
    });
    counts_.undrawn += candidates.size();
    sort_by_face(candidates);
  }

  void find_regions(const ViewingVolume& volume, const TriangleMesh& mesh,
                    const std::vector<Candidate>& candidates,
                    std::vector<Region>& regions) override {
    regions.clear();
    for (const Candidate& candidate : candidates) {
      regions.push_back(region_of(mesh.triangle(candidate.face), volume));
    }
  }

  void release() override {}
  const std::string& gl_version() const override { return gl_version_; }

 private:
  Outcodes outcodes_;
  const std::string gl_version_ = "none (picker: cpu)";
};

// A box of 2 m by 2 m by 2 m, of which a user plane cuts off one edge.
ViewingVolume check_volume() {
  ViewingVolume volume =
      ViewingVolume::orthographic({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                   Eigen::Matrix3d::Identity(), -1, 1, -1, 1, -1, 1});
  volume.add_user_plane({Eigen::Vector3d(1, 1, 0).normalized(), 0.5});
  return volume;
}

// Face 0 passes beside a corner of the box, face 1 is at the edge that is cut off, face 2 is in
// view.
TriangleMesh check_mesh() {
  return {{-3,    0,    0, 0,     -3,   0,    -3,    -3,   1,     //
           0.9F,  0.6F, 0, 0.6F,  0.9F, 0,    0.9F,  0.9F, 0.5F,  //
           -0.5F, 3,    0, -0.5F, -3,   0.5F, 0.25F, -3,   0},
          {0, 1, 2, 3, 4, 5, 6, 7, 8}};
}

/// The value of the choice with this name. `setting`: what is chosen.
template <typename Choices>
auto named(const std::string& setting, const Choices& choices, const std::string& name) {
  std::string legal;
  for (const auto& choice : choices) {
    if (name == choice.name) return choice.value;
    legal += (legal.empty() ? "\"" : ", \"") + std::string(choice.name) + "\"";
  }
  throw std::invalid_argument(setting + " is \"" + name + "\": must be one of " + legal);
}

}  // namespace

std::unique_ptr<Picker> make_picker(const PickerSettings& settings) {
  std::unique_ptr<Picker> picker;
  if (settings.kind == PickerKind::kCpu) {
    picker = std::make_unique<CpuPicker>();
  } else {
    picker = new_gl_picker(settings);
  }
  std::vector<Candidate> candidates;
  picker->pick(check_volume(), check_mesh(), candidates);
  if (candidates.size() == 1 && candidates[0].face == 2) {
    picker->release();
    return picker;
  }
  std::string picked;
  for (const Candidate& candidate : candidates) picked += " " + std::to_string(candidate.face);
  throw GlError(
      "OpenGL picking does not work here: of three faces only number 2 is in view, picked"
      " were:" +
      (picked.empty() ? " none" : picked) + "; OpenGL version: " + picker->gl_version() +
      "; install another version of Mesa, or pick without OpenGL (picker: cpu)");
}

std::vector<PickerKind> picker_kinds() {
  std::vector<PickerKind> kinds;
  for (const PickerName& picker : kPickerNames) kinds.push_back(picker.value);
  return kinds;
}

PickerKind picker_kind(const std::string& name) { return named("picker", kPickerNames, name); }

GlPlatform gl_platform(const std::string& name) { return named("gl", kGlPlatformNames, name); }

}  // namespace organ_collision
