#include "echo.hpp"

#include <geometry_msgs/WrenchStamped.h>

#include <boost/make_shared.hpp>

namespace organ_collision::bench {

Echo::Echo(std::size_t tools) : tools_(tools) {
  node_.setCallbackQueue(&queue_);
  contacts_ = node_.advertise<ContactArray>("organ_collision/contacts", 100);
  vertices_ = node_.subscribe("organ_collision/organ_vertices", 100, &Echo::answer_shape, this,
                              ros::TransportHints().tcpNoDelay());
  wrenches_ = node_.advertise<geometry_msgs::WrenchStamped>("haptic_proxy/organ/tool0/wrench", 100);
  poses_ = node_.subscribe("hand/pose", 100, &Echo::answer_pose, this,
                           ros::TransportHints().tcpNoDelay());
  spinner_.start();
}

void Echo::answer_shape(const OrganVerticesConstPtr& shape) {
  for (std::size_t tool = 0; tool < tools_; ++tool) {
    const auto contacts = boost::make_shared<ContactArray>();
    contacts->header = shape->header;
    contacts->organ = shape->organ;
    contacts->mesh_stamp = shape->header.stamp;
    contacts_.publish(contacts);
  }
}

void Echo::answer_pose(const geometry_msgs::PoseStampedConstPtr& pose) {
  const auto wrench = boost::make_shared<geometry_msgs::WrenchStamped>();
  wrench->header = pose->header;
  wrench->wrench.force.z = 1.0;
  wrenches_.publish(wrench);
}

}  // namespace organ_collision::bench
