#include "motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "query/request_check.hpp"

namespace organ_collision {

ToolPath path_of(const Motion& motion) {
  const ShaftAxis end{motion.trocar, motion.tip};
  if (is_static_mode(motion.mode)) return {{1.0, end}};
  return {{0.0, {motion.trocar, motion.previous}}, {1.0, end}};
}

void check(const Motion& motion) {
  static const TriangleMesh any_organ({0.0F, 0.0F, 0.0F}, {0, 0, 0});
  CollisionRequest request;
  request.organ = &any_organ;
  request.path = path_of(motion);
  request.radius = motion.radius;
  request.mode = motion.mode;
  check(request);
  if (is_paper_mode(motion.mode)) paper_volume(request);
}

namespace {

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

}  // namespace

std::optional<Motion> MotionReader::next() {
  while (next_line()) {
    split_cells(text_.line(), cells_);
    if (std::exchange(at_first_, false) && is_header()) continue;
    has_motion_ = true;
    return motion();
  }
  if (has_motion_) return std::nullopt;
  throw text_.error("the file ends without a motion; must have at least one");
}

bool MotionReader::is_ready() {
  while (ahead_ == Ahead::kNothingYet && text_.is_ready()) read_line();
  return ahead_ != Ahead::kNothingYet;
}

/// Goes to the next line, and waits for it. Blank lines are left out.
void MotionReader::read_line() {
  if (!text_.next()) {
    ahead_ = Ahead::kEnd;
  } else if (!text_.line().empty()) {
    ahead_ = Ahead::kLine;
  }
}

/// Goes to the next line that is not blank, and waits for it. Returns false after the last one.
bool MotionReader::next_line() {
  while (ahead_ == Ahead::kNothingYet) read_line();
  if (ahead_ == Ahead::kEnd) return false;
  ahead_ = Ahead::kNothingYet;
  return true;
}

/// The motion in the current line.
Motion MotionReader::motion() const {
  if (cells_.size() != kColumns.size()) {
    throw text_.error(std::to_string(cells_.size()) + " columns; must be " +
                      std::to_string(kColumns.size()));
  }
  if (cells_[kQuery].empty()) throw text_.error("query is empty; must be a number or a name");

  Motion motion;
  motion.query = cells_[kQuery];
  motion.line = text_.number();
  motion.mode = mode();
  motion.trocar = point(kTrocar);
  motion.tip = point(kTip);
  motion.previous = is_static_mode(motion.mode) ? motion.tip : point(kPrevious);
  motion.radius = number(kRadius);
  if (!(motion.radius > 0.0)) {
    throw text_.error("radius is " + in_quotes(cells_[kRadius]) + "; must be above 0");
  }
  try {
    check(motion);
  } catch (const std::invalid_argument& error) {
    throw text_.error(error.what());
  }
  return motion;
}

QueryMode MotionReader::mode() const {
  for (const auto& [name, mode] : kModes) {
    if (cells_[kMode] == name) return mode;
  }
  throw text_.error("mode is " + in_quotes(cells_[kMode]) +
                    "; legal are static, swept, paper_static, paper_swept and paper_naive");
}

double MotionReader::number(std::size_t column) const {
  const std::optional<double> value = parse_number(cells_[column]);
  if (value && std::isfinite(*value)) return *value;
  throw text_.error(std::string(kColumns[column]) + " is " + in_quotes(cells_[column]) +
                    "; must be a " + (value ? "finite number" : "number"));
}

Eigen::Vector3d MotionReader::point(std::size_t column) const {
  return {number(column), number(column + 1), number(column + 2)};
}

/// Whether the current line is the header. Throws InputError if it is another header.
bool MotionReader::is_header() const {
  if (cells_[kQuery] != kColumns[kQuery]) return false;
  if (std::equal(cells_.begin(), cells_.end(), kColumns.begin(), kColumns.end())) return true;
  std::string legal;
  for (const std::string_view column : kColumns) {
    legal += (legal.empty() ? "" : ",") + std::string(column);
  }
  throw text_.error("header is " + in_quotes(text_.line()) + "; must be " + legal);
}

MotionList::MotionList(std::string file, Order order) : file_(std::move(file)) {
  MotionReader reader(file_);
  while (std::optional<Motion> motion = reader.next()) motions_.push_back(std::move(*motion));

  const bool all_integers = std::all_of(motions_.begin(), motions_.end(), [](const Motion& motion) {
    return parse_integer(motion.query).has_value();
  });
  const auto text = [](const Motion& motion) { return std::string_view(motion.query); };
  const auto value = [](const Motion& motion) { return *parse_integer(motion.query); };
  order_ = all_integers ? sorted_by(value) : sorted_by(text);
  if (order == Order::kAsInFile) std::iota(order_.begin(), order_.end(), std::size_t{0});
}

std::optional<Motion> MotionList::next() {
  if (next_ == order_.size()) return std::nullopt;
  return motions_[order_[next_++]];
}

/// The indices of all motions by rising `key`. Throws InputError if two keys are equal.
template <typename Key>
std::vector<std::size_t> MotionList::sorted_by(const Key& key) const {
  std::vector<std::pair<decltype(key(motions_[0])), std::size_t>> keys;
  keys.reserve(motions_.size());
  for (const Motion& motion : motions_) keys.emplace_back(key(motion), keys.size());
  std::sort(keys.begin(), keys.end());
  const auto same = std::adjacent_find(
      keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  if (same != keys.end()) {
    const Motion &first = motions_[same->second], &second = motions_[std::next(same)->second];
    throw InputError(file_, second.line,
                     "query " + in_quotes(second.query) + " is already on line " +
                         std::to_string(first.line) + "; each motion needs its own");
  }
  std::vector<std::size_t> order;
  order.reserve(keys.size());
  for (const auto& [unused, index] : keys) order.push_back(index);
  return order;
}

}  // namespace organ_collision
