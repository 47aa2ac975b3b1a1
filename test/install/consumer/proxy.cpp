// A program without ROS that pushes a hand into an organ. Prints how far the proxy pulls it back.
#include <iostream>
#include <organ_collision/query/haptic_proxy.hpp>

int main() {
  organ_collision::ProxyOrgan organ;
  organ.name = "sheet";
  organ.shape = std::make_shared<organ_collision::TriangleMesh>(
      std::vector<float>{-0.05f, -0.05f, 0.0f, 0.05f, -0.05f, 0.0f, 0.05f, 0.05f, 0.0f, -0.05f,
                         0.05f, 0.0f},
      std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});

  organ_collision::ProxyTool tool;  // A shaft through a trocar.
  tool.radius = 0.003;
  organ_collision::HapticProxy proxy(tool, {});
  for (const double height : {0.02, 0.01, 0.0, -0.01}) {
    organ_collision::ToolPose hand;
    hand.axis = {{0.01, 0.0, 0.2}, {0.01, 0.0, height}};
    const auto& answer = proxy.follow(hand, {organ});
    // [mm] Times the stiffness, this is the force on the hand.
    std::cout << 1e3 * answer.pull.z() << '\n';
  }
}
