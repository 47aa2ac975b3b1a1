#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motion_source.hpp"
#include "text_reader.hpp"

namespace organ_collision {

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
  /// Whether a line that is not blank has arrived, or the end.
  bool is_ready() override;
  const std::string& name() const override { return text_.name(); }
  /// After the end: whether the last line has no line feed, as if the rest of it were missing.
  bool ends_within_line() const { return text_.ends_within_line(); }
  /// The number of the current line, from 1.
  std::size_t line_number() const { return text_.number(); }

 private:
  /// What next() will take.
  enum class Ahead { kNothingYet, kLine, kEnd };

  void read_line();
  bool next_line();
  Motion motion() const;
  QueryMode mode() const;
  double number(std::size_t column) const;
  Eigen::Vector3d point(std::size_t column) const;
  bool is_header() const;

  TextReader text_;
  Ahead ahead_ = Ahead::kNothingYet;
  std::vector<std::string_view> cells_;  ///< of the current line
  bool at_first_ = true;                 ///< whether no line but blank ones was read
  bool has_motion_ = false;              ///< whether a motion was read
};

}  // namespace organ_collision
