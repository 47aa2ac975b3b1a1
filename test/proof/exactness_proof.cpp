#include "exactness_proof.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <numeric>

namespace organ_collision::oracle {

void Progress::show(const std::string& what, long done, long all) {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::seconds(1)) return;
  last_ = now;
  std::cerr << what << ": " << done << " of " << all << "\n";
}

double& Tally::at(const std::string& column, bool is_count) {
  for (Column& known : columns_) {
    if (known.name == column) return known.value;
  }
  return columns_.emplace_back(Column{column, is_count, 0.0}).value;
}

void Tally::keep_most(const char* column, double value) {
  double& most = at(column, false);
  most = std::max(most, value);
}

void Tally::add(const Tally& other) {
  for (const Column& column : other.columns_) {
    double& value = at(column.name, column.is_count);
    value = column.is_count ? value + column.value : std::max(value, column.value);
  }
}

double Tally::get(const std::string& column) const {
  for (const Column& known : columns_) {
    if (known.name == column) return known.value;
  }
  return 0.0;
}

void print_table(const std::string& what, const std::vector<std::string>& names,
                 const std::vector<Tally>& tallies) {
  const Tally head = sum_of(tallies);
  std::cout << "\n| " << std::left << std::setw(18) << what << std::right;
  for (const Tally::Column& column : head.columns_) std::cout << " | " << column.name;
  std::cout << " |\n|---";
  for (std::size_t i = 0; i < head.columns_.size(); ++i) std::cout << "|---";
  std::cout << "|\n";
  for (std::size_t i = 0; i <= names.size(); ++i) {
    const bool is_sum = i == names.size();
    std::cout << "| " << std::left << std::setw(18) << (is_sum ? "all" : names[i]) << std::right;
    for (const Tally::Column& column : head.columns_) {
      std::cout << " | " << std::setw(9);
      const double value = (is_sum ? head : tallies[i]).get(column.name);
      if (column.is_count) {
        std::cout << static_cast<long>(value);
      } else {
        std::cout << std::setprecision(2) << value;
      }
    }
    std::cout << " |\n";
  }
  std::cout << std::flush;
}

Tally sum_of(const std::vector<Tally>& tallies) {
  return std::accumulate(tallies.begin(), tallies.end(), Tally(), [](Tally sum, const Tally& next) {
    sum.add(next);
    return sum;
  });
}

}  // namespace organ_collision::oracle
