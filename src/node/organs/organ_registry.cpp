#include "organ_registry.hpp"

#include <organ_collision/ContactArray.h>
#include <ros/console.h>

#include <iterator>

#include "common/messages/text.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {

namespace {

std::string quoted(const std::string& name) { return "'" + name + "'"; }

[[noreturn]] void refuse(const std::string& reason, const std::string& message) {
  throw Rejection(ContactArray::INVALID_REQUEST, reason, message);
}

/// The reason for each MeshError::Reason, at the index of its number.
constexpr const char* kReasons[] = {"wrong size",       "index out of range", "not finite",
                                    "too far",          "no triangles",       "too many faces",
                                    "too many vertices"};

/// The Rejection that an exception leads to. `named`: the message, as in "mesh of organ 'liver'".
Rejection rejection_of(const std::exception& error, const std::string& named) {
  if (const auto* rejection = dynamic_cast<const Rejection*>(&error)) return *rejection;
  if (const auto* fault = dynamic_cast<const MeshError*>(&error)) {
    return {ContactArray::INVALID_REQUEST, kReasons[static_cast<int>(fault->reason())],
            named + ": " + error.what()};
  }
  return {ContactArray::INVALID_REQUEST, "not made",  // Usually std::bad_alloc.
          named + " could not be made: " + error.what()};
}

template <typename Message>
SharedVertices vertices_of(const boost::shared_ptr<const Message>& message) {
  return {&message->vertices, [message](const void*) {}};
}

}  // namespace

bool is_removal(const OrganMesh& mesh) { return mesh.vertices.empty() && mesh.triangles.empty(); }

TriangleMesh OrganRegistry::build(const OrganMeshConstPtr& message) const {
  return {vertices_of(message), message->triangles, message->topology, limits_};
}

bool OrganRegistry::is_new(const OrganMesh& message, const Connection& connection) const {
  const auto organ = organs_.find(message.organ);
  if (organ == organs_.end()) return true;
  const TriangleMesh& latest = *organ->second.latest().mesh;
  if (message.topology != latest.topology()) return true;
  const auto known = connections_.find(message.organ);
  if (known != connections_.end() && known->second.count(connection) > 0) return false;
  return message.vertices.size() != latest.vertices().size() ||
         !latest.has_triangles(message.triangles);
}

OrganChange OrganRegistry::apply(const OrganMeshConstPtr& pointer, ros::Time now,
                                 const Connection& connection, const Build& built) {
  const OrganMesh& message = *pointer;
  if (message.organ.empty()) refuse("empty name", "organ mesh without a name in `organ`");
  check_name("organ", message.organ);
  if (is_removal(message)) {
    organs_.erase(message.organ);
    connections_.erase(message.organ);
    senders_.erase(message.organ);
    refusals_[message.organ].clear();
    return OrganChange::kRemoved;
  }
  const std::string named = "mesh of organ " + quoted(message.organ);
  try {
    const std::string frame = tf_frame(message.header.frame_id);
    if (frame.empty()) {
      refuse("empty frame", "header.frame_id is empty; must be the organ's TF frame");
    }
    check_name("header.frame_id", frame);
    check_stamp(message.header.stamp, now, named);
    const Build build_here = [&] { return build(pointer); };
    OrganChange change = set_shape(pointer, connection, frame, now, built ? built : build_here);
    if (note_sender(organs_.at(message.organ), Senders::kMeshes, connection, now)) {
      change = OrganChange::kSender;
    }
    std::set<Connection>& known = connections_[message.organ];
    for (auto entry = known.begin(); entry != known.end();) {
      entry = entry->expired() ? known.erase(entry) : std::next(entry);
    }
    known.insert(connection);
    refusals_.erase(message.organ);
    return change;
  } catch (const std::exception& error) {
    const Rejection rejection = rejection_of(error, named);
    refusals_[message.organ] = plain_text(rejection.what(), kLongestMessage);
    throw Rejection(rejection);
  }
}

