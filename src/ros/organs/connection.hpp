#pragma once

#include <ros/datatypes.h>

#include <boost/weak_ptr.hpp>
#include <set>

namespace organ_collision {

/// The connection that a message came over, from one publisher to this node. Its header stands for
/// it: roscpp makes one for each connection, also for one within a process, and keeps it while the
/// connection is open. A publisher that is restarted connects anew, whatever its name.
using Connection = boost::weak_ptr<const ros::M_string>;

/// Connections that are known. A closed one is never taken for a new one, though its header's
/// address may be used again: the set is ordered by owner.
class ConnectionSet {
 public:
  bool contains(const Connection& connection) const { return connections_.count(connection) > 0; }
  /// Forgets those that are closed.
  void add(const Connection& connection);

 private:
  std::set<Connection> connections_;
};

}  // namespace organ_collision
