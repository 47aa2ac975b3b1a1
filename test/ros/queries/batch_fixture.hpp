#pragma once

#include <gtest/gtest.h>
#include <tf2_eigen/tf2_eigen.h>

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "ros/queries/batch_answers.hpp"

namespace organ_collision {

/// Batches over a sheet, which is 2 m wide and has 800 faces.
class BatchTest : public testing::Test {
 protected:
  BatchTest() {
    snapshot_.latest.mesh = std::make_shared<const TriangleMesh>(sheet());
    request_.mode = ContactArray::SWEPT;
    collision_.organ = snapshot_.latest.mesh.get();
    collision_.mode = QueryMode::kSwept;
    unanswered_.organ = "liver";
  }

  static TriangleMesh sheet() {
    constexpr std::uint32_t kCells = 20;
    std::vector<float> vertices;
    std::vector<std::uint32_t> faces;
    std::mt19937 random(11);
    std::uniform_real_distribution<float> height(-0.02f, 0.02f);
    for (std::uint32_t y = 0; y <= kCells; ++y) {
      for (std::uint32_t x = 0; x <= kCells; ++x) {
        const float step = 2.0f / kCells;
        vertices.insert(vertices.end(), {-1.0f + step * static_cast<float>(x),
                                         -1.0f + step * static_cast<float>(y), height(random)});
        if (x == kCells || y == kCells) continue;
        const std::uint32_t a = y * (kCells + 1) + x, b = a + kCells + 1;
        faces.insert(faces.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
    }
    return {vertices, faces};
  }

  /// Shafts that go from heights in [0.01, 0.3] to heights in [low, 0.3].
  void add_random_shafts(std::size_t count, double low) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.8, 0.8), from(0.05, 0.3), to(low, 0.3);
    for (std::size_t i = 0; i < count; ++i) {
      ToolMotion& motion = request_.motions.emplace_back();
      const auto point = [&](double z) {
        const double x = place(random), y = place(random);
        return tf2::toMsg(Eigen::Vector3d(x, y, z));
      };
      motion.trocar = motion.previous_trocar = point(1.0);
      motion.previous_tip = point(from(random));
      motion.tip = point(to(random));
      motion.radius = i % 7 == 3 ? 0.0 : 0.01;  // Some are illegal.
    }
  }

  CheckedBatch batch() const {
    return {request_, request_.motions.size(), snapshot_, collision_, unanswered_, most_bytes_};
  }

  QuerySnapshot snapshot_;
  QueryCollisionBatch::Request request_;
  CollisionRequest collision_;
  ContactArray unanswered_;
  std::size_t most_bytes_ = 1'000'000'000;
};

}  // namespace organ_collision
