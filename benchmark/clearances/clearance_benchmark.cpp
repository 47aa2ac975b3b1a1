// Measures the ticks of a haptic proxy at several clearances.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "benchmark/cases/timing.hpp"
#include "benchmark/engines/engine.hpp"
#include "benchmark/scenes/organ_surface.hpp"
#include "guarded_scene.hpp"
#include "query/make_request.hpp"

namespace organ_collision::bench {
namespace {

constexpr double kClearances[] = {1e-4, 2e-3, 5e-3, 1e-2};  // [m]
/// Each time after so many ticks, the proxy is placed anew.
constexpr std::size_t kTicksToReset = 1000;
/// FCL is measured each time after so many ticks: it takes long.
constexpr std::size_t kTicksToFcl = 50;

/// [s] The time for which the calling thread has had a processor.
double thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <typename Work>
double time_of(Work work) {
  const double begin = thread_time();
  work();
  return thread_time() - begin;
}

/// The ticks of one kind.
struct Ticks {
  Durations times, ratios;  ///< ratios: to the swept query of the same step

  void add(double seconds, double query) {
    times.add(seconds);
    ratios.add(seconds / query);
  }
};

/// A proxy with one clearance, and what its ticks took.
struct Run {
  Run(const ProxyTool& tool, double its_clearance)
      : clearance(its_clearance), proxy(tool, settings(its_clearance)) {}

  static ProxySettings settings(double clearance) {
    ProxySettings result;
    result.clearance = clearance;
    return result;
  }

  double clearance;  ///< [m]
  HapticProxy proxy;
  Ticks held, free, anew;
  std::size_t precise = 0;    ///< held ticks whose distance is the clearance, as it should be
  double nearest = INFINITY;  ///< [m]
  std::size_t most_contacts = 0, most_tests = 0;
};

class Measurement {
 public:
  Measurement(GuardedTool kind, std::size_t faces)
      : kind_(kind),
        tool_(make_guarded_tool(kind)),
        organ_(faces),
        topology_(organ_.surface().faces, organ_.surface().vertices) {
    shapes_[0] =
        std::make_shared<TriangleMesh>(organ_.surface().vertices, organ_.surface().triangles());
    shapes_[1] = std::make_shared<TriangleMesh>(*shapes_[0]);
    for (const double clearance : kClearances) runs_.emplace_back(tool_, clearance);
    fcl_->set_topology({organ_.surface().vertices, organ_.surface().triangles()});
  }

  void measure(std::size_t ticks) {
    for (std::size_t tick = 0; tick < ticks; ++tick) follow(tick);
  }

  void print() const;

 private:
  void follow(std::size_t tick);
  double distance(const ToolPose& pose, double margin);
  void measure_fcl(const SharedVertices& vertices, const ToolPose& pose);

