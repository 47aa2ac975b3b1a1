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
std::string description(const ToolStep& step, const Tool& tool) {
  const CollisionRequest& request = step.request;
  std::string text =
      concatenate("tool '", tool.parameters.name, "', organ '", step.organ->name(), "' (",
                  request.organ->face_count(),
                  " faces): ", std::max<std::size_t>(request.path.size(), 2) - 1, " legs");
  if (request.links && !request.links->empty())
    text += ", " + counted(request.links->size(), "link");
  if (request.margin > 0.0) text += concatenate(", margin ", request.margin);
  if (request.max_near > 0) text += concatenate(", max_near ", request.max_near);
  if (request.placement) text += ", placement";
  if (request.regions) text += ", regions";
  return text + concatenate("; ", step.answer->contacts.size(), " contacts");
}

}  // namespace

void LoadWatch::add(const ToolStep& step, const Tool& tool) {
  has_steps_ = true;
  if (step.query_sec <= period_.slowest_sec) return;
  period_.slowest_sec = step.query_sec;
  period_.slowest = description(step, tool);
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
