#pragma once

#include <organ_collision/ContactArray.h>
#include <organ_collision/VertexForces.h>

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "organ_collision/geometry/organ/triangle_mesh.hpp"

/// The names of forces in the ROS graph.
namespace organ_collision::names {

/// The topics of an organ and a tool, below ~ORGAN/TOOL.
inline constexpr char kWrench[] = "wrench";
inline constexpr char kVertexForces[] = "vertex_forces";

/// Names of parameters.
inline constexpr char kStiffness[] = "stiffness";
inline constexpr char kMaxForce[] = "max_force";

}  // namespace organ_collision::names

namespace organ_collision {

/// A force of the tissue on the tool, at a point of a face. In the organ's frame unless noted.
struct FaceForce {
  std::uint32_t face;                       ///< Contact.face
  std::int32_t link;                        ///< Contact.link
  FaceIndices vertices;                     ///< the indices of the face's corners
  Eigen::Vector3d barycentric;              ///< of the point, in the order of `vertices`
  Eigen::Vector3d place;                    ///< [m] the point, at the end of the step
  Eigen::Vector3d force = {0.0, 0.0, 0.0};  ///< [N]
};

/// The factor in (0, 1] that reduces a force [N] or a torque [N m] to the magnitude `most` > 0, if
/// it is larger.
double share_within_limit(const Eigen::Vector3d& load, double most);

/// The forces of the tool on the tissue's vertices. Minus each face's force is divided among the
/// face's vertices by the barycentric coordinates of its point. Therefore the sum of the
/// vertices' forces is minus that of the faces' forces, and the same holds for their torques, up to
/// rounding. Vertices without a force are left out. `contacts`: the answer that the forces are
/// from.
VertexForces vertex_forces(const ContactArray& contacts, const std::vector<FaceForce>& forces);

/// The name of a tool in the ROS graph: `_` replaces each character other than ASCII letters,
/// digits and `_`. A name that does not begin with a letter is prefixed with "tool_".
std::string tool_graph_name(const std::string& tool);

/// What --help says of these names.
inline constexpr char kPairNamesHelp[] =
    "TOOL and ORGAN are the names of a tool and an organ, in which _ replaces each character that "
    "is no letter, digit or _. A name that does not begin with a letter gets the prefix tool_ or "
    "organ_.";

/// Gives each pair of organ and tool its name in the ROS graph.
class PairNames {
 public:
  /// "ORGAN/TOOL", a relative name. Both names are made as tool_graph_name() does it, but the
  /// prefix of the organ's name is "organ_". Throws Rejection if another pair already has the name.
  std::string of(const std::string& organ, const std::string& tool);

 private:
  std::map<std::string, std::pair<std::string, std::string>> owners_;  ///< pairs, by their names
};

}  // namespace organ_collision
