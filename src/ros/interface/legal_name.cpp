#include "legal_name.hpp"

#include <algorithm>
#include <numeric>

#include "plain_text.hpp"

namespace organ_collision {
namespace {

/// The Levenshtein distance. Only one row of its table is in memory at a time.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::string name_fault(const std::string& name) {
  const std::string shown = plain_text(name, kLongestName);
  if (shown == name) return {};
  const std::string legal = "; a name must be UTF-8 without control characters, of at most " +
                            std::to_string(kLongestName) + " bytes";
  const std::string fault = name.size() > kLongestName
                                ? "has " + std::to_string(name.size()) + " bytes"
                                : "has control characters, or bytes that are no UTF-8";
  return "'" + shown + "' " + fault + legal;
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& legal) {
  return *std::min_element(legal.begin(), legal.end(), [&](const auto& a, const auto& b) {
    return edit_distance(name, a) < edit_distance(name, b);
  });
}

}  // namespace organ_collision
