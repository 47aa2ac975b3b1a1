#pragma once

#include <cstddef>

#include "test/rostest/load/findings.hpp"

namespace organ_collision::stress {

/// A user who resets, reloads tools, and changes parameters and organs while the node runs. Each
/// function is for a thread of its own.
class Operator {
 public:
  explicit Operator(Findings& findings) : findings_(findings) {}

  void reset();
  /// Exchanges some of the tools.
  void reload_tools();
  /// Gives the tools of stress.test back to the node. The other functions must have ended.
  void restore_tools();
  void change_parameters();
  void remove_organ();

 private:
  void reload();

  Findings& findings_;
  std::size_t reloads_ = 0, changes_ = 0;
};

}  // namespace organ_collision::stress
