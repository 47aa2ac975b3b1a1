#pragma once

#include <cstddef>

#include "test/rostest/load/findings.hpp"

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

}  // namespace organ_collision::stress
