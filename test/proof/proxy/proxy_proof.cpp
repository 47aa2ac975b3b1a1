// Lets the haptic proxy follow hands that do what surgeons do, and worse. An oracle checks each
// tick. Exits with 1 if a promise was broken: the proxy came too near to tissue, passed through it,
// was overrun, or gave an answer that contradicts itself.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <future>
#include <iostream>
#include <mutex>
#include <string>
#include <vector>

#include "episode.hpp"
#include "scenes.hpp"
#include "test/proof/exactness_proof.hpp"

namespace {

using namespace organ_collision::oracle;

constexpr long kEpisodeTicks = 10000;
constexpr int kMostReports = 5;  // in an episode

struct Options {
  std::string scene;  // empty: all
  long ticks = 1000000;
  long seed = 1;
  long threads = 1;
  long episode = -1;  // only this one
};

[[noreturn]] void show_usage() {
  std::cerr << "usage: proxy_proof [--scene NAME] [--ticks N] [--seed N] [--threads N] "
               "[--episode N]\nticks: of each scene, in episodes of "
            << kEpisodeTicks << "; episode: only this one, from 0. Scenes:\n";
  for (const std::string& kind : proxy_scene_kinds()) std::cerr << "  " << kind << '\n';
  std::exit(2);
}

Options read(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string option = argv[i], text = i + 1 < argc ? argv[i + 1] : "";
    if (option == "--scene") {
      const auto& kinds = proxy_scene_kinds();
      if (std::find(kinds.begin(), kinds.end(), text) == kinds.end()) show_usage();
      options.scene = text;
      continue;
    }
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || value < (option == "--episode" ? 0 : 1)) show_usage();
    if (option == "--ticks") {
      options.ticks = value;
    } else if (option == "--seed") {
      options.seed = value;
    } else if (option == "--threads") {
      options.threads = value;
    } else if (option == "--episode") {
      options.episode = value;
    } else {
      show_usage();
    }
  }
  return options;
}

/// Follows the hands of all episodes of one scene, which several threads share.
ProxyTally prove(const Options& options, const std::string& kind, Progress& progress) {
  std::mutex mutex;
  ProxyTally all;
  std::atomic<long> next_episode = 0;
  const auto follow = [&](const Episode& episode, long ticks) {
    int reports = 0;
    return follow_hand(episode, ticks, [&](long tick, const std::string& what) {
      if (++reports > kMostReports) return;
      const std::lock_guard<std::mutex> lock(mutex);
      std::cerr << "--scene '" << episode.kind << "' --seed " << episode.seed << " --episode "
                << episode.number << ": tick " << tick << ": " << what << std::endl;
    });
  };
  const auto work = [&] {
    const long first = std::max(0L, options.episode);
    for (long next = next_episode++; next * kEpisodeTicks < options.ticks; next = next_episode++) {
      const long ticks = std::min(kEpisodeTicks, options.ticks - next * kEpisodeTicks);
      const ProxyTally tally =
          follow({kind, static_cast<unsigned long>(options.seed), first + next}, ticks);
      const std::lock_guard<std::mutex> lock(mutex);
      all.add(tally);
      progress.show(kind, all.ticks, options.ticks);
      if (options.episode >= 0) return;
    }
  };
  std::vector<std::future<void>> threads;
  for (long i = 0; i < options.threads; ++i) {
    threads.push_back(std::async(std::launch::async, work));
  }
  for (std::future<void>& thread : threads) thread.get();
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = read(argc, argv);
  Progress progress;
  ProxyTally all;
  print_proxy_head(std::cout);
  for (const std::string& kind : proxy_scene_kinds()) {
    if (!options.scene.empty() && options.scene != kind) continue;
    const ProxyTally tally = prove(options, kind, progress);
    print(kind, tally, std::cout);
    all.add(tally);
  }
  print("all", all, std::cout);
  return all.broken() == 0 ? 0 : 1;
}
