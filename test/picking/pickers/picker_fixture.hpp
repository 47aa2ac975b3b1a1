#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "picking/pickers/picker.hpp"

namespace organ_collision {

/// Triangles that share no vertex.
class Soup {
 public:
  void add(const Triangle& face) {
    for (const Eigen::Vector3d& corner : face) {
      for (int k = 0; k < 3; ++k) vertices_.push_back(static_cast<float>(corner[k]));
    }
  }
  std::size_t size() const { return vertices_.size() / 9; }
  TriangleMesh mesh() const {
    std::vector<std::uint32_t> triangles(vertices_.size() / 3);
    for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = static_cast<std::uint32_t>(i);
    return {vertices_, triangles};
  }

 private:
  std::vector<float> vertices_;
};

inline std::vector<std::uint32_t> numbers(const std::vector<Candidate>& candidates) {
  std::vector<std::uint32_t> faces;
  for (const Candidate& candidate : candidates) faces.push_back(candidate.face);
  return faces;
}

/// Names the tests of a kind of picker.
inline std::string picker_name(const testing::TestParamInfo<PickerKind>& info) {
  switch (info.param) {
    case PickerKind::kFeedback:
      return "Feedback";
    case PickerKind::kSelect:
      return "Select";
    default:
      return "Cpu";
  }
}

/// A picker of each kind.
class PickerTest : public testing::TestWithParam<PickerKind> {
 protected:
  std::vector<Candidate> pick(const ViewingVolume& volume, const TriangleMesh& mesh) {
    std::vector<Candidate> candidates{{7, 0, 0}};  // must be replaced
    picker_->pick(volume, mesh, candidates);
    return candidates;
  }

  std::unique_ptr<Picker> picker_ = make_picker(GetParam());
};

}  // namespace organ_collision
