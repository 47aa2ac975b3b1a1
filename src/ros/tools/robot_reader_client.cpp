#include "robot_reader_client.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "child_process.hpp"
#include "link_description.hpp"
#include "reader_limits.hpp"
#include "robot_reply.hpp"

namespace organ_collision {
namespace {

constexpr char kProgram[] = "robot_reader";

bool can_run(const std::filesystem::path& program) { return access(program.c_str(), X_OK) == 0; }

/// The folder of this library or, if the library is linked into a program, of the program.
std::filesystem::path folder_of_this_code() {
  Dl_info library{};
  dladdr(reinterpret_cast<const void*>(&folder_of_this_code), &library);
  std::filesystem::path file = library.dli_fname ? library.dli_fname : "";
  if (!file.has_parent_path()) {  // The shell found the program in PATH: only its name is known.
    std::error_code ignored;
    file = std::filesystem::read_symlink("/proc/self/exe", ignored);
  }
  return file.parent_path();
}

/// The program is in the folder organ_collision below this library. In Debian packages that folder
/// is beside the library's: lib/x86_64-linux-gnu is for libraries alone. If the library is linked
/// into a program, robot_reader is beside that program.
std::string find_program() {
  const std::filesystem::path folder = folder_of_this_code();
  const std::filesystem::path below = folder / "organ_collision" / kProgram;
  for (const auto& other :
       {folder.parent_path() / "organ_collision" / kProgram, folder / kProgram}) {
    if (!can_run(below) && can_run(other)) return other;
  }
  return below;
}

ProcessResult run_reader(std::vector<std::string> arguments, const std::string& input) {
  arguments.insert(arguments.begin(), find_program());
  try {
    return run_process(arguments, input, {reader_limits::kTime, reader_limits::kReplyBytes});
  } catch (const std::system_error& error) {
    throw ToolError("cannot run " + arguments[0] + ", which reads it: " + error.code().message());
  }
}

std::vector<LinkDescription> read(const std::string& urdf, const std::string& input,
                                  const std::vector<std::string>& links) {
  std::vector<std::string> arguments = {urdf};
  arguments.insert(arguments.end(), links.begin(), links.end());
  const ProcessResult result = run_reader(std::move(arguments), input);
  RobotReply reply = parse_reply(result.output);
  if (reply.refusal) throw ToolError(*reply.refusal);
  if (result.failure.empty() && reply.links && reply.links->size() == links.size()) {
    return *std::move(reply.links);
  }
  throw ToolError((reply.reading.empty() ? "" : reply.reading + ": ") + kProgram + " " +
                  (result.failure.empty() ? "gave a malformed answer" : result.failure) +
                  " while it read it; the file may be broken, or too large");
}

}  // namespace

std::vector<LinkDescription> read_robot_file(const std::string& urdf,
                                             const std::vector<std::string>& links) {
  return read(urdf, "", links);
}

std::vector<LinkDescription> read_robot_text(const std::string& urdf,
                                             const std::vector<std::string>& links) {
  return read("-", urdf, links);
}

}  // namespace organ_collision
