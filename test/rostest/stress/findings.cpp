#include "findings.hpp"

#include "answer_check.hpp"

namespace organ_collision::stress {

void Findings::check(const std::string& source, const ContactArray& answer) {
  const std::string broken = broken_contract(answer);
  const std::lock_guard lock(mutex_);
  ++checked_;
  answered_ += answer.status == ContactArray::OK;
  if (!broken.empty()) sentences_.insert(source + ": " + broken);
}

void Findings::add(const std::string& sentence) {
  const std::lock_guard lock(mutex_);
  sentences_.insert(sentence);
}

std::size_t Findings::checked() const {
  const std::lock_guard lock(mutex_);
  return checked_;
}

std::size_t Findings::answered() const {
  const std::lock_guard lock(mutex_);
  return answered_;
}

std::string Findings::text() const {
  const std::lock_guard lock(mutex_);
  std::string text;
  for (const std::string& sentence : sentences_) text += sentence + "\n";
  return text;
}

}  // namespace organ_collision::stress
