#include "organ_message_queue.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <utility>

namespace organ_collision {

OrganMessageQueue::OrganMessageQueue(Callbacks callbacks)
    : callbacks_(std::move(callbacks)), thread_([this] { make_meshes(); }) {}

OrganMessageQueue::~OrganMessageQueue() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  has_work_.notify_one();
  thread_.join();
}

void OrganMessageQueue::add(const OrganMeshConstPtr& message, const Connection& connection) {
  Entry entry;
  entry.mesh = message;
  entry.connection = connection;
  const bool is_large = message->triangles.size() > 3 * kLarge;
  const bool waits = waiting_.count(message->organ) > 0;
  if (is_large && (waits || !callbacks_.is_known(*message, connection)))
    entry.made = start_making(message);
  add(message->organ, std::move(entry));
}

void OrganMessageQueue::add(const OrganVerticesConstPtr& message) {
  Entry entry;
  entry.vertices = message;
  add(message->organ, std::move(entry));
}

void OrganMessageQueue::add(const std::string& organ, Entry entry) {
  const auto waiting = waiting_.find(organ);
  if (waiting == waiting_.end() && entry.is_ready()) return hand_on(entry);
  Entries& entries = waiting_[organ];
  entries.push_back(std::move(entry));
  if (entries.size() <= kMostWaiting) return;
  const auto oldest = std::find_if(entries.begin(), entries.end(),
                                   [](const Entry& waits) { return waits.vertices != nullptr; });
  if (oldest != entries.end()) entries.erase(oldest);
}

void OrganMessageQueue::hand_on() {
  for (auto organ = waiting_.begin(); organ != waiting_.end();) {
    hand_on(organ->second);
    organ = organ->second.empty() ? waiting_.erase(organ) : std::next(organ);
  }
}

void OrganMessageQueue::hand_on(Entries& entries) {
  while (!entries.empty() && entries.front().is_ready()) {
    Entry entry = std::move(entries.front());
    entries.pop_front();
    hand_on(entry);
  }
}

void OrganMessageQueue::hand_on(Entry& entry) const {
  if (entry.vertices) return callbacks_.take_vertices(entry.vertices);
  callbacks_.take(entry.mesh, entry.connection, [&] {
    return entry.made.valid() ? entry.made.get() : callbacks_.make(entry.mesh);
  });
}

bool OrganMessageQueue::Entry::is_ready() const {
  return !made.valid() || made.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

std::future<TriangleMesh> OrganMessageQueue::start_making(const OrganMeshConstPtr& message) {
  std::packaged_task<TriangleMesh()> task([this, message] { return callbacks_.make(message); });
  std::future<TriangleMesh> made = task.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  has_work_.notify_one();
  return made;
}

void OrganMessageQueue::make_meshes() {
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
    callbacks_.wake();
  } catch (const std::bad_alloc&) {  // hand_on is called all the same, somewhat later.
  }
}

}  // namespace organ_collision
