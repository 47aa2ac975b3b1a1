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

/// Reads the lines of a text file, or of standard input. Line ends may be those of Unix or Windows;
/// the last line may have none. Blank lines are left out. Standard input may be a pipe, also one
/// that does not block. (std::getline cannot tell whether a whole line has arrived.)
class TextReader {
 public:
  /// `file`: "-" is standard input. Throws InputError when the file cannot be opened.
  explicit TextReader(const std::string& file);
  ~TextReader();
  TextReader(const TextReader&) = delete;
  TextReader& operator=(const TextReader&) = delete;

  /// Goes to the next line that is not blank, and waits for it. Returns false after the last one.
  /// Throws InputError when reading fails.
  bool next();
  /// Whether next() returns without waiting: a whole line, or the end of the input, has arrived.
  /// Throws what next() throws.
  bool is_ready() { return find_line(0); }

  /// The current line, without its line end and without blanks around it, until the next call of
  /// next() or is_ready().
  std::string_view line() const { return line_; }
  /// The number of the current line, from 1. After the end, it is that of the last line, or 1 if
  /// the file is empty.
  std::size_t number() const { return std::max<std::size_t>(number_, 1); }
  /// Whether the current line is the last one and has no line feed.
  bool ends_within_line() const { return ends_within_line_; }

  /// The file, or "standard input".
  const std::string& name() const { return file_; }
  /// An error that names the current line.
  InputError error(const std::string& message) const { return {file_, number(), message}; }

 private:
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
  std::string_view line_;
  std::size_t number_ = 0;
  bool ends_within_line_ = false;
};

/// The motion of a tool, and the kind of query: one line of a motions file.
struct Motion {
  std::string query;     ///< the name of the query, which is printed with its contacts
  std::size_t line = 0;  ///< the line from which it was read, from 1
  QueryMode mode = QueryMode::kStatic;
  Eigen::Vector3d trocar;           ///< [m] at the end; in the mesh's frame, as all points
  Eigen::Vector3d previous_trocar;  ///< [m] at the start; by default, the trocar rests
  Eigen::Vector3d previous;  ///< [m] the tip at the start; the same as `tip` in the static modes
  Eigen::Vector3d tip;       ///< [m] the tip at the end
  double radius = 0.0;       ///< [m] the radius of the shaft
};

/// The request about a motion, in the mode of the motion. The paper's modes ask for nothing else.
CollisionRequest request_of(const Motion& motion, const AskedOrgan& organ, QueryOptions asked = {});

/// The motions of a CSV file, or of standard input, in the order in which they are answered. The
/// columns are query, mode, trocar_x, trocar_y, trocar_z, previous_x, previous_y, previous_z,
/// tip_x, tip_y, tip_z, radius, in this order. Where the trocar was at the start may follow:
/// previous_trocar_x, previous_trocar_y, previous_trocar_z. A header line may come first; blank
/// lines are skipped. Modes: static, swept, paper_static, paper_swept, paper_naive. The static
/// modes ignore the previous tip, which may be left empty.
class Motions {
 public:
  /// kByQuery: sorted by the queries, as numbers if all are integers, else as text.
  enum class Order { kByQuery, kAsInFile };

  /// A file is read to its end, before the first motion is answered. It takes about 150 bytes of
  /// memory for each motion. Throws InputError if the file is missing, is not legal or has no
  /// motion, or if two motions have the same query. If `file` is "-", the motions come from
  /// standard input, in its order, and are read when they are asked for.
  Motions(const std::string& file, Order order);

  /// The next motion, or none after the last one. May wait for a line of standard input. Throws
  /// InputError if the line is not legal, or if standard input has no motion at all.
  std::optional<Motion> next();
  /// Whether next() returns without waiting.
  bool is_ready() { return order_ || text_.is_ready(); }
  /// How many motions there are, if that is known.
  std::optional<std::size_t> count() const;
  const TextReader& text() const { return text_; }

 private:
  void read_all(Order order);
  std::optional<Motion> read();
  Motion motion() const;
  double number(std::size_t column) const;
  Eigen::Vector3d point(std::size_t column) const;
  bool is_header() const;

  TextReader text_;
  std::vector<std::string_view> cells_;  ///< the cells of the current line
  bool at_first_ = true;                 ///< whether no line was read yet
  bool has_motion_ = false;              ///< whether a motion was read

  std::deque<Motion> motions_;  ///< all those of a file, in its order
  /// The indices of the motions of a file in the order asked for; none: this is standard input.
  std::optional<std::vector<std::size_t>> order_;
  std::size_t next_ = 0;  ///< the place in order_ of the next motion
};

}  // namespace organ_collision
