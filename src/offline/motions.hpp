#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "organ_collision/query/collision_query.hpp"
#include "text_reader.hpp"

namespace organ_collision {

/// The motion of a tool with a resting trocar, and the kind of query: one line of a motions file.
struct Motion {
  std::string query;     ///< the name of the query, which is printed with its contacts
  std::size_t line = 0;  ///< the line from which it was read, from 1
  QueryMode mode = QueryMode::kStatic;
  Eigen::Vector3d trocar;    ///< [m] in the mesh's frame, as `previous` and `tip`
  Eigen::Vector3d previous;  ///< [m] the tip at the start; the same as `tip` in the static modes
  Eigen::Vector3d tip;       ///< [m] the tip at the end
  double radius = 0.0;       ///< [m] the radius of the shaft
};

/// Where a tool was during its motion: one waypoint in the static modes, else two.
ToolPath path_of(const Motion& motion);

/// Gives motions in the order in which they are answered.
class MotionSource {
 public:
  virtual ~MotionSource() = default;

  /// The next motion, or none after the last one. May wait for it. Throws InputError if it is not
  /// legal.
  virtual std::optional<Motion> next() = 0;
  /// Whether next() returns without waiting.
  virtual bool is_ready() = 0;
  /// Where the motions come from, for messages.
  virtual const std::string& name() const = 0;
};

/// Reads motions, line by line, from a CSV file or from standard input. The columns are query,
/// mode, trocar_x, trocar_y, trocar_z, previous_x, previous_y, previous_z, tip_x, tip_y, tip_z,
/// radius, in this order. A header line may come first; blank lines are skipped. Modes: static,
/// swept, paper_static, paper_swept, paper_naive. The static modes ignore the previous tip, which
/// may be left empty.
class MotionReader : public MotionSource {
 public:
  /// Throws InputError when the file cannot be opened.
  explicit MotionReader(const std::string& file) : text_(file) {}
  explicit MotionReader(StandardInput input) : text_(input) {}

  /// The motion in the next line. Throws InputError if the line is not legal, or if there is no
  /// motion at all.
  std::optional<Motion> next() override;
  bool is_ready() override { return text_.is_ready(); }
  const std::string& name() const override { return text_.name(); }
  const TextReader& text() const { return text_; }

 private:
  Motion motion() const;
  double number(std::size_t column) const;
  Eigen::Vector3d point(std::size_t column) const;
  bool is_header() const;

  TextReader text_;
  std::vector<std::string_view> cells_;  ///< the cells of the current line
  bool at_first_ = true;                 ///< whether no line was read yet
  bool has_motion_ = false;              ///< whether a motion was read
};

/// All motions of a file (see MotionReader for its format). It takes about 150 bytes of memory for
/// each motion, because a file is checked to its end before the first motion is answered.
class MotionList : public MotionSource {
 public:
  /// kByQuery: sorted by the queries, as numbers if all are integers, else as text.
  enum class Order { kByQuery, kAsInFile };

  /// Throws InputError if the file is missing, is not legal or has no motion, or if two motions
  /// have the same query.
  MotionList(std::string file, Order order);

  std::size_t size() const { return motions_.size(); }

  std::optional<Motion> next() override;
  bool is_ready() override { return true; }
  const std::string& name() const override { return file_; }

 private:
  std::string file_;
  std::deque<Motion> motions_;      ///< in the order of the file
  std::vector<std::size_t> order_;  ///< the indices of the motions in the order asked for
  std::size_t next_ = 0;  ///< the next motion's place in order_; at the end, order_.size()
};

}  // namespace organ_collision
