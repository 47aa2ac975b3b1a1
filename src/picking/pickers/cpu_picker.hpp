#pragma once

#include <string>
#include <vector>

#include "picker.hpp"
#include "picking/culling/outcodes.hpp"

namespace organ_collision {

/// Picks without OpenGL. The candidates of a part are the faces that outcodes do not reject: some
/// more than GL leaves of them, and exact distances decide in any case. Faces in a volume are
/// clipped in double precision.
class CpuPicker : public Picker {
 public:
  void pick(const ViewingVolume& volume, const TriangleMesh& mesh,
            std::vector<Candidate>& candidates) override;
  void pick(const PartSweep& part, const OrganMotion& organ,
            std::vector<Candidate>& candidates) override;
  void release() override {}
  const std::string& gl_version() const override;

 private:
  Outcodes outcodes_;
};

}  // namespace organ_collision
