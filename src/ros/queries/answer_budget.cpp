#include "answer_budget.hpp"

namespace organ_collision {

bool AnswerBudget::wait(std::size_t block, std::size_t block_bytes) {
  if (bytes_ > most_bytes_) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return ended_ || next_ == block; });
    if (taken_bytes_ + block_bytes > most_bytes_) return false;
  }
  return !ended_;
}

void AnswerBudget::set_taken(std::size_t block, std::size_t taken_bytes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    next_ = block + 1;
    taken_bytes_ = taken_bytes;
  }
  changed_.notify_all();
}

void AnswerBudget::end() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
}

}  // namespace organ_collision
