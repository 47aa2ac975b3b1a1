#include "contact_contract.hpp"

namespace organ_collision {

Faults ContactContract::check(const ContactArray& answer, const std::string& publisher) {
  Faults faults = check_answer(answer);
  if (answer.mode > ContactArray::SWEPT && answer.status == ContactArray::OK) {
    faults.add("mode", "mode is ", int{answer.mode}, "; steps are STATIC (0) or SWEPT (1)");
  }
  if (answer.status == ContactArray::OK && answer.tool.empty()) {
    faults.add("names", "tool is empty");
  }
  Stream& stream = streams_[publisher];
  follow(answer, stream);
  if (answer.status != ContactArray::OK) return faults;
  check_start(answer, stream, faults);
  stream.ends[{answer.organ, answer.tool}] = answer.header.stamp;
  return faults;
}

/// After a gap, and after a restart of the publisher, nothing is known of the last steps.
void ContactContract::follow(const ContactArray& answer, Stream& stream) {
  const std::uint32_t seq = answer.header.seq;
  if (stream.seq && seq != *stream.seq + 1) {
    if (seq > *stream.seq) lost_ += seq - *stream.seq - 1;
    stream.ends.clear();
  }
  stream.seq = seq;
}

/// A swept step begins where the last successful one ended.
void ContactContract::check_start(const ContactArray& answer, const Stream& stream,
                                  Faults& faults) {
  if (answer.mode != ContactArray::SWEPT) return;
  const auto last = stream.ends.find({answer.organ, answer.tool});
  if (last == stream.ends.end() || last->second == answer.step_start) return;
  faults.add("steps that join", "the step begins at ", answer.step_start,
             ", and the last successful one ended at ", last->second, "; must be the same");
}

}  // namespace organ_collision
