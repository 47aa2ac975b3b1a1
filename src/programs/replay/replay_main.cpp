#include <console_bridge/console.h>
#include <ros/names.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/messages/failure_log.hpp"
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

constexpr char kUsage[] =
    R"(Usage: replay --parameters FILE [--node NAME] IN.bag OUT.bag

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
  --help             this text

Exit status: 0 done; 2 bad input; 1 other failures, such as a damaged bag. Both have one line on stderr,
and no new OUT.bag unless only stdout cannot be written. After a signal, OUT.bag.incomplete stays.
Progress is shown on stderr.
)";

/// The command line.
struct ReplayOptions {
  std::string in, out;
  std::string parameters;                              ///< the yaml file
  std::string node = std::string("/") + names::kNode;  ///< the node's name in the bag
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
  const auto gone = [](bool is_given) {
    if (!is_given) return;
    throw std::invalid_argument("--with-input is gone; `rosbag play IN.bag OUT.bag` plays both");
  };
  namespace po = boost::program_options;
  po::options_description legal;
  auto add = legal.add_options();
  add("IN.bag", po::value(&options.in)->required());
  add("OUT.bag", po::value(&options.out)->required());
  add("parameters", po::value(&options.parameters)->required());
  add("node", po::value<std::string>()->notifier(node));
  add("with-input", po::bool_switch()->notifier(gone));
  po::positional_options_description files;
  files.add("IN.bag", 1).add("OUT.bag", 1);
  if (!read_command_line("replay", kUsage, arguments, legal, files)) return std::nullopt;
  return options;
}

/// The name that a bag has until it is complete.
std::string incomplete(const std::string& file) { return file + ".incomplete"; }

/// Throws InputError if the input is no regular file, or if the output would replace the input, or
/// something that is no regular file. To open a FIFO would take until somebody writes to it.
void check_files(const ReplayOptions& options) {
  namespace fs = std::filesystem;
  std::error_code ignored;  // What cannot be examined here gives an error when it is opened.
  const auto refuse = [](const std::string& file, const std::string& why) {
    throw InputError("replay: " + file + " is " + why);
  };
  if (!fs::is_regular_file(options.in, ignored)) {
    refuse(options.in, "no regular file; must be a recorded bag");
  }
  for (const std::string& written : {options.out, incomplete(options.out)}) {
    const fs::file_status status = fs::symlink_status(written, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
      refuse(written, "no regular file, and only those are replaced; name another OUT.bag");
    }
    if (fs::equivalent(options.in, written, ignored)) {
      refuse(written, "also the input; name another OUT.bag");
    }
  }
}

/// The messages of a bag in the order in which they were recorded. rosbag::View alone orders them
/// by time: messages of the same simulated time would lose their order, and a clock that jumped
/// back would mix the times before and after the jump.
class RecordedMessages : private rosbag::View {
 public:
  /// The messages of the topics that `replay` reads. `bag` must outlive this.
  RecordedMessages(const rosbag::Bag& bag, const Replay& replay)
      : View(bag, [&](const auto* connection) { return replay.reads(connection->topic); }),
        bag_(bag) {
    for (const rosbag::MessageRange* range : ranges_) {
      for (auto entry = range->begin; entry != range->end; ++entry) {
        places_.emplace_back(*entry, range->connection_info);
      }
    }
    // A bag is written from its beginning to its end, so positions in the file tell the order.
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
      return std::tie(a.first.chunk_pos, a.first.offset) <
             std::tie(b.first.chunk_pos, b.first.offset);
    });
  }

  std::size_t size() const { return places_.size(); }
  template <typename Take>
  void for_each(const Take& take) {
    for (const auto& [entry, connection] : places_) {
      take(*std::unique_ptr<rosbag::MessageInstance>(newMessageInstance(connection, entry, bag_)));
    }
  }

 private:
  using Place = std::pair<rosbag::IndexEntry, const rosbag::ConnectionInfo*>;

  const rosbag::Bag& bag_;
  std::vector<Place> places_;
};

bool has_topic(const rosbag::Bag& bag, const std::string& topic) {
  return rosbag::View(bag, rosbag::TopicQuery(topic)).size() > 0;
}

