// Asks which faces of `tissue` a shaft would touch if its tip came down onto the sheet, and how far
// it would then be from the sheet.
#include <organ_collision/QueryCollision.h>
#include <ros/ros.h>

#include <cstdio>

geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

constexpr char kUsage[] = R"(Usage: example_ask
Asks /organ_collision/query which faces of the organ `tissue` a moving shaft would touch.
Prints the status, the faces' numbers, and the distance between shaft and organ.
)";

int main(int argc, char** argv) {
  ros::V_string arguments;
  ros::removeROSArgs(argc, argv, arguments);
  if (arguments.size() > 1) {
    std::cout << kUsage;
    return arguments[1] == "--help" || arguments[1] == "-h" ? 0 : 2;
  }
  ros::init(argc, argv, "ask", ros::init_options::AnonymousName);
  ros::NodeHandle node;
  ros::service::waitForService("/organ_collision/query");

  organ_collision::QueryCollision call;
  auto query = node.serviceClient<organ_collision::QueryCollision>("/organ_collision/query", true);
  call.request.header.frame_id = "tissue";
  call.request.organ = "tissue";
  call.request.mode = organ_collision::ContactArray::SWEPT;
  call.request.motion.previous_trocar = call.request.motion.trocar = point(0.0, 0.0, 0.1);
  call.request.motion.previous_tip = point(0.02, 0.01, 0.02);
  call.request.motion.tip = point(0.02, 0.01, 0.003);
  call.request.motion.radius = 0.005;
  call.request.margin = 0.1;
  if (!query.call(call)) return 1;
  const organ_collision::ContactArray& answer = call.response.result;
  std::printf("status %d %s\n", answer.status, answer.message.c_str());
  for (const organ_collision::Contact& contact : answer.contacts) {
    std::printf("face %u, %.1f mm\n", contact.face, 1e3 * contact.depth);
  }
  if (answer.clearance.state == organ_collision::Clearance::KNOWN) {  // negative: the shaft touches
    std::printf("distance %.1f mm\n", 1e3 * answer.clearance.distance);
  }
}
