#include "organ_interpolation.hpp"

#include <algorithm>
#include <utility>

#include "query/proxy/proxy_motion.hpp"

namespace organ_collision {

/// The share of the way at `now`, in [0, 1].
double OrganInterpolation::Way::share(Time now) const {
  const std::chrono::duration<double> passed = now - start;
  return seconds > 0.0 ? std::clamp(passed.count() / seconds, 0.0, 1.0) : 1.0;
}

void OrganInterpolation::update(const OrganRegistry& organs, Time now) {
  std::map<std::string, Way> ways;
  for (const auto& [name, organ] : organs.organs()) {
    Way& way = ways[name];
    if (const auto known = ways_.find(name); known != ways_.end()) way = std::move(known->second);
    const std::shared_ptr<const TriangleMesh>& latest = organ.latest().mesh;
    if (way.to == latest) continue;
    // Without a previous shape, the organ has new triangles, a new frame or a restarted sender.
    const bool is_comparable = way.to && organ.latest().before &&
                               way.to->topology() == latest->topology() &&
                               way.to->same_faces(*latest) && latest->vertex_count() <= kLargest;
    const std::chrono::duration<double> since = std::min<Time::duration>(now - way.start, kLongest);
    way.late = is_comparable ? way.late_at(now) + organ.latest().motion_sec : 0.0;
    way.from = is_comparable ? shape_on(way, now) : latest;
    way.seconds = is_comparable ? since.count() : 0.0;
    way.to = latest;
    way.start = now;
  }
  ways_ = std::move(ways);
}

std::shared_ptr<const TriangleMesh> OrganInterpolation::shape(const DeformableOrgan& organ,
                                                              Time now) {
  const auto way = ways_.find(organ.name());
  return way == ways_.end() ? organ.latest().mesh : shape_on(way->second, now);
}

double OrganInterpolation::late(const DeformableOrgan& organ, Time now) const {
  const auto way = ways_.find(organ.name());
  return way == ways_.end() ? 0.0 : way->second.late_at(now);
}

bool OrganInterpolation::is_moving(Time now) const {
  return std::any_of(ways_.begin(), ways_.end(),
                     [&](const auto& way) { return way.second.share(now) < 1.0; });
}

std::shared_ptr<const TriangleMesh> OrganInterpolation::shape_on(const Way& way, Time now) {
  const double share = way.share(now);
  return share == 1.0 ? way.to : shape_between(*way.from, *way.to, share);
}

}  // namespace organ_collision
