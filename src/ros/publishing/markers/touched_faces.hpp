#pragma once

#include <organ_collision/ContactArray.h>

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>

#include "marker_sheet.hpp"
#include "scene.hpp"

namespace organ_collision {

/// Remembers for a short while which faces were touched, and how deeply.
class TouchedFaces {
 public:
  /// Notes the contacts of an answer about the organ's present triangles. What was noted of its
  /// earlier triangles is forgotten.
  void add(const SceneOrgan& organ, const ContactArray& answer, SteadyTime time);
  /// Adds the organ's touched faces, coloured by depth, at their present place. Faces fade that
  /// were last touched before `scene.time`.
  void add_markers(const Scene& scene, const SceneOrgan& organ, MarkerSheet& sheet);
  /// Forgets the organs that the scene does not have.
  void forget_others(const Scene& scene);

 private:
  struct Touch {
    SteadyTime time;
    double depth;  ///< [m]
  };
  struct Organ {
    SharedFaces faces;
    std::unordered_map<std::uint32_t, Touch> touches;
  };
  std::map<std::string, Organ> organs_;
};

/// Adds the outlines of the regions of an answer.
void add_regions(const SceneOrgan& organ, const ContactArray& answer, MarkerSheet& sheet);

}  // namespace organ_collision
