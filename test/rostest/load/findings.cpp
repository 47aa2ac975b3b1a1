#include "findings.hpp"

#include "check_contacts/answer_rules.hpp"

namespace organ_collision::stress {

void Findings::check(const std::string& source, const ContactArray& answer) {
  const Faults faults = check_answer(answer);
  const std::lock_guard lock(mutex_);
  count(source, answer, faults);
}

void Findings::check_step(const ContactArray& answer, const std::string& publisher) {
  const std::lock_guard lock(mutex_);
  count("contacts", answer, steps_.check(answer, publisher));
}

void Findings::count(const std::string& source, const ContactArray& answer, const Faults& faults) {
  ++checked_;
  answered_ += answer.status == ContactArray::OK;
  for (const Fault& fault : faults.all()) sentences_.insert(source + ": " + fault.sentence);
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
