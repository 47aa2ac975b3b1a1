#include "organ_source.hpp"

#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <limits>
#include <stdexcept>
#include <utility>

#include "common/messages/checked_messages.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/text.hpp"

namespace organ_collision {
namespace {

using topic_tools::ShapeShifter;

/// The collision node decides how large an organ may be.
constexpr MeshLimits kNoLimits = {std::numeric_limits<std::uint32_t>::max() / 3};

template <typename Message>
boost::shared_ptr<Message> message_of(const std::string& organ, std::uint32_t topology,
                                      const std::string& frame, ros::Time stamp) {
  auto message = boost::make_shared<Message>();
  message->header.frame_id = frame;
  message->header.stamp = stamp;
  message->organ = organ;
  message->topology = topology;
  return message;
}

template <typename Message>
SharedVertices vertices_of(const boost::shared_ptr<Message>& message) {
  return {&message->vertices, [message](const void*) {}};
}

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
    throw MessageError("unreadable message", message.size(), " bytes are no ",
                       message.getDataType(), ": ", error.what(),
                       "; must be one as this node was built with");
  }
}

[[noreturn]] void refuse_type(const ShapeShifter& message, const std::string& legal) {
  throw MessageError("wrong type", "the messages are ", message.getDataType(), "; must be ", legal);
}

ros::Time stamp_or(ros::Time arrival, ros::Time stamp) { return stamp.isZero() ? arrival : stamp; }

}  // namespace

OrganSource::OrganSource(OrganParameters parameters, std::uint32_t last_topology,
                         Callbacks callbacks)
    : parameters_(std::move(parameters)),
      last_topology_(last_topology),
      callbacks_(std::move(callbacks)) {}

void OrganSource::take_surface(const ShapeShifter& message, ros::Time arrival) {
  ReceivedSurface surface = read(message);
  surface.stamp = stamp_or(arrival, surface.stamp);
  if (surface.empty()) {
    mesh_.reset();
    has_restarted_ = false;
    callbacks_.mesh(
        message_of<OrganMesh>(parameters_.name, last_topology_, surface.frame, surface.stamp));
  } else {
    surface.frame = frame_or_given(surface.frame);
    scale(surface.vertices);
    const bool has_known_triangles = mesh_ && !has_restarted_ &&
                                     surface.vertices.size() == mesh_->vertices().size() &&
                                     mesh_->has_triangles(surface.triangles);
    if (!has_known_triangles) {
      send_mesh(++last_topology_, std::move(surface));
    } else if (surface.frame != frame_) {
      send_mesh(mesh_->topology(), std::move(surface));
    } else {
      send_vertices(surface.frame, surface.stamp, std::move(surface.vertices));
    }
  }
  marker_reader_.keep();
}

void OrganSource::take_vertices(const ShapeShifter& message, ros::Time arrival) {
  if (!is<sensor_msgs::PointCloud2>(message)) refuse_type(message, "sensor_msgs/PointCloud2");
  const auto cloud = instance<sensor_msgs::PointCloud2>(message);
  std::vector<float> vertices = read_points(*cloud);
  scale(vertices);
  send_vertices(frame_or_given(cloud->header.frame_id), stamp_or(arrival, cloud->header.stamp),
                std::move(vertices));
}

/// Sends the message before it is checked here, so that the collision node need not wait.
void OrganSource::send_mesh(std::uint32_t topology, ReceivedSurface&& surface) {
  if (std::exchange(has_restarted_, false)) {
    callbacks_.mesh(
        message_of<OrganMesh>(parameters_.name, topology, surface.frame, surface.stamp));
  }
  const auto message =
      message_of<OrganMesh>(parameters_.name, topology, surface.frame, surface.stamp);
  message->vertices = std::move(surface.vertices);
  message->triangles = std::move(surface.triangles);
  callbacks_.mesh(message);
  try {
    mesh_.emplace(TriangleMesh(vertices_of(message), message->triangles, topology, kNoLimits));
    frame_ = surface.frame;
    stamp_ = surface.stamp;
  } catch (const MeshError&) {  // The collision node refuses and reports the mesh.
  }
}

void OrganSource::send_vertices(const std::string& frame, ros::Time stamp,
                                std::vector<float> vertices) {
  const std::string named =
      concatenate(vertices.size() / 3, " vertices for organ '", parameters_.name, "'");
  if (!mesh_) throw MessageError("no mesh", named, ", which has no mesh; must come after one");
  if (vertices.size() != mesh_->vertices().size()) {
    throw MessageError("wrong number of vertices", named, "; must be as many as its mesh has, ",
                       mesh_->vertex_count());
  }
  if (has_restarted_) {
    return send_mesh(++last_topology_, {frame, stamp, std::move(vertices), mesh()->triangles});
  }
  const auto message = message_of<OrganVertices>(parameters_.name, mesh_->topology(), frame, stamp);
  message->vertices = std::move(vertices);
  callbacks_.vertices(message);
  if (frame != frame_) return;
  try {
    mesh_->move_vertices(vertices_of(message));
    stamp_ = stamp;
  } catch (const MeshError&) {  // The collision node refuses and reports the vertices.
  }
}

OrganMeshPtr OrganSource::mesh() const {
  if (!mesh_) return nullptr;
  auto message = message_of<OrganMesh>(parameters_.name, mesh_->topology(), frame_, stamp_);
  message->vertices = mesh_->vertices();
  message->triangles.reserve(3 * mesh_->face_count());
  for (const FaceIndices& face : mesh_->faces()) {
    message->triangles.insert(message->triangles.end(), face.begin(), face.end());
  }
  return message;
}

ReceivedSurface OrganSource::read(const ShapeShifter& message) {
  if (is<shape_msgs::Mesh>(message)) return convert(*instance<shape_msgs::Mesh>(message));
  if (is<pcl_msgs::PolygonMesh>(message)) return convert(*instance<pcl_msgs::PolygonMesh>(message));
  if (is<visualization_msgs::Marker>(message)) {
    return marker_reader_.read(*instance<visualization_msgs::Marker>(message));
  }
  refuse_type(message, "shape_msgs/Mesh, pcl_msgs/PolygonMesh or visualization_msgs/Marker");
}

/// From the sender's unit to metres. Throws MessageError.
void OrganSource::scale(std::vector<float>& vertices) const {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = coordinate(parameters_.scale * vertices[i], i / 3, i % 3);
  }
}

/// The parameter `frame` overrides the frame that the messages name. The log says so once.
std::string OrganSource::frame_or_given(const std::string& named) {
  std::string frame = tf_frame(named);
  if (const std::string fault = name_fault(frame); !fault.empty()) {
    throw MessageError("illegal name", "the messages' frame ", fault);
  }
  const std::string& given = parameters_.frame;
  if (given.empty()) {
    if (!frame.empty()) return frame;
    throw MessageError("no frame", "the message names no frame; the organ '", parameters_.name,
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
