#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <iomanip>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "picking/pickers/picker.hpp"

namespace organ_collision {

/// The numbers of the faces, which must be sorted, each once.
inline std::vector<std::uint32_t> numbers(const std::vector<Candidate>& candidates) {
  std::vector<std::uint32_t> faces;
  for (const Candidate& candidate : candidates) faces.push_back(candidate.face);
  EXPECT_TRUE(std::is_sorted(faces.begin(), faces.end()));
  EXPECT_EQ(std::adjacent_find(faces.begin(), faces.end()), faces.end());
  return faces;
}

/// [m] The largest coordinate of the mesh relative to a volume's origin.
inline double extent(const TriangleMesh& mesh, const Eigen::Vector3d& origin) {
  return OrganMotion(mesh).extent(origin);
}

/// A picker of each kind, on each platform of OpenGL.
class PickerTest : public testing::TestWithParam<PickerSettings> {
 public:
  static auto all() {
    return testing::Values(PickerSettings(PickerKind::kFeedback, GlPlatform::kOsmesa),
                           PickerSettings(PickerKind::kFeedback, GlPlatform::kEgl),
                           PickerSettings(PickerKind::kSelect, GlPlatform::kOsmesa),
                           PickerSettings(PickerKind::kSelect, GlPlatform::kEgl),
                           PickerSettings(PickerKind::kCpu));
  }
  static std::string name(const testing::TestParamInfo<PickerSettings>& info) {
    if (info.param.kind == PickerKind::kCpu) return "Cpu";
    return std::string(info.param.kind == PickerKind::kSelect ? "Select" : "Feedback") +
           (info.param.gl == GlPlatform::kEgl ? "OnEgl" : "OnOsmesa");
  }

 protected:
  std::vector<Candidate> pick(const ViewingVolume& volume, const TriangleMesh& mesh) {
    std::vector<Candidate> candidates{{7, 0, 0}};  // must be replaced
    picker_->pick(volume, mesh, candidates);
    return candidates;
  }
  std::vector<std::uint32_t> pick(const PartSweep& part, const OrganMotion& organ) {
    std::vector<Candidate> candidates{{7, 0, 0}};
    picker_->pick(part, organ, candidates);
    return numbers(candidates);
  }
  /// Expects that a face is picked.
  template <typename Case>
  void expect_picked(const ViewingVolume& volume, const TriangleMesh& face, const Case& what) {
    picker_->pick(volume, face, candidates_);
    if (candidates_.size() == 1) return;
    ADD_FAILURE() << std::setprecision(17) << what;
    if (++missed_ > 10) throw std::runtime_error("more misses are not shown");
  }

  std::unique_ptr<Picker> picker_ = make_picker(GetParam());

 private:
  std::vector<Candidate> candidates_;
  int missed_ = 0;
};

}  // namespace organ_collision
