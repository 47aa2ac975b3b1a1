// The program `fuzz`, with one of its targets: `fuzz TARGET ...`. run_fuzz builds it with
// libFuzzer, which looks for inputs that reach new code and takes the other arguments. Otherwise
// `fuzz TARGET CORPUS` runs the inputs of a corpus. An input that crashes or takes longer than
// kMost ends the program; it is then in the file fuzz.TARGET.failed_input beside the program.
#include <console_bridge/console.h>
#include <ros/console.h>
#include <ros/time.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
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

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  LLVMFuzzerInitialize(&argc, &argv);
  if (argc != 2 || !std::filesystem::exists(argv[1])) {
    std::cerr << "usage: fuzz TARGET CORPUS; a folder or file with inputs\n";
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
  std::filesystem::remove(file);
  std::cout << corpus.size() << " inputs\n";
}
#endif
