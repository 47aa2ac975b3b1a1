#pragma once

#include <ros/datatypes.h>

#include <boost/weak_ptr.hpp>
#include <set>

namespace organ_collision {

/// The connection over which a message came from a publisher to this node, identified by its
/// header: roscpp makes one header for each connection, also within a process, and keeps it while
/// the connection is open. A restarted publisher has a new connection, even under the same name.
using Connection = boost::weak_ptr<const ros::M_string>;

/// A set of connections, ordered by the owner of the header. Therefore a new connection is never
/// mistaken for a closed one whose header had the same address.
class ConnectionSet {
 public:
  bool contains(const Connection& connection) const { return connections_.count(connection) > 0; }
  /// Also drops the connections that are closed.
  void add(const Connection& connection);

 private:
  std::set<Connection> connections_;
};

}  // namespace organ_collision
