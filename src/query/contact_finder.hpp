#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact_refiner.hpp"
#include "geometry/distance/surface_touch.hpp"
#include "organ_collision/query/contact.hpp"
#include "picking/pickers/picker.hpp"
#include "step.hpp"

namespace organ_collision {

/// Finds the contacts of a step: part by part, and span by span of neighbouring legs, GL picks the
/// faces that may touch, and exact distances decide leg by leg. Keeps its memory.
class ContactFinder {
 public:
  /// `picker` must outlive it.
  explicit ContactFinder(Picker& picker) : picker_(picker) {}

  /// Adds the contacts of all parts of the tool. A face may come several times for a link, once for
  /// each of its parts that touch it in the leg of its first touch, or earlier ones. Throws GlError
  /// if GL did not work.
  void find(const Step& step, std::vector<FaceContact>& contacts);

 private:
  /// A shaft, or a part of a link.
  struct Part {
    const LinkPart* shape = nullptr;  ///< null: the shaft
    std::size_t link = 0;

    bool is_surface() const { return shape && shape->surface; }
    /// A surface is as many convex parts as it has triangles.
    std::size_t convex_count() const { return is_surface() ? shape->surface->faces().size() : 1; }
  };
  /// A face that the part may touch, from a leg on.
  struct OpenFace {
    std::uint32_t face;
    std::size_t leg;
    /// Unit, from the part to the face, where they are near; zero: not known.
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  void touch_shaft(const Step& step, std::vector<FaceContact>& contacts);
  void touch_link(const Step& step, std::size_t link, std::vector<FaceContact>& contacts);
  void touch_part(const Step& step, const LegSpan& span, const Part& part,
                  std::vector<FaceContact>& contacts);
  void pick(const Step& step, const LegSpan& span, const Part& part);
  void find_first_legs(const Step& step, const LegSpan& span, const Part& part);
  void touch_on_leg(const Step& step, std::size_t leg, const Part& part,
                    std::vector<FaceContact>& contacts);
  void find_touches(const PartLeg& part, const LinkPart* shape, double radius);
  bool is_open(std::uint32_t face, std::size_t leg) const;
  void open_all(const std::vector<FaceContact>& touched, std::size_t begin);

  Picker& picker_;
  WorkBudget budget_;  ///< of the present step
  std::vector<Candidate> candidates_;
  std::vector<OpenFace> open_faces_;
  std::vector<FaceTouch> touches_;
  /// For each face the leg in which the present link first touched it, counted from one; zero: none
  /// so far.
  std::vector<std::uint32_t> touched_leg_;
};

}  // namespace organ_collision
