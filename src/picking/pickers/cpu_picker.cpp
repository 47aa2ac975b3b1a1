#include <algorithm>

#include "picker.hpp"
#include "picking/culling/outcodes.hpp"

namespace organ_collision {
namespace {

/// The candidate of a face whose part in the volume, in shifted coordinates, is `polygon`.
Candidate candidate(std::uint32_t face, const ConvexPolygon& polygon, const ViewingVolume& volume) {
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
      const ConvexPolygon part =
          clipped(shifted(mesh.triangle(face.corners), volume.origin()), volume);
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

}  // namespace

std::unique_ptr<Picker> new_cpu_picker() { return std::make_unique<CpuPicker>(); }

}  // namespace organ_collision
