#include "senders.hpp"

#include <algorithm>
#include <iterator>

#include "text.hpp"

namespace organ_collision {
namespace {

bool is_same(const Connection& a, const Connection& b) {
  return !a.owner_before(b) && !b.owner_before(a);
}

}  // namespace

std::string caller_of(const Connection& connection) {
  const auto header = connection.lock();
  if (!header || header->count("callerid") == 0) return "";
  return plain_text(header->at("callerid"), kLongestName);
}

Senders::Change Senders::note(Stream stream, const Connection& connection, ros::Time now,
                              bool moves) {
  Last& last = last_.at(stream);
  for (auto known = last.known.begin(); known != last.known.end();) {
    known = known->expired() ? last.known.erase(known) : std::next(known);
  }
  const bool is_first = last.known.insert(connection).second;
  Change change;
  if (!is_same(last.connection, {}) && !is_same(last.connection, connection)) {
    const bool is_silent = now.toSec() - last_heard(caller_of(last.connection)).toSec() > kSilence;
    change.has_restarted = last.connection.expired() || (is_first && is_silent && moves);
    if (!change.has_restarted) change.other = caller_of(last.connection);
  }
  if (change.has_restarted) {
    const std::string gone = caller_of(last.connection);
    for (Last& of_stream : last_) {
      Connection& other = of_stream.connection;
      if (other.expired() || caller_of(other) == gone) other = {};
    }
  }
  last.connection = connection;
  last.heard = now;
  return change;
}

/// When the last message of a node came, of either stream.
ros::Time Senders::last_heard(const std::string& caller) const {
  ros::Time latest;
  for (const Last& of_stream : last_) {
    if (caller_of(of_stream.connection) == caller) latest = std::max(latest, of_stream.heard);
  }
  return latest;
}

}  // namespace organ_collision
