#include "exactness_proof.hpp"

#include <algorithm>
#include <cstdlib>
#include <iomanip>

namespace organ_collision::oracle {

void Tally::add(const Tally& other) {
  pairs += other.pairs;
  touching += other.touching;
  inside_band += other.inside_band;
  outside_band += other.outside_band;
  missed += other.missed;
  farthest = std::max(farthest, other.farthest);
}

void print_head(const std::string& what, const std::string& band) {
  std::cout << "\n| " << std::left << std::setw(18) << what
            << " |     pairs |  touching | differ by <= " << band
            << " | differ by more | missed | largest [m] |\n"
            << "|---|---|---|---|---|---|---|\n";
}

void print(const std::string& name, const Tally& tally) {
  std::cout << "| " << std::left << std::setw(18) << name << std::right;
  for (const long count :
       {tally.pairs, tally.touching, tally.inside_band, tally.outside_band, tally.missed}) {
    std::cout << " | " << std::setw(9) << count;
  }
  std::cout << " | " << std::setw(9) << std::setprecision(2) << tally.farthest << " |" << std::endl;
}

}  // namespace organ_collision::oracle

// Measures the library against oracles. Exits with 1 if anything differs by more than the stated
// tolerance.
//
// contacts   Capsules at rest and swept, the pickers and the half-spaces of the viewing volumes are
//            compared with exact arithmetic, and moving organs with a search. No picker may miss a
//            face.
// clearance  Distances of tools at rest are compared with exact arithmetic, and the least distances
//            of steps with a search.
// placement  Sides and crossings are compared with exact arithmetic.

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
