#include "organ_message_queue.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>

#include "organ_registry.hpp"
#include "ros/interface/thread_scheduling.hpp"

namespace organ_collision {
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

}  // namespace organ_collision
