#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/program/user_input.hpp"
#include "query/make_request.hpp"

namespace organ_collision {

/// The motion of a tool, and the kind of query: one line of a motions file.
struct Motion {
  std::string query;                ///< its name, which is printed with its contacts
  std::optional<long long> number;  ///< the name as an integer, if it is one
  std::size_t line = 0;             ///< the line from which it was read, from 1
  QueryMode mode = QueryMode::kStatic;
  Eigen::Vector3d trocar;           ///< [m] at the end; in the mesh's frame, as all points
  Eigen::Vector3d previous_trocar;  ///< [m] at the start; by default, the trocar rests
  Eigen::Vector3d previous;  ///< [m] the tip at the start; the same as `tip` in the static modes
  Eigen::Vector3d tip;       ///< [m] the tip at the end
  double radius = 0.0;       ///< [m] the radius of the shaft
};

/// The request about a motion, in the mode of the motion. The paper's modes ask for nothing else.
CollisionRequest request_of(const Motion& motion, const AskedOrgan& organ, QueryOptions asked = {});

/// The motions of a CSV file, sorted by their queries, or those of standard input, in its order.
/// The columns are query, mode, trocar_x, trocar_y, trocar_z, previous_x, previous_y, previous_z,
/// tip_x, tip_y, tip_z, radius, in this order. Where the trocar was at the start may follow:
/// previous_trocar_x, previous_trocar_y, previous_trocar_z. A header line may come first; blank
/// lines are skipped. Modes: static, swept, paper_static, paper_swept, paper_naive. The static
/// modes ignore the previous tip, which may be left empty.
///
/// Line ends may be those of Unix or Windows; the last line may have none. Standard input may be a
/// pipe, also one that does not block. (std::getline cannot tell whether a whole line has arrived.)
class Motions {
 public:
  /// A file is read to its end. Queries are sorted as numbers if all are integers, else as text.
  /// Throws InputError if the file is missing, is not legal or has no motion, or if two motions
  /// have the same query. If `file` is "-", the motions come from standard input, and are read when
  /// they are asked for.
  explicit Motions(const std::string& file);
  ~Motions();
  Motions(const Motions&) = delete;
  Motions& operator=(const Motions&) = delete;

  /// The next motion, or none after the last one. May wait for a line of standard input. Throws
  /// InputError if the line is not legal, or if standard input has no motion at all.
  std::optional<Motion> next();
  /// Whether next() returns without waiting.
  bool is_ready() { return count_ || find_line(0); }
  /// How many motions there are, if that is known.
  std::optional<std::size_t> count() const { return count_; }
  /// The file, or "standard input".
  const std::string& name() const { return file_; }
  /// Whether the last line of standard input has no line feed, so that its end may be missing.
  bool ends_within_line() const { return !count_ && ends_within_line_; }
  /// An error that names the line that was read last.
  InputError error(const std::string& message) const;

 private:
  void sort();
  std::optional<Motion> read();
  Motion motion() const;
  double number(std::size_t column) const;
  Eigen::Vector3d point(std::size_t column) const;
  bool is_header() const;

  bool find_line(int wait);
  void go_behind_line();
  bool read_piece(int wait);
  [[noreturn]] void fail(const std::string& what) const;

  std::string file_;
  int descriptor_;
  std::string buffer_;     ///< what was read; the next read erases the lines before begin_
  std::size_t begin_ = 0;  ///< where the first line begins that is not yet taken
  std::size_t end_ = 0;    ///< where it ends
  bool at_end_ = false;    ///< whether the input is read to its end
  bool ends_within_line_ = false;
  std::string_view line_;                ///< the current line, without blanks around it
  std::size_t number_ = 0;               ///< of the current line, from 1
  std::vector<std::string_view> cells_;  ///< the cells of the current line
  bool at_first_ = true;                 ///< whether no line was read yet
  bool has_motion_ = false;              ///< whether a motion was read

  std::deque<Motion> motions_;        ///< those of a file that are not yet taken
  std::optional<std::size_t> count_;  ///< none: this is standard input
};

}  // namespace organ_collision
