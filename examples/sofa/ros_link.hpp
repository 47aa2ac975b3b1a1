#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// A body of the scene whose frame is sent.
struct ToolFrame {
  std::string name;                   ///< of the TF frame
  std::array<double, 3> position;     ///< [m]
  std::array<double, 4> orientation;  ///< quaternion x y z w
};

/// A surface of the scene, which is an organ with the same name.
struct OrganSurface {
  std::string name;
  std::vector<float> vertices;           ///< [m] x y z of each vertex
  std::vector<std::uint32_t> triangles;  ///< three vertex numbers each
};

/// The force on a vertex of a surface.
struct VertexForce {
  std::size_t organ;  ///< the surface's place in the list that was sent
  std::uint32_t vertex;
  std::array<double, 3> force;  ///< [N]
};

/// The side of the component that knows ROS. This header has neither SOFA nor ROS in it, because
/// SOFA's headers need C++20, in which Debian's headers of ROS cannot be compiled. All positions
/// are in the frame `world`.
class RosLink {
 public:
  /// `tools`: the tools of haptic_proxy whose forces move the organs. `lockstep_sec`: how long a
  /// step waits for the forces on the shapes that it sent. Throws std::runtime_error if there is no
  /// ROS master.
  RosLink(const std::vector<std::string>& tools, double lockstep_sec);
  ~RosLink();

  /// Sends all frames and all surfaces with one stamp: a whole mesh if triangles are new, otherwise
  /// the vertices.
  void send(const std::vector<ToolFrame>& frames, const std::vector<OrganSurface>& organs);

  /// The forces on the shapes that were sent last. Without them, haptic_proxy is gone.
  std::vector<VertexForce> wait_for_forces();

 private:
  struct State;
  std::unique_ptr<State> state_;
};
