#include "echo.hpp"

#include <boost/make_shared.hpp>

namespace organ_collision::bench {

Echo::Echo(std::size_t tools) : tools_(tools), node_("/organ_collision") {
  node_.setCallbackQueue(&queue_);
  contacts_ = node_.advertise<ContactArray>("contacts", 100);
  vertices_ = node_.subscribe("organ_vertices", 100, &Echo::answer, this,
                              ros::TransportHints().tcpNoDelay());
  spinner_.start();
}

void Echo::answer(const OrganVerticesConstPtr& shape) {
  for (std::size_t tool = 0; tool < tools_; ++tool) {
    const auto contacts = boost::make_shared<ContactArray>();
    contacts->header = shape->header;
    contacts->organ = shape->organ;
    contacts->mesh_stamp = shape->header.stamp;
    contacts_.publish(contacts);
  }
}

}  // namespace organ_collision::bench
