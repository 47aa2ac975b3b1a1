// Loads tools from randomly broken descriptions. The code of the node must neither crash nor hang,
// and each tool must be either complete or have a fault. The exit code is 1 if a tool is neither,
// or if no version of a file gives a complete tool.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros/tools/tool.hpp"

namespace organ_collision {
namespace {

const std::string kFolder = ORGAN_COLLISION_TEST_DATA "/tools/";
const std::array<std::string, 7> kFiles = {"gripper.urdf",  "jaw_ascii.stl", "jaw_binary.stl",
                                           "jaw.obj",       "jaw.dae",       "jaw_ascii.ply",
                                           "jaw_binary.ply"};
/// Texts that are difficult for parsers.
const std::vector<std::string> kTokens = {
    "-1", "0",  "4294967295", "99999999999", "1e999", "nan", "-inf", "%s%n",   "<",    "</",
    "/>", "\"", "\n",         "//",          " ",     "a",   "v",    "1e-320", "#jaw", "&#0;"};

using Random = std::mt19937_64;

std::size_t below(std::size_t end, Random& random) {
  return std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

/// Changes the text in one place.
void mutate(std::string& text, Random& random) {
  if (text.empty()) return;
  const std::size_t at = below(text.size(), random);
  const std::size_t length = std::min(text.size() - at, 1 + below(20, random));
  const std::string token = kTokens[below(kTokens.size(), random)];
  switch (below(8, random)) {
    case 0:
      text[at] = static_cast<char>(below(256, random));
      break;
    case 1:
      text[at] = static_cast<char>(text[at] ^ (1 << below(8, random)));
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(at, text.substr(below(text.size(), random), length));
      break;
    case 4:
      text.insert(at, token);
      break;
    case 5:
      text.replace(at, length, token);
      break;
    case 6:
      text.resize(at);
      break;
    default:
      text[at] = 'a';
  }
}

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A broken version of a file. It depends only on the file and the number.
std::string mutation(std::size_t file, std::size_t number) {
  std::seed_seq seed{file, number};
  Random random(seed);
  std::string text = read(kFolder + kFiles[file]);
  for (std::size_t changes = 1 + below(3, random); changes > 0; --changes) mutate(text, random);
  return text;
}

/// A URDF is loaded from a parameter, a mesh as the only shape of a robot.
Tool load(std::size_t file, const std::string& text, const std::string& folder) {
  ToolParameters parameters;
  parameters.name = "mutated";
  if (file == 0) {
    parameters.links = {"shaft", "wrist", "jaw", "other_jaw"};
    return load_tool(parameters, [&](const std::string&) { return text; });
  }
  parameters.links = {"tip"};
  const std::string path = folder + "/" + kFiles[file];
  std::ofstream(path, std::ios::binary) << text;
  return load_tool(parameters, [&](const std::string&) {
    return "<robot name='r'><link name='tip'><collision><geometry><mesh filename='" + path +
           "'/></geometry></collision></link></robot>";
  });
}

struct Tally {
  std::size_t loaded = 0, refused = 0, ended = 0, wrong = 0;
  double longest_sec = 0.0;
};

bool is_whole(const Tool& tool) {
  if (tool.links.size() != tool.parameters.links.size()) return false;
  if (tool.joints.size() != tool.links.size()) return false;
  return std::all_of(tool.links.begin(), tool.links.end(), [](const Link& link) {
    return !link.parts.empty() &&
           std::all_of(link.parts.begin(), link.parts.end(), [](const LinkPart& part) {
             return std::isfinite(part.project_onto({0.6, 0.0, 0.8}).high) && part.radius > 0.0;
           });
  });
}

bool has_fault(const Tool& tool) {
  return tool.fault.rfind("mutated: ", 0) == 0 && tool.links.empty() && tool.joints.empty();
}

void count(const Tool& tool, Tally& tally) {
  if (tool.fault.empty()) {
    ++(is_whole(tool) ? tally.loaded : tally.wrong);
  } else if (!has_fault(tool)) {
    ++tally.wrong;
  } else {
    ++(tool.fault.find("robot_reader was ended") != std::string::npos ? tally.ended
                                                                      : tally.refused);
  }
}

/// Loads the versions with the numbers first, first + step, ... below `end`.
Tally load_some(std::size_t file, std::size_t first, std::size_t step, std::size_t end) {
  std::string folder = std::filesystem::temp_directory_path() / "mutated_robots.XXXXXX";
  if (!mkdtemp(folder.data())) throw std::runtime_error("no temporary folder: " + folder);
  Tally tally;
  for (std::size_t number = first; number < end; number += step) {
    const auto start = std::chrono::steady_clock::now();
    const Tool tool = load(file, mutation(file, number), folder);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    count(tool, tally);
    tally.longest_sec = std::max(tally.longest_sec, time.count());
  }
  std::filesystem::remove_all(folder);
  return tally;
}

/// Loads in two threads at once, as nodelets are loaded.
Tally load_all(std::size_t file, std::size_t mutations) {
  auto odd = std::async(std::launch::async, load_some, file, 1, 2, mutations);
  Tally tally = load_some(file, 0, 2, mutations);
  const Tally others = odd.get();
  tally.loaded += others.loaded;
  tally.refused += others.refused;
  tally.ended += others.ended;
  tally.wrong += others.wrong;
  tally.longest_sec = std::max(tally.longest_sec, others.longest_sec);
  return tally;
}

/// Prints a table. Returns whether each tool was complete or had a fault, and at least one of each
/// file was complete.
bool load_mutations(std::size_t mutations) {
  std::cout << "file              loaded  refused  reader ended  longest [s]  wrong\n";
  bool all_well = true;
  for (std::size_t file = 0; file < kFiles.size(); ++file) {
    const Tally tally = load_all(file, mutations);
    std::cout << std::left << std::setw(15) << kFiles[file] << std::right << std::setw(9)
              << tally.loaded << std::setw(9) << tally.refused << std::setw(14) << tally.ended
              << std::setw(13) << std::setprecision(3) << tally.longest_sec << std::setw(7)
              << tally.wrong << std::endl;
    all_well = all_well && tally.wrong == 0 && tally.loaded > 0;
  }
  return all_well;
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  char* end = nullptr;
  const long mutations = argc == 2 ? std::strtol(argv[1], &end, 10) : 0;
  if (mutations <= 0 || *end != '\0') {
    std::cerr << "usage: mutated_robots N; so many mutations of each file are loaded\n";
    return 2;
  }
  return organ_collision::load_mutations(static_cast<std::size_t>(mutations)) ? 0 : 1;
}
