// Measures the library against oracles. Exits with 1 if anything differs by more than the stated
// tolerance.
//
// contacts   Capsules at rest and swept, the pickers and the half-spaces of the viewing volumes are
//            compared with exact arithmetic, and moving organs with a search. No picker may miss a
//            face.
// clearance  Distances of tools at rest are compared with exact arithmetic, and the least distances
//            of steps with a search.
// placement  Sides and crossings are compared with exact arithmetic.
#include <cstdlib>
#include <iostream>
#include <string>

#include "proofs.hpp"

namespace {

struct Part {
  const char* name;
  bool (*prove)(long pairs, unsigned long seed, organ_collision::oracle::Progress& progress);
};
constexpr Part kParts[] = {{"contacts", organ_collision::oracle::prove_contacts},
                           {"clearance", organ_collision::oracle::prove_clearance},
                           {"placement", organ_collision::oracle::prove_placement}};

bool is_part(const std::string& name) {
  for (const Part& part : kParts) {
    if (name == part.name) return true;
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  long pairs = 1000000;
  unsigned long seed = 1;
  std::string only;
  for (int i = 1; i < argc; i += 2) {
    const std::string option = argv[i], text = i + 1 < argc ? argv[i + 1] : "";
    if (option == "--part" && is_part(text)) {
      only = text;
      continue;
    }
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    if (value <= 0 || *end != '\0' || (option != "--pairs" && option != "--seed")) {
      std::cerr << "usage: exactness_proof [--pairs N] [--seed N] [--part NAME]; N is a positive "
                   "number, NAME is contacts, clearance or placement\n";
      return 2;
    }
    if (option == "--pairs") pairs = value;
    if (option == "--seed") seed = static_cast<unsigned long>(value);
  }
  organ_collision::oracle::Progress progress;
  bool right = true;
  for (const Part& part : kParts) {
    if (only.empty() || only == part.name) right = part.prove(pairs, seed, progress) && right;
  }
  return right ? 0 : 1;
}
