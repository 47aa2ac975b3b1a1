// Lets the haptic proxy follow hands that do what surgeons do, and worse. An oracle checks each
// tick. Exits with 1 if a promise was broken: the proxy came too near to tissue, passed through it,
// was overrun, or gave an answer that contradicts itself.
#include <algorithm>
#include <boost/program_options.hpp>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "referee.hpp"
#include "scenes.hpp"
#include "test/proof/exactness_proof.hpp"

namespace {

using namespace organ_collision;
using namespace organ_collision::oracle;

constexpr long kEpisodeTicks = 10000;
constexpr int kMostReports = 5;  // in an episode

struct Options {
  std::string scene;  // empty: all
  long ticks, seed;
  long episode;      // only this one; negative: all
  double clearance;  // [m]; 0: of each organ and link another one
};

/// std::nullopt: they are illegal, and the usage was printed.
std::optional<Options> read(int argc, char** argv) {
  namespace po = boost::program_options;
  const std::vector<std::string>& kinds = proxy_scene_kinds();
  std::string usage = "usage: proxy_proof [options]. Scenes:";
  for (const std::string& kind : kinds) usage += "\n  " + kind;
  Options options;
  po::options_description legal(usage + "\nOptions");
  auto add = legal.add_options();
  add("scene", po::value(&options.scene)->default_value(""), "only this one");
  add("ticks", po::value(&options.ticks)->default_value(1000000),
      ("of each scene, in episodes of " + std::to_string(kEpisodeTicks)).c_str());
  add("seed", po::value(&options.seed)->default_value(1), "");
  add("episode", po::value(&options.episode)->default_value(-1), "only this one, from 0");
  add("clearance", po::value(&options.clearance)->default_value(1e-4),
      "in metres. 0: a random one of each organ and part of the tool");
  try {
    po::variables_map given;
    po::store(po::parse_command_line(argc, argv, legal), given);
    po::notify(given);
    const bool is_scene = options.scene.empty() ||
                          std::find(kinds.begin(), kinds.end(), options.scene) != kinds.end();
    const bool is_legal = std::min(options.ticks, options.seed) > 0 && options.clearance >= 0.0;
    if (is_scene && is_legal) return options;
  } catch (const po::error& error) {
    std::cerr << error.what() << '\n';
  }
  std::cerr << legal;
  return std::nullopt;
}

/// The time below which this share of the ticks is [us]. Reorders them.
double quantile(std::vector<float>& seconds, double share) {
  if (seconds.empty()) return 0.0;
  const auto last = static_cast<double>(seconds.size() - 1);
  const auto place = seconds.begin() + static_cast<std::ptrdiff_t>(share * last);
  std::nth_element(seconds.begin(), place, seconds.end());
  return 1e6 * static_cast<double>(*place);
}

double percent(long part, long all) {
  return all > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(all) : 0.0;
}

void print_proxy_head(std::ostream& out) {
  out << "| scene | ticks | touching | squeezed | jumps | overrun | no answer | too near | through "
         "| inside | held | inconsistent | at the clearance | least distance [mm] | where squeezed "
         "[mm] "
         "| median [us] | 99 % | 99.9 % | most "
         "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---"
         "|---|---|---|---|---|---|\n";
}

void print(const std::string& name, ProxyTally tally, std::ostream& out) {
  out << "| " << name << " | " << tally.ticks << std::fixed << std::setprecision(1) << " | "
      << percent(tally.touching, tally.ticks) << " % | " << std::setprecision(3)
      << percent(tally.squeezed, tally.ticks) << " %";
  for (const long count : {tally.jumps, tally.overrun, tally.no_answer, tally.near, tally.through,
                           tally.inside, tally.held, tally.inconsistent}) {
    out << " | " << count;
  }
  out << std::setprecision(2) << " | " << percent(tally.at_clearance, tally.touching) << " %";
  out << std::setprecision(4) << " | " << 1e3 * tally.least << " | ";
  if (tally.squeezed > 0) out << 1e3 * tally.least_squeezed;
  out << std::setprecision(0);
  for (const double share : {0.5, 0.99, 0.999, 1.0}) {
    out << " | " << quantile(tally.seconds, share);
  }
  out << " |" << std::defaultfloat << std::endl;
}

/// What this thread has computed for. Other programs on the machine do not matter.
double processor_seconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Follows the hand of an episode, a random scene with a proxy of its own, for so many ticks.
/// `report` receives a tick and what went wrong in it.
ProxyTally follow_hand(const Options& options, const std::string& kind, long episode, long ticks,
                       const std::function<void(long, const std::string&)>& report) {
  Random random(1000003 * static_cast<unsigned long>(options.seed) +
                static_cast<unsigned long>(episode));
  ProxyScene scene = make_proxy_scene(kind, random);
  if (options.clearance > 0.0) scene.settings.clearance = options.clearance;
  std::vector<std::vector<double>> tables(scene.organs.size());
  if (options.clearance == 0.0) {
    for (auto& table : tables) table = random_clearances(scene.hand.tool, random);
  }
  ScriptedHand hand(scene.hand, random);
  HapticProxy proxy(scene.hand.tool, scene.settings);
  long tick = 0;
  Referee referee(scene.hand.tool, scene.settings,
                  [&](const std::string& what) { report(tick, what); });
  std::vector<bool> is_closed;
  for (const ScriptedOrgan& organ : scene.organs) is_closed.push_back(organ.is_closed());
  std::vector<float> seconds;
  for (; tick < ticks; ++tick) {
    const ToolPose& pose = hand.next();
    std::vector<ProxyOrgan> organs;
    for (std::size_t i = 0; i < scene.organs.size(); ++i) {
      organs.push_back(scene.organs[i].at(tick));
      organs.back().clearances = tables[i];
    }
    const double begin = processor_seconds();
    const ProxyAnswer& answer = proxy.follow(pose, organs);
    seconds.push_back(static_cast<float>(processor_seconds() - begin));
    referee.check(pose, hand.jumped(), organs, is_closed, answer);
  }
  ProxyTally tally = referee.tally();
  tally.seconds = std::move(seconds);
  return tally;
}

/// Follows the hands of all episodes of one scene.
ProxyTally prove(const Options& options, const std::string& kind, Progress& progress) {
  ProxyTally all;
  for (long next = 0; next * kEpisodeTicks < options.ticks; ++next) {
    const long episode = std::max(0L, options.episode) + next;
    const long ticks = std::min(kEpisodeTicks, options.ticks - next * kEpisodeTicks);
    int reports = 0;
    const auto report = [&](long tick, const std::string& what) {
      if (++reports > kMostReports) return;
      std::cerr << "--scene '" << kind << "' --seed " << options.seed << " --episode " << episode
                << ": tick " << tick << ": " << what << std::endl;
    };
    all.add(follow_hand(options, kind, episode, ticks, report));
    progress.show(kind, all.ticks, options.ticks);
    if (options.episode >= 0) break;
  }
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const std::optional<Options> options = read(argc, argv);
  if (!options) return 2;
  Progress progress;
  ProxyTally all;
  print_proxy_head(std::cout);
  for (const std::string& kind : proxy_scene_kinds()) {
    if (!options->scene.empty() && options->scene != kind) continue;
    const ProxyTally tally = prove(*options, kind, progress);
    print(kind, tally, std::cout);
    all.add(tally);
  }
  print("all", all, std::cout);
  return all.broken() == 0 ? 0 : 1;
}
