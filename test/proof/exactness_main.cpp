// Measures the library against oracles. Exits with 1 if anything differs by more than the stated
// tolerance.
//
// contacts   Capsules at rest and swept, the pickers and the half-spaces of the viewing volumes are
//            compared with exact arithmetic, and moving organs with a search. No picker may miss a
//            face.
// clearance  Distances of tools at rest are compared with exact arithmetic, and the least distances
//            of steps with a search.
// placement  Sides and crossings are compared with exact arithmetic.
// grasps     Jaws close on tissue of 1 to 30 mm; the grasped pairs are compared with a search.
// misses     Only on request: how many faces the paper's viewing volume misses.
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "exactness_proof.hpp"

int main(int argc, char** argv) {
  using namespace organ_collision::oracle;
  ProofSize size;
  std::vector<Proof> parts(std::begin(kProofs), std::end(kProofs));
  for (int i = 1; i < argc; i += 2) {
    const std::string option = argv[i], text = i + 1 < argc ? argv[i + 1] : "";
    char* end = nullptr;
    const long value = std::strtol(text.c_str(), &end, 10);
    const bool is_number = value > 0 && *end == '\0';
    std::vector<Proof> named;
    for (const Proof& part : kProofs) {
      if (text == part.name) named = {part};
    }
    if (text == "misses") named = {{"misses", count_paper_misses}};
    if (option == "--part" && !named.empty()) {
      parts = named;
    } else if (option == "--pairs" && is_number) {
      size.pairs = value;
    } else if (option == "--seed" && is_number) {
      size.seed = static_cast<unsigned long>(value);
    } else {
      std::cerr << "usage: exactness_proof [--pairs N] [--seed N] [--part NAME]; N is a positive "
                   "number, NAME is contacts, clearance, placement, grasps or misses\n";
      return 2;
    }
  }
  Progress progress;
  bool right = true;
  for (const Proof& part : parts) right = part.prove(size, progress) && right;
  return right ? 0 : 1;
}
