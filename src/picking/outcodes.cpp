#include "outcodes.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace organ_collision {
namespace {

constexpr std::size_t kBlock = FaceClusters::kBlockSize;

}  // namespace

void Outcodes::assign(const std::vector<HalfSpace>& half_spaces, const Eigen::Vector3d& origin,
                      const TriangleMesh& mesh) {
  mesh_ = &mesh;
  origin_ = origin;
  planes_.clear();
  for (const HalfSpace& half_space : half_spaces) {
    const Eigen::Vector3f normal = half_space.normal.cast<float>();
    planes_.push_back({normal.x(), normal.y(), normal.z(), static_cast<float>(half_space.offset)});
  }
  codes_.resize(mesh.vertex_count());
  block_is_done_.assign(mesh.clusters().block_count(), false);
}

void Outcodes::add_cluster(std::size_t cluster) {
  for (const std::uint32_t block : mesh_->clusters().blocks(cluster)) {
    if (block_is_done_[block]) continue;
    block_is_done_[block] = true;
    add_block(block);
  }
}

// Plain loops over the block's vertices, which the compiler makes vector instructions of. In 32
// bits, as GL clips: what that may misplace, the volume's growth covers.
void Outcodes::add_block(std::uint32_t block) {
  const std::vector<std::uint32_t>& order = mesh_->clusters().order();
  const float* const xyz = mesh_->vertices().data();
  const std::size_t begin = block * kBlock;
  const std::size_t count = std::min(kBlock, codes_.size() - begin);
  const auto vertex = [&](std::size_t i) { return order.empty() ? begin + i : order[begin + i]; };

  std::array<float, kBlock> x{}, y{}, z{};
  for (std::size_t i = 0; i < count; ++i) {
    const float* const point = xyz + 3 * vertex(i);
    x[i] = static_cast<float>(point[0] - origin_.x());
    y[i] = static_cast<float>(point[1] - origin_.y());
    z[i] = static_cast<float>(point[2] - origin_.z());
  }
  std::array<std::uint32_t, kBlock> codes{}, room_bits;
  std::array<float, kBlock> room;
  for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
    const Plane p = planes_[plane];
    for (std::size_t i = 0; i < kBlock; ++i) {
      room[i] = p.offset - (p.x * x[i] + p.y * y[i] + p.z * z[i]);
    }
    // Outside where the sign bit is set; compilers make no vector instructions of a comparison
    // here.
    std::memcpy(room_bits.data(), room.data(), sizeof(room));
    for (std::size_t i = 0; i < kBlock; ++i) codes[i] |= room_bits[i] >> 31 << plane;
  }
  for (std::size_t i = 0; i < count; ++i) codes_[vertex(i)] = static_cast<std::uint16_t>(codes[i]);
}

}  // namespace organ_collision
