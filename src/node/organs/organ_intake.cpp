#include "organ_intake.hpp"

#include <organ_collision/ContactArray.h>
#include <ros/console.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <exception>
#include <memory>
#include <utility>

#include "common/threads/queues.hpp"
#include "organ_collision/ros/names.hpp"

namespace organ_collision {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// [messages] The queue of each topic, for all organs together. If more messages wait while the
/// node's thread is busy, roscpp drops the oldest.
constexpr std::uint32_t kOrganQueue = 100;

/// During this time after the start, vertices without a mesh of their organ are no failure.
constexpr std::chrono::seconds kSendersStart(2);

bool is_large(const OrganMesh& mesh) {
  return std::max(mesh.triangles.size(), mesh.vertices.size()) > 3 * OrganIntake::kLarge;
}

bool is_ready(const OrganMessage& message) {
  return !message.built.valid() ||
         message.built.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Whether the organ ends in the same state if `message` is dropped, and `next` follows. A removal
/// before a mesh stays: without the removal, the organ might refuse the mesh.
bool is_replaced(const OrganMessage& message, const OrganMessage& next) {
  if (message.vertices) return true;
  return next.mesh && (!is_removal(*message.mesh) || is_removal(*next.mesh));
}

}  // namespace

void OrganIntake::subscribe(ros::NodeHandle private_node) {
  using MeshEvent = ros::MessageEvent<const OrganMesh>;
  using VerticesEvent = ros::MessageEvent<const OrganVertices>;
  const auto on_mesh = [this](const MeshEvent& event) {
    const OrganMeshConstPtr& message = event.getConstMessage();
    counts_.lost += lost_before(meshes_, event.getPublisherName(), message->header.seq);
    take_mesh(message, event.getConnectionHeaderPtr());
  };
  const auto on_vertices = [this](const VerticesEvent& event) {
    const OrganVerticesConstPtr& message = event.getConstMessage();
    counts_.lost += lost_before(vertices_, event.getPublisherName(), message->header.seq);
    take_vertices(message, event.getConnectionHeaderPtr());
  };
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  subscribers_ = {private_node.subscribe<OrganMesh, const MeshEvent&>(
                      names::kOrganMesh, kOrganQueue, on_mesh, {}, hints),
                  private_node.subscribe<OrganVertices, const VerticesEvent&>(
                      names::kOrganVertices, kOrganQueue, on_vertices, {}, hints)};
  services_ = {private_node.advertiseService(names::kRemoveOrgan, &OrganIntake::on_remove, this),
               on_queue(private_node, threads_->inspector)
                   .advertiseService(names::kListOrgans, &OrganIntake::on_list, this)};
}

void OrganIntake::take_mesh(const OrganMeshConstPtr& message, const Connection& connection) {
  add({message, connection});
}

void OrganIntake::take_vertices(const OrganVerticesConstPtr& message,
                                const Connection& connection) {
  add({nullptr, connection, {}, message});
}

void OrganIntake::add(OrganMessage message) {
  std::deque<OrganMessage>& waiting = messages_[message.organ()];
  const bool is_first_built = !waiting.empty() && waiting.front().built.valid();
  while (is_first_built && waiting.size() > 1 && is_replaced(waiting.back(), message)) {
    waiting.pop_back();
    ++counts_.dropped;
  }
  waiting.push_back(std::move(message));
  ++counts_.received;
  if (waiting.size() == 1) begin(waiting.front());
}

/// Lets another thread build the mesh of a message, if the mesh is large and its triangles are new.
/// All earlier messages of the organ must have been applied, because they decide what is new.
void OrganIntake::begin(OrganMessage& message) {
  if (!threads_ || !message.mesh || !is_large(*message.mesh) || message.built.valid()) return;
  if (!organs_.is_new(*message.mesh, message.connection)) return;
  const auto task = std::make_shared<std::packaged_task<TriangleMesh()>>(
      [this, mesh = message.mesh] { return organs_.build(mesh); });
  message.built = task->get_future();
  call_later(threads_->builder, [task, &node = threads_->node] {
    (*task)();
    call_later(node, [] {});
  });
}

OrganMessageCounts OrganIntake::counts() const {
  OrganMessageCounts counts = counts_;
  for (const auto& [organ, waiting] : messages_) counts.waiting += waiting.size();
  return counts;
}

bool OrganIntake::on_remove(RemoveOrgan::Request& request, RemoveOrgan::Response& response) {
  try {
    check_name("organ", request.organ);
    if (messages_.count(request.organ) == 0) organs_.at(request.organ);
    const auto removal = boost::make_shared<OrganMesh>();
    removal->organ = request.organ;
    take_mesh(removal);
    response.success = true;
    response.message = "organ '" + request.organ + "' is removed";
  } catch (const Rejection& rejection) {
    response.message = rejection.what();
  }
  return true;
}

bool OrganIntake::on_list(ListOrgans::Request&, ListOrgans::Response& response) {
  std::map<std::string, DeformableOrgan> organs;
  try {
    run_in_thread_of(threads_->node, [&] { organs = organs_.organs(); });
  } catch (const std::exception&) {  // The node ends.
    return false;
  }
  for (const auto& [name, organ] : organs) response.organs.push_back(info_of(organ));
  return true;
}

std::optional<OrganUpdate> OrganIntake::next() {
  for (auto organ = messages_.begin(); organ != messages_.end(); ++organ) {
    std::deque<OrganMessage>& waiting = organ->second;
    begin(waiting.front());
    if (!is_ready(waiting.front())) continue;
    OrganMessage message = std::move(waiting.front());
    waiting.pop_front();
    if (waiting.empty()) messages_.erase(organ);
    return apply(std::move(message));
  }
  return std::nullopt;
}

OrganUpdate OrganIntake::apply(OrganMessage waiting) {
  OrganUpdate update{std::move(waiting)};
  OrganMessage& message = update.message;
  const ros::Time now = ros::Time::now();
  bool is_new = false;
  const auto built = [&] {
    is_new = true;
    return message.built.valid() ? message.built.get() : organs_.build(message.mesh);
  };
  try {
    update.change = message.mesh ? organs_.apply(message.mesh, now, message.connection, built)
                                 : organs_.apply(message.vertices, now, message.connection);
    if (update.change == OrganChange::kSender) {
      ROS_INFO("organ '%s': its sender has restarted, so a new history begins",
               message.organ().c_str());
    }
    if (is_new) inspect(organs_.at(message.organ()));
    if (update.change != OrganChange::kRemoved) {
      ++counts_.applied;
    } else {
      update.status = ContactArray::NO_MESH;
      update.why_not = "organ '" + message.organ() + "' was removed";
      ++counts_.removals;
    }
  } catch (const Rejection& rejection) {
    update.status = rejection.status();
    update.why_not = rejection.what();
    ++counts_.refused;
    const auto time = SteadyClock::now();
    const bool may_start =
        update.status == ContactArray::UNKNOWN_ORGAN && time - start_ < kSendersStart;
    if (!may_start) rejected_.add(rejection.reason(), rejection.what(), time);
  }
  return update;
}

/// Lets the inspector's thread find out the surface of an organ; without threads, this thread. A
/// surface that nobody uses any more by then is left out.
void OrganIntake::inspect(const DeformableOrgan& organ) {
  if (!threads_) return organ.surface()->find();
  const std::weak_ptr<OrganSurface> needed = organ.surface();
  call_later(threads_->inspector, [this, needed, name = organ.name()] {
    const std::shared_ptr<OrganSurface> surface = needed.lock();
    if (!surface) return;
    try {
      surface->find();
      log_.tell(name, *surface, SteadyClock::now());
    } catch (...) {  // Usually std::bad_alloc. It ends the node: its thread rethrows it.
      call_later(threads_->node,
                 [error = std::current_exception()] { std::rethrow_exception(error); });
    }
  });
}

std::uint64_t lost_before(std::map<std::string, std::uint32_t>& last, const std::string& publisher,
                          std::uint32_t number) {
  const auto [known, is_new] = last.emplace(publisher, number);
  const std::uint32_t before = std::exchange(known->second, number);
  return !is_new && number > before ? number - before - 1 : 0;
}

}  // namespace organ_collision
