#include <time.h>

#include <atomic>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "benchmark/measurements/stopwatch.hpp"
#include "motion_engines.hpp"
#include "motion_files.hpp"

namespace {

using namespace organ_collision::bench;

constexpr std::size_t kMotions = 1000;
constexpr std::size_t kCompared = 100;

/// [s] The time for which the calling thread has had a processor.
double thread_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Threads that ask one engine about the motions in turn.
class Askers {
 public:
  Askers(const MotionEngines& engines, const MotionSet& motions, const std::string& engine,
         std::size_t threads)
      : motions_(motions), asks_(threads) {
    for (MotionEngines::Ask& ask : asks_) ask = engines.asker(engine);
  }

  /// Asks for some seconds. Prints the motions a second, and the processor time of a motion, which
  /// other programs disturb less.
  void run(double seconds) {
    Stopwatch watch;
    std::vector<std::thread> threads;
    for (MotionEngines::Ask& ask : asks_) {
      threads.emplace_back([&] { work(ask, seconds); });
    }
    for (std::thread& thread : threads) thread.join();
    const double passed = watch.lap();
    std::cout << "{\"motions_per_second\": " << static_cast<double>(answered_) / passed
              << ", \"processor_seconds\": " << processor_time_ / static_cast<double>(answered_)
              << ", \"faces\": " << static_cast<double>(faces_) / static_cast<double>(answered_)
              << "}" << std::endl;
  }

 private:
  void work(const MotionEngines::Ask& ask, double seconds) {
    Stopwatch watch;
    double passed = 0.0;
    std::size_t answered = 0, faces = 0;
    for (; passed < seconds; passed += watch.lap(), ++answered) {
      faces += ask(motions_.paths[next_++ % motions_.paths.size()]);
    }
    processor_time_ = processor_time_ + thread_time();
    answered_ += answered;
    faces_ += faces;
  }

  const MotionSet& motions_;
  std::vector<MotionEngines::Ask> asks_;
  std::atomic<double> processor_time_ = 0.0;
  std::atomic<std::size_t> next_ = 0, answered_ = 0, faces_ = 0;
};

void obey(const std::string& line, const OrganSurface& organ, const MotionSet& motions,
          const MotionEngines& engines) {
  std::istringstream words(line);
  std::string what, folder;
  std::size_t count = 0;
  double seconds = 0.0;
  words >> what;
  if (what == "compare") {
    const MotionEngines::Comparison comparison = engines.compare(kCompared);
    std::cout << "{\"faces\": " << comparison.faces
              << ", \"missed_by_fcl\": " << comparison.missed_by_fcl
              << ", \"only_by_fcl\": " << comparison.only_by_fcl << "}" << std::endl;
  } else if (what == "write" && words >> count >> folder) {
    write_files(folder, organ, motions, count);
    std::cout << "{}" << std::endl;
  } else if (words >> count >> seconds) {
    Askers(engines, motions, what, count).run(seconds);
  } else {
    throw std::runtime_error("what is '" + line + "'?");
  }
}

}  // namespace

// motions_benchmark FACES shaft|grasper
// Reads what to measure from standard input and prints a line of JSON for each line that it reads:
//   compare                    how far FCL's answers are from this package's
//   ENGINE THREADS SECONDS     motions a second; an engine is one of MotionEngines::asker()
//   write COUNT FOLDER         {}; the files of write_files()
int main(int argc, char** argv) {
  if (argc != 3) return std::cerr << "motions_benchmark FACES shaft|grasper" << std::endl, 2;
  try {
    const OrganSurface organ = make_organ(std::strtoul(argv[1], nullptr, 10));
    const MotionSet motions = motions_of(argv[2], organ, kMotions);
    const MotionEngines engines(organ, motions);
    for (std::string line; std::getline(std::cin, line);) obey(line, organ, motions, engines);
  } catch (const std::exception& error) {
    std::cerr << "motions_benchmark: " << error.what() << std::endl;
    return 1;
  }
}
