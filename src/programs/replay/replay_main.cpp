#include <ros/names.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/program_options/value_semantic.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "bags.hpp"
#include "common/messages/text.hpp"
#include "common/program/user_input.hpp"
#include "geometry/concatenate.hpp"
#include "node/motion/tool_poses.hpp"
#include "node/tools/robot_reader_client.hpp"
#include "organ_collision/ros/names.hpp"
#include "replay.hpp"
#include "yaml_parameters.hpp"

namespace organ_collision {
namespace {

std::atomic<bool> interrupted{false};

constexpr char kUsage[] =
    R"(Usage: replay --parameters FILE [--node NAME] [--with-input] IN.bag OUT.bag

Answers the organs and tools of a recorded bag, as organ_collision_node would on a computer that is
never busy. Each shape is evaluated, and waits for its transforms in the time of the bag. Two replays
of a bag write the same answers. Needs no ROS master.

  IN.bag             has the topics that the node hears: NAME/organ_mesh, NAME/organ_vertices, /tf,
                     /tf_static, the pose topics of the tools; and /clock if time was simulated
  OUT.bag            gets the answers, on the topic NAME/contacts
  --parameters FILE  the node's parameters (tools, tf_timeout_sec, ...) in a yaml file, as for
                     rosparam load. A file by `rosparam dump` will do, too. The parameter
                     robot_description, if a tool needs it, stands in the same file
  --node NAME        the node's name, /organ_collision by default
  --with-input       OUT.bag also gets all messages of IN.bag, except those on NAME/contacts
  --help             this text

Exit status: 0 done; 2 bad input, 1 other failures. Both have one line on stderr, and no new OUT.bag
unless only stdout cannot be written. Progress is shown on stderr.
)";

/// The command line.
struct ReplayOptions {
  std::string in, out;
  std::string parameters;                              ///< the yaml file
  std::string node = std::string("/") + names::kNode;  ///< the node's name in the bag
  bool with_input = false;
};

/// Returns none if --help is asked for.
std::optional<ReplayOptions> parse_options(const std::vector<std::string>& arguments) {
  ReplayOptions options;
  const auto node = [&](const std::string& name) {
    std::string error;
    if (!ros::names::validate(name, error) || name.find('~') != std::string::npos) {
      throw std::invalid_argument("--node is " + in_quotes(name) + "; must be the name of a node");
    }
    options.node = ros::names::resolve("/", name, false);
  };
  namespace po = boost::program_options;
  po::options_description legal;
  auto add = legal.add_options();
  add("IN.bag", po::value(&options.in)->required());
  add("OUT.bag", po::value(&options.out)->required());
  add("parameters", po::value(&options.parameters)->required());
  add("node", po::value<std::string>()->notifier(node));
  add("with-input", po::bool_switch(&options.with_input));
  po::positional_options_description files;
  files.add("IN.bag", 1).add("OUT.bag", 1);
  if (!read_command_line("replay", kUsage, arguments, legal, files)) return std::nullopt;
  return options;
}

/// Throws InputError if the input is no regular file, or if the output would replace the input, or
/// something that is no regular file.
void check_files(const ReplayOptions& options) {
  // To open a FIFO would take until somebody writes to it, and a bag is not read from its beginning
  // to its end.
  if (std::filesystem::exists(options.in) && !std::filesystem::is_regular_file(options.in)) {
    throw InputError("replay: " + options.in + " is no regular file; must be a recorded bag");
  }
  for (const std::string& written : {options.out, incomplete(options.out)}) {
    // If a file cannot be examined here, an error is reported when it is written.
    std::error_code ignored;
    const auto status = std::filesystem::symlink_status(written, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
      throw InputError("replay: " + written +
                       " is no regular file, and only those are replaced; name another OUT.bag");
    }
    if (std::filesystem::equivalent(options.in, written, ignored)) {
      throw InputError("replay: " + written + " is also the input; name another OUT.bag");
    }
  }
}

std::vector<Tool> load_tools(const NodeParameters& node, const YamlParameters& parameters) {
  std::vector<Tool> tools;
  for (const ToolParameters& of_tool : node.tools) {
    tools.push_back(load_tool(
        of_tool, [&](const std::string& parameter) { return parameters.find_text(parameter); }));
    if (!tools.back().fault.empty()) throw InputError(tools.back().fault);
  }
  return tools;
}

/// Throws InputError if a topic has another type than the node expects.
void check_types(rosbag::Bag& bag, const std::string& file, const Replay& replay) {
  for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections()) {
    const auto topic = replay.topics().find(connection->topic);
    if (topic == replay.topics().end()) continue;
    const auto& [type, md5sum, handlers] = topic->second;
    if (connection->datatype == type && connection->md5sum == md5sum) continue;
    const char* const hint =
        connection->datatype == type
            ? "; it was recorded with another version of this type, see Bags of other versions in "
              "doc/bags.md"
            : "";
    throw InputError(concatenate(file, ": topic ", connection->topic, " has messages of type ",
                                 connection->datatype, " (", connection->md5sum, "); must be ",
                                 type, " (", md5sum, ")", hint));
  }
}

bool has_topic(const rosbag::Bag& bag, const std::string& topic) {
  return rosbag::View(bag, rosbag::TopicQuery(topic)).size() > 0;
}

