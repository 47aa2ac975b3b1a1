#include "motions.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <iterator>
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

constexpr std::size_t kPiece = 1 << 16;  // [bytes] read at once, at most

enum Column {
  kQuery,
  kMode,
  kTrocar,
  kPrevious = kTrocar + 3,
  kTip = kPrevious + 3,
  kRadius = kTip + 3,
  kPreviousTrocar,
  kColumns = kPreviousTrocar + 3
};

/// The names of all columns. If the trocars rest, the last three may be missing.
constexpr std::string_view kNames =
    "query,mode,trocar_x,trocar_y,trocar_z,previous_x,previous_y,previous_z,tip_x,tip_y,tip_z,"
    "radius,previous_trocar_x,previous_trocar_y,previous_trocar_z";

std::vector<std::string_view> column_names() {
  std::vector<std::string_view> names;
  split_cells(kNames, names);
  return names;
}

bool is_legal_count(std::size_t columns) {
  return columns == kPreviousTrocar || columns == kColumns;
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

Motions::Motions(const std::string& file)
    : file_(file == "-" ? "standard input" : file),
      descriptor_(file == "-" ? STDIN_FILENO : open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0) fail("cannot be opened");
  if (file == "-") return;
  while (std::optional<Motion> motion = read()) motions_.push_back(std::move(*motion));
  sort();
  count_ = motions_.size();
}

Motions::~Motions() {
  if (descriptor_ != STDIN_FILENO) close(descriptor_);
}

void Motions::sort() {
  const bool all_integers =
      std::all_of(motions_.begin(), motions_.end(), [](const Motion& m) { return m.number; });
  const auto is_before = [&](const Motion& a, const Motion& b) {
    return all_integers ? a.number < b.number : a.query < b.query;
  };
  std::sort(motions_.begin(), motions_.end(), [&](const Motion& a, const Motion& b) {
    return is_before(a, b) || (!is_before(b, a) && a.line < b.line);
  });
  const auto first =
      std::adjacent_find(motions_.begin(), motions_.end(),
                         [&](const Motion& a, const Motion& b) { return !is_before(a, b); });
  if (first == motions_.end()) return;
  const Motion& second = *std::next(first);
  throw InputError(file_, second.line,
                   concatenate("query ", in_quotes(second.query), " is already on line ",
                               first->line, "; each motion needs its own"));
}

std::optional<Motion> Motions::next() {
  if (!count_) return read();
  if (motions_.empty()) return std::nullopt;
  Motion motion = std::move(motions_.front());
  motions_.pop_front();
  return motion;
}

InputError Motions::error(const std::string& message) const {
  return {file_, std::max<std::size_t>(number_, 1), message};
}

/// Makes the next line that is not blank the current one. At the end of the file, it is empty.
/// Returns false if the line has not arrived after `wait` [ms].
bool Motions::find_line(int wait) {
  while (true) {
    end_ = std::min(buffer_.find('\n', begin_), buffer_.size());
    if (end_ == buffer_.size() && !at_end_) {
      if (!read_piece(wait)) return false;
      continue;
    }
    line_ = std::string_view(buffer_).substr(begin_, end_ - begin_);
    if (number_ == 0) line_ = without_byte_order_mark(line_);
    line_ = trimmed(line_);
    if (!line_.empty() || begin_ == buffer_.size()) return true;
    go_behind_line();
  }
}

void Motions::go_behind_line() {
  ++number_;
  begin_ = std::min(end_ + 1, buffer_.size());
}

/// Reads what has arrived. Waits for it, because read() fails if the pipe does not block, but at
/// most for `wait` [ms]. Returns false if nothing has arrived.
bool Motions::read_piece(int wait) {
  pollfd wanted{descriptor_, POLLIN, 0};
  const int ready = TEMP_FAILURE_RETRY(poll(&wanted, 1, wait));
  if (ready == 0) return false;
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t size = buffer_.size();
  buffer_.resize(size + kPiece);
  const ssize_t count = TEMP_FAILURE_RETRY(::read(descriptor_, &buffer_[size], kPiece));
  if (ready < 0 || count < 0) fail("cannot be read");
  buffer_.resize(size + static_cast<std::size_t>(count));
  at_end_ = count == 0;
  return true;
}

void Motions::fail(const std::string& what) const {
  throw InputError(file_ + ": " + what + ": " + std::strerror(errno));
}

/// The motion in the next line that has one.
std::optional<Motion> Motions::read() {
  constexpr int kForEver = -1;
  while (find_line(kForEver), !line_.empty()) {
    ends_within_line_ = end_ == buffer_.size();
    go_behind_line();
    split_cells(line_, cells_);
    if (std::exchange(at_first_, false) && is_header()) continue;
    has_motion_ = true;
    return motion();
  }
  if (has_motion_) return std::nullopt;
  throw error("the file ends without a motion; must have at least one");
}

/// The motion in the current line.
Motion Motions::motion() const {
  if (!is_legal_count(cells_.size())) {
    throw error(concatenate(cells_.size(), " columns; must be ", int{kPreviousTrocar}, ", or ",
                            int{kColumns}, " with the previous trocar"));
  }
  if (cells_[kQuery].empty()) throw error("query is empty; must be a number or a name");

  Motion motion;
  motion.query = cells_[kQuery];
  motion.number = parse_integer(motion.query);
  motion.line = number_;
  const auto* const mode =
      std::find_if(std::begin(kModes), std::end(kModes),
                   [&](const auto& known) { return known.first == cells_[kMode]; });
  if (mode == std::end(kModes)) {
    throw error("mode is " + in_quotes(cells_[kMode]) +
                "; legal are static, swept, paper_static, paper_swept and paper_naive");
  }
  motion.mode = mode->second;
  motion.trocar = point(kTrocar);
  motion.tip = point(kTip);
  const bool is_static = is_static_mode(motion.mode);
  motion.previous = is_static ? motion.tip : point(kPrevious);
  const bool rests = is_static || cells_.size() == kPreviousTrocar;
  motion.previous_trocar = rests ? motion.trocar : point(kPreviousTrocar);
  motion.radius = number(kRadius);
  if (!(motion.radius > 0.0)) {
    throw error("radius is " + in_quotes(cells_[kRadius]) + "; must be above 0");
  }
  try {
    check_motion(motion);
  } catch (const std::invalid_argument& refusal) {
    throw error(refusal.what());
  }
  return motion;
}

double Motions::number(std::size_t column) const {
  const std::optional<double> value = parse_number(cells_[column]);
  if (value && std::isfinite(*value)) return *value;
  throw error(std::string(column_names()[column]) + " is " + in_quotes(cells_[column]) +
              "; must be a " + (value ? "finite number" : "number"));
}

Eigen::Vector3d Motions::point(std::size_t column) const {
  return {number(column), number(column + 1), number(column + 2)};
}

/// Whether the current line is the header. Throws InputError if it is another header.
bool Motions::is_header() const {
  const std::vector<std::string_view> names = column_names();
  if (cells_[kQuery] != names[kQuery]) return false;
  if (is_legal_count(cells_.size()) && std::equal(cells_.begin(), cells_.end(), names.begin())) {
    return true;
  }
  const std::size_t required = kNames.find(",previous_trocar");
  throw error(concatenate("header is ", in_quotes(line_), "; must be ", kNames.substr(0, required),
                          ", and perhaps ", kNames.substr(required + 1)));
}

}  // namespace organ_collision
