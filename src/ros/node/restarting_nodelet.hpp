#pragma once

#include <nodelet/nodelet.h>

#include <atomic>
#include <functional>
#include <future>
#include <thread>

namespace organ_collision {

/// A node in a nodelet manager: messages of the same process arrive without copies. The node works
/// in a thread of its own. If it breaks down, it is started again.
class RestartingNodelet : public nodelet::Nodelet {
 public:
  /// Runs a node until it breaks down, which throws, or until `stop` returns true.
  using Run = std::function<void(const std::function<bool()>& stop)>;

 protected:
  /// To be called by the destructor of each derived class.
  void stop();

 private:
  /// Constructs the node, in the thread that runs it. Throws if it cannot be constructed.
  virtual Run make_node() = 0;

  void onInit() override;
  void work(std::promise<void>& ready);
  void run(Run run_node);
  void pause(double seconds) const;
  bool is_to_stop() const;

  std::atomic<bool> stop_{false};
  std::thread worker_;
};

}  // namespace organ_collision
