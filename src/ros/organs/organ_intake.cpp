#include "organ_intake.hpp"

#include <organ_collision/ContactArray.h>
#include <ros/console.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <new>
#include <utility>

#include "organ_collision/ros/names.hpp"
#include "ros/messages/checked_messages.hpp"
#include "ros/node/queues.hpp"
#include "ros/node/scheduling.hpp"

namespace organ_collision {
namespace {

/// Publishers may have a new name at each start. If there were so many, all are forgotten.
constexpr std::size_t kMostPublishers = 1000;

}  // namespace

std::uint64_t SequenceGaps::add(const std::string& publisher, std::uint32_t number) {
  const auto known = last_.find(publisher);
  if (known == last_.end()) {
    if (last_.size() == kMostPublishers) last_.clear();
    last_.emplace(publisher, number);
    return 0;
  }
  const std::uint32_t last = std::exchange(known->second, number);
  return number > last ? number - last - 1 : 0;
}

namespace {

bool is_large(const OrganMesh& mesh) {
  return std::max(mesh.triangles.size(), mesh.vertices.size()) > 3 * OrganMessageQueue::kLarge;
}

bool is_ready(const OrganMessage& message) {
  return !message.built.valid() ||
         message.built.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// Whether the organ ends in the same state without a message that `next` follows, if `next` is
/// accepted. Without its removal, an organ might refuse the mesh behind it.
bool is_replaced(const OrganMessage& message, const OrganMessage& next) {
  if (message.vertices) return true;
  return next.mesh && (!is_removal(*message.mesh) || is_removal(*next.mesh));
}

template <typename Messages>
OrganMessage take_front(Messages& messages) {
  OrganMessage message = std::move(messages.front());
  messages.pop_front();
  return message;
}

}  // namespace

OrganMessageQueue::OrganMessageQueue(Functions functions)
    : functions_(std::move(functions)), thread_([this] { build_meshes(); }) {}

OrganMessageQueue::~OrganMessageQueue() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  has_work_.notify_one();
  thread_.join();
}

void OrganMessageQueue::add(const OrganMeshConstPtr& message, const Connection& connection) {
  add(OrganMessage{message, connection});
}

void OrganMessageQueue::add(const OrganVerticesConstPtr& message) {
  OrganMessage entry;
  entry.vertices = message;
  add(std::move(entry));
}

void OrganMessageQueue::add(OrganMessage message) {
  if (waiting_.count(message.organ()) == 0) {
    begin(message);
    if (is_ready(message)) return ready_.push_back(std::move(message));
  }
  Messages& messages = waiting_[message.organ()];
  messages.push_back(std::move(message));
  if (messages.size() > kMostWaiting) drop_oldest(messages);
}

/// Has the mesh of a message built if it must be. All earlier messages of the organ must be taken.
void OrganMessageQueue::begin(OrganMessage& message) {
  if (!message.mesh || !is_large(*message.mesh) || message.built.valid()) return;
  if (functions_.is_new(*message.mesh, message.connection)) {
    message.built = start_building(message.mesh);
  }
}

/// Never drops the first message, whose mesh is being built, nor the last one.
void OrganMessageQueue::drop_oldest(Messages& messages) {
  for (auto message = messages.begin() + 1; message + 1 != messages.end(); ++message) {
    if (!is_replaced(*message, *(message + 1))) continue;
    messages.erase(message);
    ++dropped_;
    return;
  }
}

std::size_t OrganMessageQueue::waiting() const {
  std::size_t waiting = ready_.size();
  for (const auto& [organ, messages] : waiting_) waiting += messages.size();
  return waiting;
}

bool OrganMessageQueue::has(const std::string& organ) const {
  return waiting_.count(organ) > 0 ||
         std::any_of(ready_.begin(), ready_.end(),
                     [&](const OrganMessage& message) { return message.organ() == organ; });
}

std::optional<OrganMessage> OrganMessageQueue::next() {
  if (!ready_.empty()) return take_front(ready_);
  for (auto organ = waiting_.begin(); organ != waiting_.end(); ++organ) {
    begin(organ->second.front());
    if (!is_ready(organ->second.front())) continue;
    OrganMessage message = take_front(organ->second);
    if (organ->second.empty()) waiting_.erase(organ);
    return message;
  }
  return std::nullopt;
}

std::future<TriangleMesh> OrganMessageQueue::start_building(const OrganMeshConstPtr& message) {
  std::packaged_task<TriangleMesh()> task([this, message] { return functions_.build(message); });
  std::future<TriangleMesh> built = task.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  has_work_.notify_one();
  return built;
}

void OrganMessageQueue::build_meshes() {
  lower_priority_of_this_thread();
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    has_work_.wait(lock, [this] { return stop_ || !tasks_.empty(); });
    if (stop_) return;
    std::packaged_task<TriangleMesh()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    wake();
    lock.lock();
  }
}

