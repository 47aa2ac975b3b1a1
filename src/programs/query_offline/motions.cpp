#include "motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "geometry/concatenate.hpp"
#include "query/request_check.hpp"

namespace organ_collision {

CollisionRequest request_of(const Motion& motion, const AskedOrgan& organ, QueryOptions asked) {
  ToolPath path;
  if (!is_static_mode(motion.mode)) path = {{0.0, {motion.previous_trocar, motion.previous}}};
  path.push_back({1.0, {motion.trocar, motion.tip}});
  if (is_paper_mode(motion.mode)) asked = {};
  asked.mode = motion.mode;
  return make_request(organ, {motion.radius}, asked, std::move(path));
}

namespace {

enum Column {
  kQuery,
  kMode,
  kTrocar,
  kPrevious = kTrocar + 3,
  kTip = kPrevious + 3,
  kRadius = 11,
  kPreviousTrocar
};

constexpr std::array<std::string_view, 15> kColumns = {"query",
                                                       "mode",
                                                       "trocar_x",
                                                       "trocar_y",
                                                       "trocar_z",
                                                       "previous_x",
                                                       "previous_y",
                                                       "previous_z",
                                                       "tip_x",
                                                       "tip_y",
                                                       "tip_z",
                                                       "radius",
                                                       "previous_trocar_x",
                                                       "previous_trocar_y",
                                                       "previous_trocar_z"};
/// The number of columns if the trocars rest.
constexpr std::size_t kFewestColumns = kPreviousTrocar;

bool is_legal_count(std::size_t columns) {
  return columns == kFewestColumns || columns == kColumns.size();
}

constexpr std::pair<std::string_view, QueryMode> kModes[] = {
    {"static", QueryMode::kStatic},
    {"swept", QueryMode::kSwept},
    {"paper_static", QueryMode::kPaperStatic},
    {"paper_swept", QueryMode::kPaperSwept},
    {"paper_naive", QueryMode::kPaperNaive}};

/// Throws std::invalid_argument if CollisionQuery would refuse the motion, whatever the organ is.
/// The message names the value and what is legal.
void check_motion(const Motion& motion) {
  static const TriangleMesh any_organ({0.0F, 0.0F, 0.0F}, {0, 0, 0});
  const CollisionRequest request = request_of(motion, {&any_organ});
  check(request);
  if (is_paper_mode(motion.mode)) paper_volume(request);
}

}  // namespace

/// The motion in the next line that has one.
std::optional<Motion> Motions::read() {
  while (text_.next()) {
    split_cells(text_.line(), cells_);
    if (std::exchange(at_first_, false) && is_header()) continue;
    has_motion_ = true;
    return motion();
  }
  if (has_motion_) return std::nullopt;
  throw text_.error("the file ends without a motion; must have at least one");
}

/// The motion in the current line.
Motion Motions::motion() const {
  if (!is_legal_count(cells_.size())) {
    throw text_.error(concatenate(cells_.size(), " columns; must be ", kFewestColumns, ", or ",
                                  kColumns.size(), " with the previous trocar"));
  }
  if (cells_[kQuery].empty()) throw text_.error("query is empty; must be a number or a name");

  Motion motion;
  motion.query = cells_[kQuery];
  motion.line = text_.number();
  const auto* const mode =
      std::find_if(std::begin(kModes), std::end(kModes),
                   [&](const auto& known) { return known.first == cells_[kMode]; });
  if (mode == std::end(kModes)) {
    throw text_.error("mode is " + in_quotes(cells_[kMode]) +
                      "; legal are static, swept, paper_static, paper_swept and paper_naive");
  }
  motion.mode = mode->second;
  motion.trocar = point(kTrocar);
  motion.tip = point(kTip);
  const bool is_static = is_static_mode(motion.mode);
  motion.previous = is_static ? motion.tip : point(kPrevious);
  const bool rests = is_static || cells_.size() == kFewestColumns;
  motion.previous_trocar = rests ? motion.trocar : point(kPreviousTrocar);
  motion.radius = number(kRadius);
  if (!(motion.radius > 0.0)) {
    throw text_.error("radius is " + in_quotes(cells_[kRadius]) + "; must be above 0");
  }
  try {
    check_motion(motion);
  } catch (const std::invalid_argument& error) {
    throw text_.error(error.what());
  }
  return motion;
}

double Motions::number(std::size_t column) const {
  const std::optional<double> value = parse_number(cells_[column]);
  if (value && std::isfinite(*value)) return *value;
  throw text_.error(std::string(kColumns[column]) + " is " + in_quotes(cells_[column]) +
                    "; must be a " + (value ? "finite number" : "number"));
}

Eigen::Vector3d Motions::point(std::size_t column) const {
  return {number(column), number(column + 1), number(column + 2)};
}

/// Whether the current line is the header. Throws InputError if it is another header.
bool Motions::is_header() const {
  if (cells_[kQuery] != kColumns[kQuery]) return false;
  if (is_legal_count(cells_.size()) && std::equal(cells_.begin(), cells_.end(), kColumns.begin())) {
    return true;
  }
  std::string legal;
  for (std::size_t i = 0; i < kFewestColumns; ++i) {
    legal += (legal.empty() ? "" : ",") + std::string(kColumns[i]);
  }
  throw text_.error("header is " + in_quotes(text_.line()) + "; must be " + legal +
                    ", and perhaps previous_trocar_x,previous_trocar_y,previous_trocar_z");
}

Motions::Motions(const std::string& file, Order order)
    : text_(file == "-" ? TextReader(StandardInput{}) : TextReader(file)) {
  if (file != "-") read_all(order);
}

void Motions::read_all(Order order) {
  std::vector<long long> values;  // the values of those queries that are integers
  while (std::optional<Motion> motion = read()) {
    if (const auto value = parse_integer(motion->query)) values.push_back(*value);
    motions_.push_back(std::move(*motion));
  }
  order_.emplace(motions_.size());
  std::iota(order_->begin(), order_->end(), std::size_t{0});
  const bool all_integers = values.size() == motions_.size();
  const auto is_before = [&](std::size_t a, std::size_t b) {
    return all_integers ? values[a] < values[b] : motions_[a].query < motions_[b].query;
  };
  std::vector<std::size_t> sorted = *order_;
  std::stable_sort(sorted.begin(), sorted.end(), is_before);
  const auto same = std::adjacent_find(
      sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) { return !is_before(a, b); });
  if (same != sorted.end()) {
    const Motion &first = motions_[*same], &second = motions_[*std::next(same)];
    throw InputError(text_.name(), second.line,
                     concatenate("query ", in_quotes(second.query), " is already on line ",
                                 first.line, "; each motion needs its own"));
  }
  if (order == Order::kByQuery) order_ = std::move(sorted);
}

std::optional<Motion> Motions::next() {
  if (!order_) return read();
  if (next_ == order_->size()) return std::nullopt;
  return motions_[(*order_)[next_++]];
}

std::optional<std::size_t> Motions::count() const {
  return order_ ? std::optional(order_->size()) : std::nullopt;
}

}  // namespace organ_collision
