#include "topic_names.hpp"

#include <algorithm>

namespace organ_collision {
namespace {

// Not std::isalpha() and std::isalnum(): they depend on the locale.
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_legal(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

std::string graph_name(std::string name, const std::string& prefix) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !is_legal(c); }, '_');
  return !name.empty() && is_letter(name.front()) ? name : prefix + name;
}

}  // namespace

std::string tool_graph_name(const std::string& tool) { return graph_name(tool, "tool_"); }

std::string pair_graph_name(const std::string& organ, const std::string& tool) {
  return graph_name(organ, "organ_") + "/" + tool_graph_name(tool);
}

}  // namespace organ_collision
