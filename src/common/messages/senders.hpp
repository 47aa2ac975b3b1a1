#pragma once

#include <ros/datatypes.h>
#include <ros/time.h>

#include <array>
#include <boost/weak_ptr.hpp>
#include <cstddef>
#include <set>
#include <string>

namespace organ_collision {

/// The connection over which a message came from a publisher, identified by its header: roscpp
/// makes one for each connection, and keeps it while the connection is open. A restarted publisher
/// has a new connection. Connections are compared by the owner of the header, and not by its
/// address, which a later header may get again.
using Connection = boost::weak_ptr<const ros::M_string>;

/// The name of the node at the other end of a connection. Empty if the connection is closed, or if
/// the node gave no name.
std::string caller_of(const Connection& connection);

/// Over which connections the messages about an organ come. Meshes and vertices may come from
/// different nodes.
class Senders {
 public:
  /// [s] A sender that is silent for longer counts as gone when another one begins to move the same
  /// triangles. roscpp keeps the connection of a process that crashed until the master forgets it.
  static constexpr double kSilence = 0.5;

  enum Stream : std::size_t { kMeshes, kVertices };
  struct Change {
    /// The sender of the last message of this stream is gone: its connection is closed; or it is
    /// silent, and the new one, which has never sent before, moves the same triangles.
    bool has_restarted = false;
    std::string other = {};  ///< the name of the last sender if it is another one, and not gone
  };

  /// Takes the connection of the next message, which came at `now`. Returns what has changed since
  /// the last message of the same stream. If the sender of the other stream is gone, too, that
  /// stream begins anew: the sender that has restarted has new connections for both. `moves`: the
  /// message has the same triangles as the last one.
  Change note(Stream stream, const Connection& connection, ros::Time now, bool moves = true);

 private:
  struct Last {
    Connection connection = {};  ///< empty: no message came since the start or a restart
    ros::Time heard = {};
    std::set<Connection> known = {};  ///< over which messages have come
  };
  ros::Time last_heard(const std::string& caller) const;

  std::array<Last, 2> last_;  ///< of each stream
};

}  // namespace organ_collision
