// Lets the haptic proxy follow hands that do what surgeons do, and worse. An oracle checks each
// tick. Exits with 1 if a promise was broken: the proxy came too near to tissue, passed through it,
// was overrun, or gave an answer that contradicts itself.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>
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

/// The episodes of one scene, which several threads share.
class SceneProof {
 public:
  SceneProof(const Options& options, std::string kind, Progress& progress)
      : options_(options), kind_(std::move(kind)), progress_(progress) {}

  ProxyTally run() {
    std::vector<std::thread> threads;
    for (long i = 0; i < options_.threads; ++i) threads.emplace_back([this] { work(); });
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    return tally_;
  }

 private:
  void work() {
    try {
      const long first = std::max(0L, options_.episode);
      for (long next = next_++; next * kEpisodeTicks < options_.ticks; next = next_++) {
        const long ticks = std::min(kEpisodeTicks, options_.ticks - next * kEpisodeTicks);
        const ProxyTally tally =
            follow({kind_, static_cast<unsigned long>(options_.seed), first + next}, ticks);
        const std::lock_guard<std::mutex> lock(mutex_);
        tally_.add(tally);
        progress_.show(kind_, tally_.ticks, options_.ticks);
        if (options_.episode >= 0) return;
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      failure_ = std::current_exception();
    }
  }

  ProxyTally follow(const Episode& episode, long ticks) {
    int reports = 0;
    return follow_hand(episode, ticks, [&](long tick, const std::string& what) {
      if (++reports > kMostReports) return;
      const std::lock_guard<std::mutex> lock(mutex_);
      std::cerr << "--scene '" << episode.kind << "' --seed " << episode.seed << " --episode "
                << episode.number << ": tick " << tick << ": " << what << std::endl;
    });
  }

  const Options& options_;
  std::string kind_;
  Progress& progress_;
  std::atomic<long> next_ = 0;
  std::mutex mutex_;
  ProxyTally tally_;
  std::exception_ptr failure_;
};

}  // namespace

int main(int argc, char** argv) {
  const Options options = read(argc, argv);
  Progress progress;
  ProxyTally all;
  print_proxy_head(std::cout);
  for (const std::string& kind : proxy_scene_kinds()) {
    if (!options.scene.empty() && options.scene != kind) continue;
    const ProxyTally tally = SceneProof(options, kind, progress).run();
    print(kind, tally, std::cout);
    all.add(tally);
  }
  print("all", all, std::cout);
  return all.broken() == 0 ? 0 : 1;
}
