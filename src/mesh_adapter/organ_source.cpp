#include "organ_source.hpp"

#include <ros/console.h>

#include <stdexcept>
#include <utility>

#include "mesh_conversions.hpp"
#include "message_error.hpp"
#include "point_cloud_reader.hpp"
#include "ros/interface/conversions.hpp"
#include "ros/interface/held_message.hpp"
#include "ros/interface/legal_name.hpp"

namespace organ_collision {
namespace {

using topic_tools::ShapeShifter;

template <typename Message>
bool is(const ShapeShifter& message) {
  return message.getDataType() == ros::message_traits::datatype<Message>();
}

template <typename Message>
boost::shared_ptr<Message> instance(const ShapeShifter& message) {
  try {
    if (message.getMD5Sum() != ros::message_traits::md5sum<Message>()) {
      throw std::runtime_error("they have another md5sum");
    }
    return held_message<Message>(message);
  } catch (const std::exception& error) {
    throw MessageError("unreadable message", std::to_string(message.size()) + " bytes are no " +
                                                 message.getDataType() + ": " + error.what() +
                                                 "; must be one as this node was built with");
  }
}

[[noreturn]] void refuse_type(const ShapeShifter& message, const std::string& legal) {
  throw MessageError("wrong type",
                     "the messages are " + message.getDataType() + "; must be " + legal);
}

ros::Time stamp_or(ros::Time arrival, ros::Time stamp) { return stamp.isZero() ? arrival : stamp; }

}  // namespace

OrganSource::OrganSource(OrganParameters parameters, std::uint32_t last_topology,
                         OrganFeed::Outlet outlet)
    : parameters_(std::move(parameters)),
      feed_(parameters_.name, last_topology, std::move(outlet)) {}

void OrganSource::take_surface(const ShapeShifter& message, ros::Time arrival) {
  read(message);
  surface_.stamp = stamp_or(arrival, surface_.stamp);
  if (!surface_.empty()) surface_.frame = frame_or_given(surface_.frame);
  feed_.send(surface_);
  marker_reader_.keep();
}

void OrganSource::take_vertices(const ShapeShifter& message, ros::Time arrival) {
  if (!is<sensor_msgs::PointCloud2>(message)) refuse_type(message, "sensor_msgs/PointCloud2");
  const auto cloud = instance<sensor_msgs::PointCloud2>(message);
  std::vector<float> vertices;
  read_points(*cloud, vertices);
  feed_.send_vertices(frame_or_given(cloud->header.frame_id),
                      stamp_or(arrival, cloud->header.stamp), std::move(vertices));
}

void OrganSource::read(const ShapeShifter& message) {
  if (is<shape_msgs::Mesh>(message)) {
    convert(*instance<shape_msgs::Mesh>(message), surface_);
  } else if (is<pcl_msgs::PolygonMesh>(message)) {
    convert(*instance<pcl_msgs::PolygonMesh>(message), surface_);
  } else if (is<visualization_msgs::Marker>(message)) {
    marker_reader_.read(*instance<visualization_msgs::Marker>(message), surface_);
  } else {
    refuse_type(message, "shape_msgs/Mesh, pcl_msgs/PolygonMesh or visualization_msgs/Marker");
  }
}

/// The parameter `frame` overrides the frame that the messages name. The log says so once.
std::string OrganSource::frame_or_given(const std::string& named) {
  std::string frame = tf_frame(named);
  if (const std::string fault = name_fault(frame); !fault.empty()) {
    throw MessageError("illegal name", "the messages' frame " + fault);
  }
  const std::string& given = parameters_.frame;
  if (given.empty()) {
    if (!frame.empty()) return frame;
    throw MessageError("no frame", "the message names no frame; the organ '" + parameters_.name +
                                       "' must be given one, by the parameter 'frame'");
  }
  if (!frame.empty() && frame != given && !has_warned_) {
    has_warned_ = true;
    ROS_WARN("organ '%s': its messages name the frame '%s'; '%s' is taken, as the parameter says",
             parameters_.name.c_str(), frame.c_str(), given.c_str());
  }
  return given;
}

}  // namespace organ_collision
