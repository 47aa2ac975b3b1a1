#pragma once

#include <organ_collision/ContactArray.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <string>

#include "scene.hpp"

namespace organ_collision {

// What an answer about an organ tells, added to a picture in the organ's frame.

/// An answer has at most this many arrows: those of its deepest contacts.
inline constexpr std::size_t kMostArrows = 30;
/// At most this many near faces of an answer are drawn: the nearest ones.
inline constexpr std::size_t kMostNearFaces = 2000;
/// At most this many crossings of a tool and an organ are drawn: the first ones from the trocar.
inline constexpr std::size_t kMostCrossings = 100;

/// Adds the outlines of the regions, an arrow for each contact, along its normal, and the name of
/// each link that touches, at its deepest contact. The arrow ends at the contact's end point. The
/// name of a shaft is that of its tool. `share`: how visible arrows and names are, in [0, 1].
void add_contacts(const SceneOrgan& organ, const ContactArray& answer, double share,
                  visualization_msgs::MarkerArray& picture);

/// Adds the near faces, at their present place: the nearer, the more opaque. Adds a line between
/// the nearest points of tool and organ, and their distance as a text beside it, if it is known.
void add_surroundings(const SceneOrgan& organ, const ContactArray& answer,
                      visualization_msgs::MarkerArray& picture);

/// Adds a cone around the shaft for each place where its axis pierces the organ. The cones point
/// along the axis and stand outside the organ: where the axis enters, the cone ends at the surface,
/// and where it leaves, it begins there. `radius`: of the shaft [m].
void add_crossings(const SceneOrgan& organ, const ShaftAxis& axis, double radius,
                   const ToolPlacement& placement, visualization_msgs::MarkerArray& picture);

/// Adds a text above the organ: its name, a line for each tool, and the query time [s] if it is
/// above 0.
void add_status(const Scene& scene, const SceneOrgan& organ, double query_sec,
                visualization_msgs::MarkerArray& picture);

/// "probe: 3 contacts, 1.2 mm deep, tip inside"; "probe: no transform: ..." if there is no answer.
std::string status_line(const std::string& tool, const ContactArrayConstPtr& answer);

}  // namespace organ_collision
