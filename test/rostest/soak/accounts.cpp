#include "accounts.hpp"

#include <algorithm>
#include <cstdlib>

namespace organ_collision::soak {
namespace {

bool is_count(const std::string& value) {
  return !value.empty() &&
         std::all_of(value.begin(), value.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool tells_counts(const std::string& task) {
  const auto ends_with = [&](const std::string& end) {
    return task.size() >= end.size() && task.substr(task.size() - end.size()) == end;
  };
  return ends_with(": queries") || ends_with(": messages");
}

}  // namespace

void Accounts::add(const diagnostic_msgs::DiagnosticArray& message) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    if (!tells_counts(status.name)) continue;
    for (const diagnostic_msgs::KeyValue& pair : status.values) {
      if (is_count(pair.value)) counts_[pair.key] = std::strtoull(pair.value.c_str(), nullptr, 10);
    }
  }
}

std::string Accounts::wrong_sum(std::uint64_t tools) const {
  if (count("organ messages received") !=
      count("organ messages applied") + count("organ messages that remove") +
          count("organ messages refused") + count("organ messages dropped behind a large mesh") +
          count("organ messages waiting")) {
    return "the node's counts of organ messages do not add up";
  }
  if (count("shapes due") != tools * count("organ messages applied")) {
    return "not every accepted shape became due for each tool";
  }
  if (count("shapes due") != count("shapes answered") + count("shapes superseded by newer ones") +
                                 count("shapes forgotten before their step") +
                                 count("shapes waiting")) {
    return "the node's counts of shapes do not add up";
  }
  return "";
}

std::uint64_t Accounts::count(const std::string& key) const {
  const auto found = counts_.find(key);
  return found == counts_.end() ? 0 : found->second;
}

}  // namespace organ_collision::soak