/// Throws InputError if the bag has no organ, or if a topic has another type than the node expects.
void check_topics(const rosbag::Bag& bag, const ReplayOptions& options, const Replay& replay) {
  const std::string wanted = options.node + "/" + names::kOrganMesh;
  std::set<std::string> meshes;
  for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections()) {
    if (connection->datatype == ros::message_traits::datatype<OrganMesh>()) {
      meshes.insert(connection->topic);
    }
    const auto topic = replay.topics().find(connection->topic);
    if (topic == replay.topics().end()) continue;
    const auto& [type, md5sum, handlers] = topic->second;
    if (connection->datatype == type && connection->md5sum == md5sum) continue;
    throw InputError(concatenate(options.in, ": topic ", connection->topic,
                                 " has messages of type ", connection->datatype, " (",
                                 connection->md5sum, "); must be ", type, " (", md5sum,
                                 "); see Bags of other versions in doc/bags.md"));
  }
  if (has_topic(bag, wanted)) return;
  throw InputError(options.in + ": has no organ: no message on " + wanted +
                   (meshes.empty()
                        ? ", nor any other OrganMesh"
                        : "; there are meshes on " + listed({meshes.begin(), meshes.end()}) +
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

/// Throws InputError if the bag cannot be written.
void open_answers(rosbag::Bag& answers, const std::string& file) try {
  answers.open(incomplete(file), rosbag::bagmode::Write);
} catch (const rosbag::BagException& error) {
  throw InputError(file + ": cannot be written: " + error.what());
}

/// Replays. Returns what is to be printed.
std::string replay(const ReplayOptions& options) try {
  console_bridge::noOutputHandler();  // rosbag would print lines beside the error that it throws.
  const YamlParameters parameters(options.parameters, options.node);
  const NodeParameters node = parameters.node_parameters();
  for (const std::string& sentence : node.misspelt) std::cerr << "replay: " << sentence << '\n';
  std::vector<Tool> tools;
  for (const ToolParameters& of_tool : node.tools) {
    tools.push_back(
        load_tool(of_tool, [&](const auto& name) { return parameters.find_text(name); }));
    if (!tools.back().fault.empty()) throw InputError(tools.back().fault);
  }

  const rosbag::Bag bag(options.in);
  const std::string topic = options.node + "/" + names::kContacts;
  std::map<std::uint8_t, std::size_t> counts;  // the number of answers, by status
  std::size_t count = 0, done = 0, transforms = 0;
  rosbag::Bag answers;
  Replay replay(node, tools, options.node, has_topic(bag, "/clock"),
                [&](const ContactArray& answer, ros::Time time) {
                  ++count;
                  ++counts[answer.status];
                  // rosbag refuses time zero.
                  answers.write(topic, std::max(time, ros::TIME_MIN), answer);
                });
  check_topics(bag, options, replay);
  open_answers(answers, options.out);
  RecordedMessages messages(bag, replay);
  Progress progress("replay", "messages", messages.size());
  messages.for_each([&](const rosbag::MessageInstance& message) {
    replay.take(message);
    transforms += message.getTopic() == "/tf";
    progress.report(++done);
  });
  replay.finish();
  check_frames(tools, options.in, replay);
  answers.close();
  std::filesystem::rename(incomplete(options.out), options.out);
  if (!(node.rate_hz > 0.0)) explain_few_answers(options, count, transforms);
  std::vector<std::string> by_status;
  for (const auto& [status, number] : counts) {
    by_status.push_back(std::to_string(number) + " " + reason_of(status));
  }
  return std::to_string(count) + " answers on " + topic +
         (by_status.empty() ? "" : ": " + listed(by_status)) + "\n";
} catch (const InputError&) {
  throw;
} catch (const ParameterError& error) {
  throw InputError(std::string("replay: ") + error.what());
} catch (const std::exception& error) {
  throw std::runtime_error(options.in + ": its replay failed: " + plain_text(error.what(), 200) +
                           "; `rosbag reindex` may repair a damaged bag");
}

/// Replays in a child process, because the library that reads bags crashes at some damaged ones,
/// and its destructors throw if the disk is full. Returns the exit code.
int replay_in_child(const ReplayOptions& options) {
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // If somebody kills the parent, the child does not go on.
    std::set_terminate([] { std::abort(); });  // Without a line of its own.
    return exit_code("replay", [&] { print(replay(options)); });
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error("no process can be started");
  }
  if (status != 0) {
    std::error_code ignored;
    std::filesystem::remove(incomplete(options.out), ignored);
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  throw std::runtime_error(options.in + ": its replay " + failure_of(status) + "; the bag, or " +
                           options.parameters + ", may be damaged, or memory or the disk be full");
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
    code = replay_in_child(*options);
  });
  return refused != 0 ? refused : code;
}