void OrganMessageQueue::wake() const {
  try {
    functions_.wake();
  } catch (const std::bad_alloc&) {  // The node also calls next() without a wake, but later.
  }
}

namespace {

/// [messages] For all organs together. If more wait while the node's thread is busy, roscpp drops
/// the oldest.
constexpr std::uint32_t kQueue = 100;

/// Vertices may come this long before the mesh of their organ.
constexpr std::chrono::seconds kStart(2);

}  // namespace

OrganTopics::OrganTopics(OrganRegistry& organs, FailureLog& rejected,
                         ros::CallbackQueueInterface& callbacks)
    : organs_(organs),
      rejected_(rejected),
      queue_({[this](const OrganMeshConstPtr& message) { return organs_.build(message); },
              [this](const OrganMesh& message, const Connection& connection) {
                return organs_.is_new(message, connection);
              },
              [&callbacks] { call_later(callbacks, [] {}); }}) {}

void OrganTopics::subscribe(const ros::NodeHandle& private_node) {
  subscribers_ = {
      subscribe_checked<OrganMesh>(
          private_node, names::kOrganMesh, kQueue,
          [this](const auto& event) {
            const OrganMeshConstPtr& message = event.getConstMessage();
            counts_.lost += mesh_gaps_.add(event.getPublisherName(), message->header.seq);
            take_mesh(message, event.getConnectionHeaderPtr());
          },
          rejected_),
      subscribe_checked<OrganVertices>(
          private_node, names::kOrganVertices, kQueue,
          [this](const auto& event) {
            const OrganVerticesConstPtr& message = event.getConstMessage();
            counts_.lost += vertices_gaps_.add(event.getPublisherName(), message->header.seq);
            take_vertices(message);
          },
          rejected_)};
}

void OrganTopics::take_mesh(const OrganMeshConstPtr& message, const Connection& connection) {
  queue_.add(message, connection);
  ++counts_.received;
}

void OrganTopics::take_vertices(const OrganVerticesConstPtr& message) {
  queue_.add(message);
  ++counts_.received;
}

OrganMessageCounts OrganTopics::counts() const {
  OrganMessageCounts counts = counts_;
  counts.dropped = queue_.dropped();
  counts.waiting = queue_.waiting();
  return counts;
}

void OrganTopics::remove(const std::string& organ) {
  check_name("organ", organ);
  if (!queue_.has(organ)) organs_.at(organ);
  const auto removal = boost::make_shared<OrganMesh>();
  removal->organ = organ;
  take_mesh(removal);
}

std::optional<OrganUpdate> OrganTopics::next() {
  std::optional<OrganMessage> message = queue_.next();
  if (!message) return std::nullopt;
  OrganUpdate update{*std::move(message)};
  try {
    update.change = apply(update.message);
    if (update.change != OrganChange::kRemoved) {
      ++counts_.applied;
    } else {
      update.status = ContactArray::NO_MESH;
      update.why_not = "organ '" + update.message.organ() + "' was removed";
      ++counts_.removals;
    }
  } catch (const Rejection& rejection) {
    ++counts_.refused;
    count(rejection);
    update.status = rejection.status();
    update.why_not = rejection.what();
  } catch (...) {  // Usually std::bad_alloc. The node counts it as an exception.
    ++counts_.refused;
    throw;
  }
  return update;
}

void OrganTopics::count(const Rejection& rejection) {
  const auto now = std::chrono::steady_clock::now();
  if (rejection.status() == ContactArray::UNKNOWN_ORGAN && now - start_ < kStart) {
    ROS_DEBUG("%s", rejection.what());
  } else {
    rejected_.add(rejection.reason(), rejection.what(), now);
  }
}

OrganChange OrganTopics::apply(OrganMessage& message) {
  const ros::Time now = ros::Time::now();
  if (message.vertices) return organs_.apply(message.vertices, now);
  return organs_.apply(message.mesh, message.connection, now, [&] {
    return message.built.valid() ? message.built.get() : organs_.build(message.mesh);
  });
}

}  // namespace organ_collision