OrganChange OrganRegistry::set_shape(const OrganMeshConstPtr& pointer, const Connection& connection,
                                     const std::string& frame, ros::Time now, const Build& built) {
  const OrganMesh& message = *pointer;
  const ros::Time stamp = message.header.stamp;
  const auto known = organs_.find(message.organ);
  if (known == organs_.end()) {
    DeformableOrgan organ(message.organ, frame, built(), stamp, now);
    const bool had_name = refusals_.count(message.organ) > 0;  // Or its meshes were refused.
    organ.begin(next_history(had_name ? "organ removed" : ""), true);
    organs_.emplace(message.organ, std::move(organ));
    return OrganChange::kShape;
  }
  DeformableOrgan& organ = known->second;
  OrganChange change = OrganChange::kShape;
  if (is_new(message, connection)) {
    if (message.topology == organ.latest().mesh->topology()) change = OrganChange::kOrgan;
    organ.replace(built(), stamp, now);
  } else if (organ.latest().mesh->has_triangles(message.triangles)) {
    organ.move(vertices_of(pointer), stamp, now);
  } else {
    refuse("same topology, other triangles",
           "organ " + quoted(message.organ) + " already has other triangles of topology " +
               std::to_string(message.topology) +
               "; for new triangles raise `topology`, or call the service reset first");
  }
  if (frame != organ.frame() && change == OrganChange::kShape) change = OrganChange::kFrame;
  organ.set_frame(frame);
  if (change == OrganChange::kFrame) organ.begin(next_history("frame changed"), true);
  if (change == OrganChange::kOrgan) organ.begin(next_history("organ removed"), true);
  return change;
}

OrganChange OrganRegistry::apply(const OrganVerticesConstPtr& pointer, ros::Time now,
                                 const Connection& connection) {
  const OrganVertices& message = *pointer;
  if (message.organ.empty()) refuse("empty name", "organ vertices without a name in `organ`");
  check_name("organ", message.organ);
  at(message.organ);
  DeformableOrgan& organ = organs_.at(message.organ);
  const std::string named = "vertices of organ " + quoted(message.organ);
  const std::string frame = tf_frame(message.header.frame_id);
  check_name("header.frame_id", frame);
  if (frame != organ.frame()) {
    refuse(frame.empty() ? "empty frame" : "other frame",
           named + ": header.frame_id is " + quoted(frame) + "; must be that of its mesh, " +
               quoted(organ.frame()));
  }
  check_stamp(message.header.stamp, now, named);
  const std::uint32_t topology = organ.latest().mesh->topology();
  if (message.topology != topology) {
    refuse("other topology", named + ": topology is " + std::to_string(message.topology) +
                                 "; the mesh has " + std::to_string(topology));
  }
  try {
    organ.move(vertices_of(pointer), message.header.stamp, now);
  } catch (const std::exception& error) {
    throw rejection_of(error, named);
  }
  return note_sender(organ, Senders::kVertices, connection, now) ? OrganChange::kSender
                                                                 : OrganChange::kShape;
}

/// Notes over which connection the organ's latest shape came. If its sender has restarted, the
/// organ begins a new history, and true is returned.
bool OrganRegistry::note_sender(DeformableOrgan& organ, Senders::Stream stream,
                                const Connection& connection, ros::Time now) {
  const bool moves = organ.latest().before != nullptr;
  const Senders::Change change = senders_[organ.name()].note(stream, connection, now, moves);
  if (!change.other.empty()) {
    ROS_WARN_THROTTLE(5.0, "organ '%s' has two senders on %s, '%s' and '%s': stop one of them",
                      organ.name().c_str(),
                      stream == Senders::kMeshes ? names::kOrganMesh : names::kOrganVertices,
                      change.other.c_str(), caller_of(connection).c_str());
  }
  if (change.has_restarted) organ.begin(next_history("sender restarted"), true);
  return change.has_restarted;
}

const DeformableOrgan& OrganRegistry::at(const std::string& name) const {
  const auto organ = organs_.find(name);
  if (organ != organs_.end()) return organ->second;
  if (refusals_.count(name) > 0) {
    const std::string refusal = last_refusal(name);
    throw Rejection(ContactArray::NO_MESH, "organ without mesh",
                    "organ " + quoted(name) +
                        (refusal.empty() ? " was removed; send a mesh on organ_mesh"
                                         : " has no mesh, because it was refused: " + refusal));
  }
  std::vector<std::string> names;
  for (const auto& [known, organ] : organs_) names.push_back(quoted(known));
  throw Rejection(ContactArray::UNKNOWN_ORGAN, "unknown organ",
                  "organ " + quoted(name) + " is unknown; " +
                      (names.empty() ? "no organ is known yet" : "known are " + listed(names)));
}

std::string OrganRegistry::last_refusal(const std::string& organ) const {
  const auto refusal = refusals_.find(organ);
  return refusal == refusals_.end() ? "" : refusal->second;
}

void OrganRegistry::begin_histories(const std::string& why, ros::Time now) {
  for (auto& [name, organ] : organs_) {
    organ.begin(next_history(why), false);
    organ.limit_received(now);
  }
  connections_.clear();
}

void OrganRegistry::check_stamp(ros::Time stamp, ros::Time now, const std::string& named) const {
  const std::string ahead = ahead_->fault(stamp, now);
  if (!ahead.empty()) refuse("stamp ahead", named + ": " + ahead);
}

}  // namespace organ_collision
