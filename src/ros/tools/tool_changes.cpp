#include "tool_changes.hpp"

#include <algorithm>
#include <tuple>

#include "ros/interface/plain_text.hpp"

namespace organ_collision {
namespace {

template <typename Range, typename Same>
bool are_same(const Range& a, const Range& b, const Same& same) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

bool is_same(const ConvexCore& a, const ConvexCore& b) {
  return std::equal(a.points.begin(), a.points.begin() + a.count, b.points.begin(),
                    b.points.begin() + b.count) &&
         a.rim == b.rim;
}

bool is_same(const LinkPart& a, const LinkPart& b) {
  if (!a.surface != !b.surface || a.radius != b.radius) return false;
  if (!a.surface) return is_same(a.core, b.core);
  return a.surface->vertices() == b.surface->vertices() && a.surface->faces() == b.surface->faces();
}

bool is_same(const ToolParameters& a, const ToolParameters& b) {
  const auto members = [](const ToolParameters& p) {
    return std::tie(p.name, p.trocar_frame, p.tip_frame, p.radius, p.tip_pose_topic,
                    p.base_pose_topic, p.links, p.robot_description, p.urdf, p.tf_prefix, p.margin,
                    p.max_near, p.freedom);
  };
  return members(a) == members(b);
}

bool is_same(const Tool& a, const Tool& b) {
  const auto same_part = [](const LinkPart& c, const LinkPart& d) { return is_same(c, d); };
  const auto same_link = [&](const Link& c, const Link& d) {
    return c.name == d.name && are_same(c.parts, d.parts, same_part);
  };
  return is_same(a.parameters, b.parameters) && a.joints == b.joints && a.fault == b.fault &&
         are_same(a.links, b.links, same_link);
}

std::optional<std::size_t> find(const std::vector<Tool>& tools, const std::string& name) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    if (tools[i].parameters.name == name) return i;
  }
  return std::nullopt;
}

/// "changed: 'hook', 'probe'"; empty if there are no names.
std::string group(const std::string& what, const std::vector<std::string>& names) {
  return names.empty() ? "" : what + ": " + listed(names);
}

}  // namespace

ToolChanges compare_tools(const std::vector<Tool>& old_tools, const std::vector<Tool>& new_tools) {
  ToolChanges changes;
  std::vector<std::string> unchanged, changed, added, removed;
  for (const Tool& tool : new_tools) {
    const std::string name = "'" + tool.parameters.name + "'";
    const auto before = find(old_tools, tool.parameters.name);
    const bool is_kept = before && is_same(old_tools[*before], tool);
    changes.kept.push_back(is_kept ? before : std::nullopt);
    (is_kept ? unchanged : before ? changed : added).push_back(name);
  }
  for (const Tool& tool : old_tools) {
    if (!find(new_tools, tool.parameters.name)) removed.push_back("'" + tool.parameters.name + "'");
  }
  for (const std::string& part : {group("unchanged", unchanged), group("changed", changed),
                                  group("new", added), group("removed", removed)}) {
    if (part.empty()) continue;
    changes.summary += (changes.summary.empty() ? "" : "; ") + part;
  }
  if (changes.summary.empty()) changes.summary = "there are no tools";
  return changes;
}

}  // namespace organ_collision
