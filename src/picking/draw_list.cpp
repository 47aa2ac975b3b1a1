#include "draw_list.hpp"

#include <cstddef>

namespace organ_collision {
namespace {

// The half-spaces of a volume, ready to test many points.
class Outcode {
 public:
  explicit Outcode(const ViewingVolume& volume)
      : origin_(volume.origin()), count_(volume.half_space_count()) {
    for (std::size_t i = 0; i < count_; ++i) half_spaces_[i] = volume.half_space(i);
  }

  // One bit for each half-space that `point`, in the organ's frame, is outside of.
  std::uint32_t operator()(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d shifted = point - origin_;
    std::uint32_t code = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      code |= std::uint32_t{half_spaces_[i].normal.dot(shifted) > half_spaces_[i].offset} << i;
    }
    return code;
  }

 private:
  Eigen::Vector3d origin_;
  std::size_t count_;
  std::array<HalfSpace, 6 + ViewingVolume::kMaxUserPlanes> half_spaces_;
};

Triangle shifted(const Triangle& face, const Eigen::Vector3d& origin) {
  return {face[0] - origin, face[1] - origin, face[2] - origin};
}

}  // namespace

std::uint32_t face_number(float lower, float upper) {
  return static_cast<std::uint32_t>(lower) | static_cast<std::uint32_t>(upper) << 16;
}

void DrawList::assign(const ViewingVolume& volume, const TriangleMesh& mesh) {
  const Outcode outcode(volume);
  outcodes_.resize(mesh.vertex_count());
  for (std::size_t i = 0; i < outcodes_.size(); ++i) outcodes_[i] = outcode(mesh.vertex(i));

  vertices_.clear();
  for (std::uint32_t i = 0; i < mesh.face_count(); ++i) {
    const FaceIndices& face = mesh.faces()[i];
    if ((outcodes_[face[0]] & outcodes_[face[1]] & outcodes_[face[2]]) != 0) continue;
    add(shifted(mesh.triangle(i), volume.origin()), i);
  }
}

void DrawList::assign(const ViewingVolume& volume, const TriangleMesh& mesh,
                      const std::vector<std::uint32_t>& faces) {
  vertices_.clear();
  for (std::uint32_t i = 0; i < faces.size(); ++i) {
    add(shifted(mesh.triangle(faces[i]), volume.origin()), i);
  }
}

void DrawList::add(const Triangle& face, std::uint32_t number) {
  const std::array<float, 2> halves = {static_cast<float>(number & 0xffff),
                                       static_cast<float>(number >> 16)};
  constexpr std::array<std::array<float, 2>, 3> kBarycentric = {{{0, 0}, {1, 0}, {0, 1}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f position = face[i].cast<float>();
    vertices_.push_back({{position.x(), position.y(), position.z()}, kBarycentric[i], halves});
  }
}

}  // namespace organ_collision
