// The program `fuzz`, with one of its targets: `fuzz TARGET ...`. run_fuzz builds it with
// libFuzzer, which looks for inputs that reach new code and takes the other arguments. Otherwise
// `fuzz TARGET CORPUS MUTATIONS` runs the inputs of a corpus, and mutations of them, which are the
// same each time. An input that crashes or takes longer than kMost ends the program; it is then in
// the file fuzz.TARGET.failed_input beside the program.
#include <console_bridge/console.h>
#include <ros/console.h>
#include <ros/time.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "fuzz_input.hpp"

namespace organ_collision {
namespace {

std::map<std::string, FuzzTarget::Run>& targets() {
  static std::map<std::string, FuzzTarget::Run> targets;
  return targets;
}

FuzzTarget::Run target;  ///< the one that runs

}  // namespace

FuzzTarget::FuzzTarget(const char* name, Run run) { targets()[name] = std::move(run); }

}  // namespace organ_collision

/// Takes the target's name out of the arguments. The log says nothing, because it would say the
/// same for thousands of inputs, and ROS time stands still.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const auto found = organ_collision::targets().find(*argc > 1 ? (*argv)[1] : "");
  if (found == organ_collision::targets().end()) {
    std::cerr << "usage: fuzz TARGET ...; the targets are";
    for (const auto& [name, run] : organ_collision::targets()) std::cerr << ' ' << name;
    std::cerr << '\n';
    std::exit(2);
  }
  organ_collision::target = found->second;
  std::rotate(*argv + 1, *argv + 2, *argv + *argc);
  --*argc;
  ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Fatal);
  ros::console::notifyLoggerLevelsChanged();
  console_bridge::noOutputHandler();
  ros::Time::init();
  ros::Time::setNow(ros::Time(50));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  organ_collision::target(data, size);
  return 0;
}

#ifndef ORGAN_COLLISION_LIBFUZZER
namespace {

using Input = std::string;

/// [s] For one input. libFuzzer gets 1 s, but a test must not fail on a busy machine.
constexpr unsigned kMost = 60;
/// [bytes] Of mutated inputs.
constexpr std::size_t kLargest = 4096;

/// Runs an input. Before, writes it into a file, which is of use if the input ends the program.
void run(const Input& input, const std::string& file) {
  std::ofstream(file, std::ios::binary) << input;
  alarm(kMost);  // SIGALRM ends the program.
  // A copy of exactly this size, so that tools such as valgrind see what is read beyond it.
  const std::vector<std::uint8_t> copy(input.begin(), input.end());
  LLVMFuzzerTestOneInput(copy.data(), copy.size());
  alarm(0);
}

/// The files of the corpus in the order of their names, so that all runs are the same.
std::vector<Input> read_corpus(const std::filesystem::path& place) {
  std::set<std::filesystem::path> names = {place};
  if (std::filesystem::is_directory(place)) {
    names = {std::filesystem::directory_iterator(place), {}};
  }
  std::vector<Input> corpus;
  for (const auto& name : names) {
    std::ifstream file(name, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

template <typename Number>
Input bytes_of(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof(number)};
}

template <typename Number>
void append_extremes(std::vector<Input>& pieces) {
  using Limits = std::numeric_limits<Number>;
  for (const Number number : {Limits::max(), Limits::lowest(), Limits::min(), Limits::quiet_NaN(),
                              Limits::infinity(), Number(-1), Number(1)}) {
    pieces.push_back(bytes_of(number));
  }
}

/// Changes inputs of a corpus at random. The changes are the same in each run.
class Mutator {
 public:
  explicit Mutator(const std::vector<Input>& corpus) : corpus_(corpus) {
    append_extremes<std::uint32_t>(extremes_);
    append_extremes<float>(extremes_);
    append_extremes<double>(extremes_);
  }

  Input next() {
    Input input = corpus_[below(corpus_.size())];
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) change(input);
    input.resize(std::min(input.size(), kLargest));
    return input;
  }

 private:
  std::size_t below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_);
  }

  void change(Input& input) {
    const std::size_t at = below(input.size() + 1), length = 1 + below(32);
    const Input& extreme = extremes_[below(extremes_.size())];
    switch (below(7)) {
      case 0:
        input.replace(at, 1, bytes_of(static_cast<char>(below(256))));
        break;
      case 1:
        if (at < input.size()) input[at] = static_cast<char>(input[at] ^ (1 << below(8)));
        break;
      case 2:
        input.erase(at, length);
        break;
      case 3:
        input.insert(below(input.size() + 1), input.substr(at, length));
        break;
      case 4:
        input.replace(at, extreme.size(), extreme);
        break;
      case 5:
        input.resize(at);
        break;
      default:
        input += corpus_[below(corpus_.size())];
    }
  }

  const std::vector<Input>& corpus_;
  std::vector<Input> extremes_;  ///< the bytes of extreme numbers
  std::mt19937_64 random_{1};
};

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  LLVMFuzzerInitialize(&argc, &argv);
  char* end = nullptr;
  const long mutations = argc == 3 ? std::strtol(argv[2], &end, 10) : -1;
  if (mutations < 0 || *end != '\0' || !std::filesystem::exists(argv[1])) {
    std::cerr << "usage: fuzz TARGET CORPUS MUTATIONS; a folder or file with inputs, and how many\n"
                 "mutations of them are run\n";
    return 2;
  }
  const std::vector<Input> corpus = read_corpus(argv[1]);
  if (corpus.empty()) {
    std::cerr << argv[1] << " has no inputs\n";
    return 2;
  }
  // Beside the program, because the current folder may be that of the sources.
  const std::string file =
      std::filesystem::read_symlink("/proc/self/exe").string() + "." + name + ".failed_input";
  for (const Input& input : corpus) run(input, file);
  Mutator mutator(corpus);
  for (long i = 0; i < mutations; ++i) run(mutator.next(), file);
  std::filesystem::remove(file);
  std::cout << corpus.size() << " inputs and " << mutations << " mutations\n";
}
#endif
