#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>

#include <cstdint>
#include <map>
#include <string>

namespace organ_collision::soak {

/// What the node itself counts, as /diagnostics tells it (doc/interface.md).
class Accounts {
 public:
  void add(const diagnostic_msgs::DiagnosticArray& message);

  /// Which sum is wrong; empty: none is. `tools`: how many the node has.
  std::string wrong_sum(std::uint64_t tools) const;
  /// 0 if the node has not told it.
  std::uint64_t count(const std::string& key) const;
  const std::map<std::string, std::uint64_t>& counts() const { return counts_; }

 private:
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace organ_collision::soak
