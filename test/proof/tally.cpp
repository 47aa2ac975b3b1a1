#include "tally.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>

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
