#pragma once

#include <organ_collision/ContactArray.h>
#include <organ_collision/ToolPlacement.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>

#include "marker_shapes.hpp"
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

/// An answer has at most this many arrows: those of its deepest contacts.
inline constexpr std::size_t kMostArrows = 30;

/// Adds an arrow for each contact, along its normal. The arrow ends at the contact's end point.
/// `share`: how visible the arrows are, in [0, 1].
void add_normals(const SceneOrgan& organ, const ContactArray& answer, double share,
                 MarkerSheet& sheet);

/// Adds the name of each link that touches, at its deepest contact. The name of a shaft is that of
/// its tool.
void add_names(const SceneOrgan& organ, const ContactArray& answer, double share,
               MarkerSheet& sheet);

/// At most this many near faces of an answer are drawn: the nearest ones.
inline constexpr std::size_t kMostNearFaces = 2000;

/// Adds the faces of the organ that the answer calls near, at their present place. The nearer a
/// face is, the more opaque it is.
void add_near_faces(const SceneOrgan& organ, const ContactArray& answer, MarkerSheet& sheet);

/// Adds the clearance of an answer: a line between the nearest points of tool and organ, and the
/// distance as a text beside it. Adds nothing if the distance is not known.
void add_clearance(const SceneOrgan& organ, const ContactArray& answer, MarkerSheet& sheet);

/// At most this many crossings of a tool and an organ are drawn: the first ones from the trocar.
inline constexpr std::size_t kMostCrossings = 100;

/// Adds an arrow head around the shaft for each place where its axis pierces the organ. The heads
/// point along the axis and stand outside the organ: where the axis enters, the head ends at the
/// surface, and where it leaves, it begins there. `radius`: of the shaft [m].
void add_crossings(const SceneOrgan& organ, const ShaftAxis& axis, double radius,
                   const ToolPlacement& placement, MarkerSheet& sheet);

/// "probe: 3 contacts, 1.2 mm deep, tip inside"; "probe: no transform: ..." if there is no answer.
std::string status_line(const std::string& tool, const ContactArrayConstPtr& answer);

/// Adds a text above the organ: its name, a line for each tool, and the query time [s] if it is
/// above 0.
void add_status(const Scene& scene, const SceneOrgan& organ, double query_sec, MarkerSheet& sheet);

}  // namespace organ_collision
