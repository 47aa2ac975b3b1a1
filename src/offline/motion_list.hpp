#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "motion_source.hpp"

namespace organ_collision {

/// All motions of a file (see MotionReader for its format). It takes about 150 bytes of memory for
/// each motion, because a file is checked to its end before the first motion is answered.
class MotionList : public MotionSource {
 public:
  /// kByQuery: by value if all queries are integers, else as text.
  enum class Order { kByQuery, kAsInFile };

  /// Throws InputError if the file is missing, is not legal or has no motion, or if two motions
  /// have the same query.
  MotionList(std::string file, Order order);

  std::size_t size() const { return motions_.size(); }

  std::optional<Motion> next() override;
  bool is_ready() override { return true; }
  const std::string& name() const override { return file_; }

 private:
  template <typename Key>
  std::vector<std::size_t> sorted_by(const Key& key) const;

  std::string file_;
  std::deque<Motion> motions_;      ///< as in the file
  std::vector<std::size_t> order_;  ///< their indices in the order asked for
  std::size_t next_ = 0;            ///< a place in order_, or the number of motions
};

}  // namespace organ_collision
