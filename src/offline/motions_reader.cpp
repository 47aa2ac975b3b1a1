#include "motions_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "text_reader.hpp"

namespace organ_collision {
namespace {

using Cells = std::vector<std::string_view>;

enum Column { kQuery, kMode, kTrocar, kPrevious = kTrocar + 3, kTip = kPrevious + 3, kRadius = 11 };

constexpr std::array<std::string_view, 12> kColumns = {
    "query",      "mode",       "trocar_x", "trocar_y", "trocar_z", "previous_x",
    "previous_y", "previous_z", "tip_x",    "tip_y",    "tip_z",    "radius"};

constexpr std::pair<std::string_view, QueryMode> kModes[] = {
    {"static", QueryMode::kStatic},
    {"swept", QueryMode::kSwept},
    {"paper_static", QueryMode::kPaperStatic},
    {"paper_swept", QueryMode::kPaperSwept},
    {"paper_naive", QueryMode::kPaperNaive}};

QueryMode mode_of(const Cells& cells, const TextReader& text) {
  for (const auto& [name, mode] : kModes) {
    if (cells[kMode] == name) return mode;
  }
  throw text.error("mode is " + in_quotes(cells[kMode]) +
                   "; legal are static, swept, paper_static, paper_swept and paper_naive");
}

double number(std::size_t column, const Cells& cells, const TextReader& text) {
  const std::optional<double> value = parse_number(cells[column]);
  if (value && std::isfinite(*value)) return *value;
  throw text.error(std::string(kColumns[column]) + " is " + in_quotes(cells[column]) +
                   "; must be a " + (value ? "finite number" : "number"));
}

Eigen::Vector3d point(std::size_t column, const Cells& cells, const TextReader& text) {
  return {number(column, cells, text), number(column + 1, cells, text),
          number(column + 2, cells, text)};
}

Motion motion_of(const Cells& cells, const TextReader& text) {
  if (cells.size() != kColumns.size()) {
    throw text.error(std::to_string(cells.size()) + " columns; must be " +
                     std::to_string(kColumns.size()));
  }
  if (cells[kQuery].empty()) throw text.error("query is empty; must be a number or a name");

  Motion motion;
  motion.query = cells[kQuery];
  motion.line = text.number();
  motion.mode = mode_of(cells, text);
  const Eigen::Vector3d trocar = point(kTrocar, cells, text);
  const ShaftAxis end{trocar, point(kTip, cells, text)};
  if (is_static_mode(motion.mode)) {
    motion.path = {{1.0, end}};
  } else {
    motion.path = {{0.0, {trocar, point(kPrevious, cells, text)}}, {1.0, end}};
  }
  motion.radius = number(kRadius, cells, text);
  if (!(motion.radius > 0.0)) {
    throw text.error("radius is " + in_quotes(cells[kRadius]) + "; must be above 0");
  }
  return motion;
}

bool is_header(const Cells& cells) { return cells[0] == kColumns[0]; }

void check_header(const Cells& cells, const TextReader& text) {
  if (std::equal(cells.begin(), cells.end(), kColumns.begin(), kColumns.end())) return;
  std::string legal;
  for (const std::string_view column : kColumns)
    legal += (legal.empty() ? "" : ",") + std::string(column);
  throw text.error("header is " + in_quotes(text.line()) + "; must be " + legal);
}

bool all_integers(const std::vector<Motion>& motions) {
  return std::all_of(motions.begin(), motions.end(),
                     [](const Motion& motion) { return parse_integer(motion.query).has_value(); });
}

void sort_by_query(std::vector<Motion>& motions, const std::string& file) {
  const bool by_value = all_integers(motions);
  const auto before = [by_value](const Motion& a, const Motion& b) {
    return by_value ? *parse_integer(a.query) < *parse_integer(b.query) : a.query < b.query;
  };
  std::stable_sort(motions.begin(), motions.end(), before);
  const auto same = std::adjacent_find(
      motions.begin(), motions.end(),
      [&](const Motion& a, const Motion& b) { return !before(a, b) && !before(b, a); });
  if (same == motions.end()) return;
  throw InputError(file, std::next(same)->line,
                   "query " + in_quotes(std::next(same)->query) + " is already on line " +
                       std::to_string(same->line) + "; each motion needs its own");
}

}  // namespace

std::vector<Motion> read_motions(const std::string& file) {
  TextReader text(file);
  std::vector<Motion> motions;
  bool first = true;
  while (text.next()) {
    if (text.line().empty()) continue;
    const Cells cells = split_cells(text.line());
    if (first && is_header(cells)) {
      check_header(cells, text);
    } else {
      motions.push_back(motion_of(cells, text));
    }
    first = false;
  }
  if (motions.empty()) throw text.error("the file ends without a motion; must have at least one");
  sort_by_query(motions, file);
  return motions;
}

}  // namespace organ_collision
