#include "answer_rules.hpp"

#include "contact_rules.hpp"
#include "ros/interface/legal_name.hpp"
#include "ros/interface/plain_text.hpp"
#include "where_rules.hpp"

namespace organ_collision {
namespace {

void check_text(const char* what, const std::string& text, std::size_t most, Faults& faults) {
  if (text.size() <= most && plain_text(text, most) == text) return;
  faults.add("texts", what, " is '", plain_text(text, kLongestName), "', of ", text.size(),
             " bytes; must be plain text of at most ", most, " bytes");
}

/// The names of an answer that is OK are legal and not empty.
void check_name(const char* what, const std::string& name, Faults& faults) {
  if (name.empty()) faults.add("names", what, " is empty");
  if (const std::string fault = name_fault(name); !fault.empty()) {
    faults.add("names", what, " ", fault);
  }
}

/// Only a shaft has no name, and it comes first.
void check_links(const ContactArray& answer, Faults& faults) {
  if (answer.links.empty()) faults.add("names", "links is empty; a tool has a shaft or links");
  for (std::size_t i = 0; i < answer.links.size(); ++i) {
    const bool is_shaft = i == 0 && answer.links[i].empty();
    if (!is_shaft) check_name("a link", answer.links[i], faults);
  }
}

/// Of a failure, nothing is known.
void check_failure(const ContactArray& answer, Faults& faults) {
  if (answer.message.empty()) {
    faults.add("messages", "status is ", int{answer.status}, ", and message is empty");
  }
  check_text("frame_id", answer.header.frame_id, kLongestName, faults);
  check_text("organ", answer.organ, kLongestName, faults);
  check_text("tool", answer.tool, kLongestName, faults);
  const ToolPlacement& placement = answer.placement;
  const bool is_empty =
      answer.contacts.empty() && answer.regions.empty() && answer.near.empty() &&
      answer.unresolved == 0 && answer.near_left_out == 0 && answer.near_unresolved == 0 &&
      answer.clearance.state == Clearance::NOT_ASKED && placement.tip == ToolPlacement::UNKNOWN &&
      placement.trocar == ToolPlacement::UNKNOWN && placement.crossings.empty() &&
      !placement.length_known && placement.length_inside == 0.0;
  if (!is_empty) {
    faults.add("failures", "status is ", int{answer.status},
               ", but there are contacts, near faces, a clearance or a placement");
  }
}

bool is_paper_answer(const ContactArray& answer) {
  return answer.mode >= ContactArray::PAPER_STATIC;
}

/// The start and the end of the step.
void check_times(const ContactArray& answer, Faults& faults) {
  const ros::Time start = answer.step_start, end = answer.header.stamp;
  if (start > end) {
    faults.add("stamps", "the step runs from ", start, " to ", end, "; must not run backwards");
  }
  if (answer.mode == ContactArray::STATIC && start != end) {
    faults.add("stamps", "step_start is ", start, ", and the stamp is ", end,
               "; must be the same in a static answer");
  }
}

void check_success(const ContactArray& answer, Faults& faults) {
  if (answer.message.empty() == answer.path_incomplete) {
    faults.add("messages", "status is OK, path_incomplete is ", answer.path_incomplete != 0,
               ", and message is '", plain_text(answer.message, kLongestName),
               "'; must be empty unless path_incomplete is true");
  }
  check_name("frame_id", answer.header.frame_id, faults);
  check_name("organ", answer.organ, faults);
  check_links(answer, faults);
  check_times(answer, faults);
  if (is_paper_answer(answer)) return;
  check_touched_faces(answer, faults);
  check_near_faces(answer, faults);
  check_clearance_fields(answer, faults);
  check_placement_fields(answer, faults);
}

}  // namespace

Faults check_answer(const ContactArray& answer) {
  Faults faults;
  if (answer.status > ContactArray::INVALID_TOOL) {
    faults.add("status", "status is ", int{answer.status}, "; must be from 0 to ",
               int{ContactArray::INVALID_TOOL});
  }
  if (answer.mode > ContactArray::PAPER_NAIVE && answer.status == ContactArray::OK) {
    faults.add("mode", "mode is ", int{answer.mode}, "; must be from 0 to ",
               int{ContactArray::PAPER_NAIVE});
  }
  check_text("message", answer.message, kLongestMessage, faults);
  if (answer.status == ContactArray::OK) {
    check_success(answer, faults);
  } else {
    check_failure(answer, faults);
  }
  return faults;
}

}  // namespace organ_collision
