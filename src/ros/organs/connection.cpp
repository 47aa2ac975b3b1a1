#include "connection.hpp"

#include <iterator>

namespace organ_collision {

void ConnectionSet::add(const Connection& connection) {
  for (auto known = connections_.begin(); known != connections_.end();) {
    known = known->expired() ? connections_.erase(known) : std::next(known);
  }
  connections_.insert(connection);
}

}  // namespace organ_collision