/// Throws InputError if the bag has no organ. Names the topics that may be meant.
void check_organs(const rosbag::Bag& bag, const ReplayOptions& options) {
  const std::string wanted = options.node + "/" + names::kOrganMesh;
  if (has_topic(bag, wanted)) return;
  std::set<std::string> found;
  rosbag::View meshes(bag, rosbag::TypeQuery(ros::message_traits::datatype<OrganMesh>()));
  for (const rosbag::ConnectionInfo* connection : meshes.getConnections()) {
    found.insert(connection->topic);
  }
  throw InputError(options.in + ": has no organ: no message on " + wanted +
                   (found.empty()
                        ? ", nor any other OrganMesh"
                        : "; there are meshes on " + listed({found.begin(), found.end()}) +
                              " (--node names the node whose topics are replayed)"));
}

/// Throws InputError if the bag has never told of a frame of a tool.
void check_frames(const std::vector<Tool>& tools, const std::string& file, const Replay& replay) {
  for (const Tool& tool : tools) {
    TransformBuffer::Frames frames = swept_frames(tool);
    if (tool.parameters.has_tip_of_links()) frames.push_back(tool.parameters.tip_frame);
    for (const std::string& frame : frames) {
      if (replay.knows_frame(frame)) continue;
      throw InputError(concatenate(file, ": frame '", frame, "' of tool '", tool.parameters.name,
                                   "' occurs neither on TF nor on a topic of poses"));
    }
  }
}

/// Says why there are few answers if tools moved on TF without being asked about.
void explain_few_answers(const ReplayOptions& options, std::size_t answers,
                         std::size_t transforms) {
  if (transforms <= answers) return;
  std::cerr
      << "replay: " << options.parameters
      << " has no rate above 0: only shapes and messages of pose topics are answered, not the "
      << transforms << " messages on /tf. For more answers, add a line such as rate: 100"
      << std::endl;
}

void replay(const ReplayOptions& options) {
  const ScopedBagLog log;
  const YamlParameters parameters(options.parameters, options.node);
  const NodeParameters node = parameters.node_parameters();
  for (const std::string& sentence : node.misspelt) std::cerr << "replay: " << sentence << '\n';
  const std::vector<Tool> tools = load_tools(node, parameters);

  rosbag::Bag bag;
  open(bag, options.in);
  const std::string contacts = options.node + "/" + names::kContacts;
  // Until now, a signal ends the program at once: it may wait for a FIFO with the parameters.
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { interrupted = true; });
  }
  AnswerBag answers(options.out, contacts);
  Replay replay(node, tools, options.node, has_topic(bag, "/clock"),
                [&](const ContactArray& answer, ros::Time time) { answers.add(answer, time); });
  check_organs(bag, options);
  check_types(bag, options.in, replay);

  RecordedMessages messages(bag, [&](const rosbag::ConnectionInfo* connection) {
    const bool is_copied = options.with_input && connection->topic != contacts;
    return is_copied || replay.topics().count(connection->topic) > 0;
  });
  Progress progress("replay", "messages", messages.size());
  std::size_t done = 0, transforms = 0;
  messages.for_each([&](const rosbag::MessageInstance& message) {
    if (interrupted) throw std::runtime_error("interrupted");
    if (options.with_input) answers.copy(message);
    if (replay.topics().count(message.getTopic()) > 0) replay.take(message);
    transforms += message.getTopic() == "/tf";
    progress.report(++done);
  });
  replay.finish();
  check_frames(tools, options.in, replay);
  answers.complete();
  for (const std::string& line : log.lines()) {
    std::cerr << "replay: " << options.in << ": " << line << std::endl;
  }
  print(answers.summary() + "\n");
  if (!(node.rate_hz > 0.0)) explain_few_answers(options, answers.count(), transforms);
}

std::atomic<pid_t> worker{0};  ///< the process that replays

/// Replays in a child process, because the library that reads bags crashes on some damaged ones.
/// Only the parent returns: the exit code. Signals of the user reach the child, which then ends in
/// order. Throws std::runtime_error if the child did not.
template <typename Work>
int replay_in_child(const ReplayOptions& options, const Work& work) {
  sigset_t of_user, former;
  sigemptyset(&of_user);
  for (const int signal : {SIGINT, SIGTERM}) sigaddset(&of_user, signal);
  sigprocmask(SIG_BLOCK, &of_user, &former);  // Until the parent knows whom to pass them on to.
  worker = fork();
  if (worker < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (worker == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // If somebody kills the parent, the child does not go on.
    sigprocmask(SIG_SETMASK, &former, nullptr);
    const int code = work();
    std::fflush(stdout);
    std::_Exit(code);  // Destructors of libraries could throw, and their leaks do not matter.
  }
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int number) { kill(worker, number); });
  }
  sigprocmask(SIG_SETMASK, &former, nullptr);
  int status = 0;
  while (waitpid(worker, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFSIGNALED(status)) return WEXITSTATUS(status);
  std::error_code ignored;
  std::filesystem::remove(incomplete(options.out), ignored);
  for (const int signal : {SIGINT, SIGTERM}) {
    if (WTERMSIG(status) != signal) continue;
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  throw std::runtime_error(options.in + ": its replay " + failure_of(status) + "; the bag, or " +
                           options.parameters + ", may be damaged, or memory ran out");
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  // If SIGPIPE is ignored, a closed pipe on stdout is reported like any other failed write.
  std::signal(SIGPIPE, SIG_IGN);
  int code = 0;
  const int refused = exit_code("replay", [&] {
    const std::optional<ReplayOptions> options = parse_options({argv + 1, argv + argc});
    if (!options) return;
    check_files(*options);
    code = replay_in_child(*options, [&] {
      return exit_code("replay", [&] {
        try {
          replay(*options);
        } catch (const ParameterError& error) {
          throw InputError(std::string("replay: ") + error.what());
        }
      });
    });
  });
  return refused != 0 ? refused : code;
}
