#include "answer_budget.hpp"

namespace organ_collision {

bool AnswerBudget::wait(std::size_t block) {
  if (bytes_ > most_bytes_) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return ended_ || next_ == block; });
  }
  return !ended_;
}

void AnswerBudget::set_taken(std::size_t block) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    next_ = block + 1;
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
