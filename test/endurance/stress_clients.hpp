#pragma once

#include <cstddef>

#include "load.hpp"

namespace organ_collision::stress {

/// A client of the node's services that asks something else each time, and checks the answers.
class QueryClient {
 public:
  QueryClient(std::size_t number, Findings& findings);

  /// A query of a motion or of a tool, static or swept, with or without clearance and placement.
  void ask_query();
  /// A batch of motions, of a shaft or of a tool of links.
  void ask_batch();
  void list_organs();

 private:
  std::size_t number_;
  Findings& findings_;
  std::size_t asked_ = 0;
};

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