  GuardedTool kind_;
  ProxyTool tool_;
  WavingEllipsoid organ_;
  SurfaceTopology topology_;
  std::shared_ptr<TriangleMesh> shapes_[2];  // the latest one first
  CollisionQuery query_;
  CollisionResult result_;
  std::unique_ptr<Locator> fcl_ = make_fcl_locator();
  Durations queries_, fcl_times_;
  std::vector<Run> runs_;
};

/// [m] From the tool's surface to the organ; `margin` if it is farther away.
double Measurement::distance(const ToolPose& pose, double margin) {
  QueryOptions asked;
  asked.margin = margin;
  query_.evaluate(make_request({shapes_[0].get()}, {tool_.radius, &tool_.links}, asked,
                               {{0.0, pose.axis, pose.links}}),
                  result_);
  return result_.clearance.state == ClearanceState::kKnown ? result_.clearance.distance : margin;
}

/// What a guard without this package would do: FCL refits its tree of boxes, and tells the distance
/// of the shaft, or of a capsule for each link.
void Measurement::measure_fcl(const SharedVertices& vertices, const ToolPose& pose) {
  fcl_times_.add(time_of([&] {
    const double radius = kind_ == GuardedTool::kArm ? kGuardedLinkRadius : tool_.radius;
    fcl_->update(vertices);
    for (const ShaftAxis& axis : guarded_axes(kind_, pose)) fcl_->locate(axis, radius);
  }));
}

void Measurement::follow(std::size_t tick) {
  std::swap(shapes_[0], shapes_[1]);
  const SharedVertices vertices = organ_.shape(tick);
  shapes_[0]->move_vertices(vertices);
  const ToolPose hand = guarded_hand(kind_, tick);
  const ToolPose last = guarded_hand(kind_, tick > 0 ? tick - 1 : 0);
  const CollisionRequest swept = make_request(
      {shapes_[0].get(), shapes_[1].get()}, {tool_.radius, &tool_.links}, {QueryMode::kSwept},
      {{0.0, last.axis, last.links}, {1.0, hand.axis, hand.links}});
  const double query = time_of([&] { query_.evaluate(swept, result_); });
  queries_.add(query);
  const std::vector<ProxyOrgan> organs = {{"organ", shapes_[0], &topology_}};
  for (Run& run : runs_) {
    if (tick % kTicksToReset == kTicksToReset - 1) run.proxy.reset();
    const ProxyAnswer* answer = nullptr;
    const double seconds = time_of([&] { answer = &run.proxy.follow(hand, organs); });
    const bool is_free = answer->state == ProxyStatus::kFree;
    Ticks& ticks = answer->is_placed_anew ? run.anew : is_free ? run.free : run.held;
    ticks.add(seconds, query);
    if (answer->state == ProxyStatus::kNoAnswer) continue;
    run.most_tests = std::max(run.most_tests, answer->tests);
    run.most_contacts = std::max(run.most_contacts, answer->contacts.size());
    const double away = distance(answer->proxy, 1.1 * run.clearance);
    run.nearest = std::min(run.nearest, away / run.clearance);
    const bool is_precise = std::abs(away - run.clearance) <= std::max(1e-6, 0.01 * run.clearance);
    if (&ticks == &run.held && is_precise) ++run.precise;
  }
  if (tick % kTicksToFcl == 0) measure_fcl(vertices, hand);
}

void print(const std::string& name, const Ticks& ticks) {
  std::cout << "| " << name << " | " << ticks.times.count();
  for (const double share : {0.5, 0.99, 1.0})
    std::cout << " | " << 1e6 * ticks.times.quantile(share);
  std::cout << " | " << ticks.ratios.quantile(0.5) << " | " << ticks.ratios.quantile(0.99) << " |";
}

void Measurement::print() const {
  std::cout << std::fixed << std::setprecision(1) << "One swept query of the step: median "
            << 1e6 * queries_.quantile(0.5) << " us, 99th percentile "
            << 1e6 * queries_.quantile(0.99) << " us\n"
            << "FCL, refit and one distance for each part: median "
            << 1e6 * fcl_times_.quantile(0.5) << " us, 99th percentile "
            << 1e6 * fcl_times_.quantile(0.99) << " us\n\n"
            << "| clearance, ticks | count | median, us | 99 % | most | to one swept query: median "
               "| 99 % | at the clearance | least distance / clearance | most contacts | most pair "
               "tests |\n"
            << "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Run& run : runs_) {
    std::ostringstream name;
    name << 1e3 * run.clearance << " mm";
    bench::print(name.str() + ", held", run.held);
    std::cout << ' '
              << 100.0 * static_cast<double>(run.precise) /
                     static_cast<double>(std::max<std::size_t>(run.held.times.count(), 1))
              << " % | " << std::setprecision(3) << run.nearest << std::setprecision(1) << " | "
              << run.most_contacts << " | " << run.most_tests << " |\n";
    bench::print(name.str() + ", free", run.free);
    std::cout << " | | | |\n";
    bench::print(name.str() + ", placed anew", run.anew);
    std::cout << " | | | |\n";
  }
}

int run(int argc, char** argv) {
  const std::string tool = argc == 4 ? argv[2] : "";
  const bool is_asked =
      argc == 2 && (argv[1] == std::string("--help") || argv[1] == std::string("-h"));
  if (tool != "shaft" && tool != "arm") {
    (is_asked ? std::cout : std::cerr)
        << "Usage: clearance_benchmark FACES shaft|arm TICKS\n"
           "Leads a tool through an ellipsoid whose surface waves, and prints the processor time "
           "of "
           "the ticks of its\nhaptic proxy at clearances of 0.1, 2, 5 and 10 mm. FACES: 10000, "
           "100000, 200000 or 1000000.\n";
    return is_asked ? 0 : 2;
  }
  const GuardedTool kind = tool == "arm" ? GuardedTool::kArm : GuardedTool::kShaft;
  Measurement measurement(kind, std::strtoul(argv[1], nullptr, 10));
  measurement.measure(std::strtoul(argv[3], nullptr, 10));
  measurement.print();
  return 0;
}

}  // namespace
}  // namespace organ_collision::bench

int main(int argc, char** argv) {
  try {
    return organ_collision::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "clearance_benchmark: " << error.what() << std::endl;
    return 1;
  }
}
