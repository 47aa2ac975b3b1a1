#include "load_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/messages/text.hpp"
#include "geometry/concatenate.hpp"

namespace organ_collision {
namespace {

double seconds(LoadWatch::Time from, LoadWatch::Time to) {
  return std::chrono::duration<double>(to - from).count();
}

/// The tool and the organ of a step, and what makes its query long.
std::string description(const ToolStep& step) {
  const Question& question = step.question;
  const QueryOptions& asked = question.asked;
  const std::size_t legs = std::max<std::size_t>(question.sampled.path.size(), 2) - 1;
  std::string text = concatenate("tool '", question.tool_name, "', organ '", question.organ, "' (",
                                 question.shape.mesh->face_count(), " faces): ", legs, " legs");
  const std::size_t links = question.tool->links.size();
  if (links > 0) text += ", " + counted(links, "link");
  if (asked.margin > 0.0) text += concatenate(", margin ", asked.margin);
  if (asked.max_near > 0) text += concatenate(", max_near ", asked.max_near);
  if (asked.placement) text += ", placement";
  if (asked.regions) text += ", regions";
  return text + concatenate("; ", step.answer->contacts.size(), " contacts");
}

}  // namespace

void LoadWatch::add(const ToolStep& step) {
  has_steps_ = true;
  if (step.query_sec <= period_.slowest_sec) return;
  period_.slowest_sec = step.query_sec;
  period_.slowest = description(step);
}

void LoadWatch::add_round(Time begin, Time end, std::uint64_t merged) {
  constexpr double kMost = 0.8;  // [1] a larger share of the time is most of it
  if (!std::exchange(has_steps_, false)) return;
  period_.busy_sec += seconds(begin, end);
  period_.merged += merged - std::exchange(merged_, merged);
  ++period_.rounds;
  if (end - period_.begin < kPeriod) return;
  const double share = period_.busy_sec / seconds(period_.begin, end);
  is_behind_ = share > kMost && period_.merged >= period_.rounds;
  if (is_behind_) {
    report_ = concatenate("the node falls behind: steps take ", std::lround(100.0 * share),
                          " % of the time, and ", period_.merged,
                          " poses, ticks and shapes share a step with later ones; the slowest of ",
                          period_.rounds, " rounds has a step of ", 1e3 * period_.slowest_sec,
                          " ms: ", period_.slowest);
  }
  period_ = Period{end};
}

std::optional<std::string> LoadWatch::take_report() { return std::exchange(report_, std::nullopt); }

}  // namespace organ_collision
