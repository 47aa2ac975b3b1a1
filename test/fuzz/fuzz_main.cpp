// The program `fuzz`, with one of its targets: `fuzz TARGET ...`. run_fuzz builds it with
// libFuzzer, which looks for inputs that reach new code and takes the other arguments. Otherwise
// `fuzz TARGET CORPUS MUTATIONS` runs the inputs of a corpus, and mutations of them, which are the
// same each time. An input that crashes or takes longer than kMost ends the program; it is then in
// the file fuzz.TARGET.failed_input beside the program.
#include <console_bridge/console.h>
#include <fcntl.h>
#include <ros/console.h>
#include <ros/time.h>
#include <unistd.h>

#include <csignal>
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

using Input = std::vector<std::uint8_t>;
using Random = std::mt19937_64;

/// [s] For one input. libFuzzer gets 1 s, but a test must not fail on a busy machine.
constexpr unsigned kMost = 60;
/// [bytes] Of mutated inputs.
constexpr std::size_t kLargest = 4096;

Input running;             ///< what fail() writes
std::string failed_input;  ///< where; not in the current folder, which may be that of the sources

/// Writes the input, and ends the program as the signal would have. Calls only what signal
/// handlers may call.
void fail(int signal) {
  const int file = open(failed_input.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const bool written = file >= 0 && write(file, running.data(), running.size()) >= 0;
  const auto say = [](const char* text) {
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) std::_Exit(EXIT_FAILURE);
  };
  if (written) {
    say("The input in the file ");
    say(failed_input.c_str());
    say(" crashed or took too long.\n");
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run(Input input) {
  running = std::move(input);
  alarm(kMost);
  // A copy of exactly this size, so that tools such as valgrind see what is read beyond it.
  const Input copy(running);
  LLVMFuzzerTestOneInput(copy.data(), copy.size());
  alarm(0);
}

Input read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The files of the corpus in the order of their names, so that all runs are the same.
std::vector<Input> read_corpus(const std::filesystem::path& folder) {
  std::set<std::filesystem::path> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path());
  std::vector<Input> corpus;
  for (const auto& name : names) corpus.push_back(read(name));
  return corpus;
}

std::size_t below(std::size_t end, Random& random) {
  return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

template <typename Number>
void overwrite(Number number, Input& input, Random& random) {
  if (input.size() < sizeof(number)) return;
  std::memcpy(&input[below(input.size() - sizeof(number) + 1, random)], &number, sizeof(number));
}

template <typename Number>
Number extreme_number(Random& random) {
  using Limits = std::numeric_limits<Number>;
  const Number numbers[] = {
      Limits::max(),      Limits::lowest(), Limits::min(), Limits::quiet_NaN(),
      Limits::infinity(), Number(-1),       Number(1)};
  return numbers[below(std::size(numbers), random)];
}

/// Changes the input in one place. `other`: another input of the corpus.
void mutate(Input& input, const Input& other, Random& random) {
  if (input.empty()) input.push_back(0);
  const auto at = input.begin() + static_cast<std::ptrdiff_t>(below(input.size(), random));
  const std::size_t length = std::min<std::size_t>(1 + below(32, random), input.end() - at);
  const auto end = at + static_cast<std::ptrdiff_t>(length);
  switch (below(9, random)) {
    case 0:
      *at = static_cast<std::uint8_t>(below(256, random));
      break;
    case 1:
      *at = static_cast<std::uint8_t>(*at ^ (1u << below(8, random)));
      break;
    case 2:
      input.erase(at, end);
      break;
    case 3: {
      const Input part(at, end);
      input.insert(input.begin() + static_cast<std::ptrdiff_t>(below(input.size(), random)),
                   part.begin(), part.end());
      break;
    }
    case 4:
      overwrite(extreme_number<std::uint32_t>(random), input, random);
      break;
    case 5:
      overwrite(extreme_number<float>(random), input, random);
      break;
    case 6:
      overwrite(extreme_number<double>(random), input, random);
      break;
    case 7:
      input.resize(below(input.size(), random));
      break;
    default:
      input.insert(input.end(), other.begin(), other.end());
  }
  if (input.size() > kLargest) input.resize(kLargest);
}

void run_mutations(const std::vector<Input>& corpus, long count) {
  Random random(1);
  for (long i = 0; i < count; ++i) {
    Input input = corpus[below(corpus.size(), random)];
    for (std::size_t changes = 1 + below(4, random); changes > 0; --changes) {
      mutate(input, corpus[below(corpus.size(), random)], random);
    }
    run(std::move(input));
  }
}

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
  failed_input =
      std::filesystem::read_symlink("/proc/self/exe").string() + "." + name + ".failed_input";
  for (const int signal : {SIGALRM, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) {
    std::signal(signal, fail);
  }
  const std::filesystem::path place = argv[1];
  const std::vector<Input> corpus =
      std::filesystem::is_directory(place) ? read_corpus(place) : std::vector<Input>{read(place)};
  if (corpus.empty()) {
    std::cerr << place << " has no inputs\n";
    return 2;
  }
  for (const Input& input : corpus) run(input);
  run_mutations(corpus, mutations);
  std::cout << corpus.size() << " inputs and " << mutations << " mutations\n";
}
#endif
