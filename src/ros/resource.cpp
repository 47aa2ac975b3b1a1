#include "organ_collision/ros/resource.hpp"

#include <resource_retriever/retriever.h>

#include <fstream>
#include <sstream>

#include "organ_collision/ros/tool_error.hpp"

namespace organ_collision {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw ToolError("cannot read '" + name + "': " + why);
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, "there is no such file, or it may not be read");
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

bool begins_with(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

/// Others are left out: resource_retriever waits without limit for a server that does not answer.
bool is_url(const std::string& name) {
  return begins_with(name, "package://") || begins_with(name, "file://");
}

std::string read_url(const std::string& url) {
  try {
    const resource_retriever::MemoryResource found = resource_retriever::Retriever().get(url);
    return {found.data.get(), found.data.get() + found.size};
  } catch (const resource_retriever::Exception& error) {
    throw ToolError(error.what());  // Names the URL.
  }
}

}  // namespace

std::string read_resource(const std::string& name) {
  const bool is_path = begins_with(name, "/");
  if (!is_path && !is_url(name)) {
    refuse(name, "must be an absolute path, or begin with package:// or file://");
  }
  std::string content = is_path ? read_file(name) : read_url(name);
  if (content.empty()) refuse(name, "it is empty, or a folder");
  return content;
}

}  // namespace organ_collision
