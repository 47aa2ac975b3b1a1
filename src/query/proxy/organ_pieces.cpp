#include "organ_pieces.hpp"

#include <utility>

#include "geometry/tool/rigid_motion.hpp"

namespace organ_collision {
namespace {

/// The shape at a time in [0, 1] between two shapes.
std::unique_ptr<const TriangleMesh> between(const TriangleMesh& before, const TriangleMesh& now,
                                            double time) {
  std::vector<float> vertices(now.vertices().size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const double from = before.vertices()[i], to = now.vertices()[i];
    vertices[i] = static_cast<float>(from + time * (to - from));
  }
  auto result = std::make_unique<TriangleMesh>(now);
  result->move_vertices(std::move(vertices));
  return result;
}

}  // namespace

OrganPieces::OrganPieces(const std::vector<OrganTick>& organs, int pieces)
    : organs_(organs), pieces_(pieces), between_(organs.size()) {
  for (std::size_t organ = 0; organ < organs.size(); ++organ) {
    const OrganTick& tick = organs[organ];
    if (!tick.before || tick.before == tick.now) continue;
    for (int end = 1; end < pieces; ++end) {
      between_[organ].push_back(
          between(*tick.before, *tick.now, static_cast<double>(end) / pieces));
    }
  }
}

std::vector<OrganTick> OrganPieces::piece(int piece) const {
  std::vector<OrganTick> result = organs_;
  for (std::size_t organ = 0; organ < result.size(); ++organ) {
    OrganTick& tick = result[organ];
    const RigidMotion frame(organs_[organ].T_before, organs_[organ].T_now);
    if (piece > 0) {
      tick.T_before = frame.at(static_cast<double>(piece) / pieces_);
      tick.before = between_[organ].empty() ? tick.now : between_[organ][piece - 1].get();
    }
    if (piece + 1 < pieces_) {
      tick.T_now = frame.at(static_cast<double>(piece + 1) / pieces_);
      if (!between_[organ].empty()) tick.now = between_[organ][piece].get();
    }
  }
  return result;
}

}  // namespace organ_collision
