#include <ros/names.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <atomic>
#include <csignal>
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
#include <vector>

#include "geometry/concatenate.hpp"
#include "offline/user_input.hpp"
#include "organ_collision/ros/names.hpp"
#include "replay.hpp"
#include "ros/messages/failure_log.hpp"
#include "ros/messages/text.hpp"
#include "ros/motion/tool_poses.hpp"
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

Exit status: 0 done; 2 bad input, with one line on stderr and no OUT.bag; 1 other failures. Progress
is shown on stderr.
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
  CommandLine line("replay", kUsage);
  line.text("parameters", options.parameters);
  line.option("node", "the name of a node", [&](const std::string& node) {
    std::string error;
    if (!ros::names::validate(node, error) || node.find('~') != std::string::npos) return false;
    options.node = ros::names::resolve("/", node, false);
    return true;
  });
  line.flag("with-input", options.with_input);
  std::vector<std::string> files;
  if (!line.read(arguments, &files)) return std::nullopt;
  if (files.size() != 2) {
    line.refuse("needs two files, IN.bag and OUT.bag; " + std::to_string(files.size()) +
                " are given");
  }
  line.require("parameters", options.parameters);
  options.in = files[0];
  options.out = files[1];
  return options;
}

std::string incomplete(const std::string& file) { return file + ".incomplete"; }

/// The messages of a bag in the order in which they were recorded. rosbag::View alone orders them
/// by time: messages of the same simulated time would lose their order, and a clock that jumped
/// back would mix the times before and after the jump.
class RecordedMessages : private rosbag::View {
 public:
  /// The messages of the connections for which `is_wanted` returns true. `bag` must outlive this.
  RecordedMessages(const rosbag::Bag& bag,
                   const std::function<bool(const rosbag::ConnectionInfo&)>& is_wanted)
      : View(bag, [&](const rosbag::ConnectionInfo* info) { return is_wanted(*info); }), bag_(bag) {
    for (const rosbag::MessageRange* range : ranges_) {
      for (auto entry = range->begin; entry != range->end; ++entry) {
        places_.push_back({*entry, range->connection_info});
      }
    }
    // A bag is written from its beginning to its end, so positions in the file tell the order.
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
      return std::tie(a.entry.chunk_pos, a.entry.offset) <
             std::tie(b.entry.chunk_pos, b.entry.offset);
    });
  }

  std::size_t size() const { return places_.size(); }
  /// Calls `take` for each message. Throws InputError if the bag cannot be read.
  void for_each(const std::function<void(const rosbag::MessageInstance&)>& take) try {
    for (const Place& place : places_) {
      const std::unique_ptr<rosbag::MessageInstance> message(
          newMessageInstance(place.connection, place.entry, bag_));
      take(*message);
    }
  } catch (const rosbag::BagException& error) {
    throw InputError(bag_.getFileName() +
                     ": cannot be read to its end: " + plain_text(error.what(), 200));
  } catch (const ros::serialization::StreamOverrunException&) {
    throw InputError(bag_.getFileName() +
                     ": a message is damaged: it is shorter than its contents say");
  }

 private:
  struct Place {
    rosbag::IndexEntry entry;
    const rosbag::ConnectionInfo* connection;
  };

  const rosbag::Bag& bag_;
  std::vector<Place> places_;
};

/// The bag that gets the answers. Until it is complete, its file is NAME.incomplete. A bag that is
/// never completed is removed. The functions throw std::runtime_error if the file cannot be
/// written.
class AnswerBag {
 public:
  /// Throws InputError if the file cannot be written.
  AnswerBag(const std::string& file, std::string topic)
      : file_(file), topic_(std::move(topic)), incomplete_(incomplete(file)) {
    try {
      bag_.open(incomplete_, rosbag::bagmode::Write);
    } catch (const rosbag::BagException& error) {
      throw InputError(file + ": cannot be written: " + error.what());
    }
  }
  ~AnswerBag() {
    if (incomplete_.empty()) return;
    try {
      bag_.close();
    } catch (const std::exception&) {  // For example, the disk is full. The file is removed anyway.
    }
    std::error_code ignored;
    std::filesystem::remove(incomplete_, ignored);
  }
  AnswerBag(const AnswerBag&) = delete;
  AnswerBag& operator=(const AnswerBag&) = delete;

  void add(const ContactArray& answer, ros::Time time) {
    ++counts_[answer.status];
    write(topic_, std::max(time, ros::TIME_MIN), answer);  // rosbag refuses time zero.
  }

  void copy(const rosbag::MessageInstance& message) {
    write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
  }

  void complete() {
    bag_.close();
    std::filesystem::rename(incomplete_, file_);
    incomplete_.clear();
  }

  /// For example "1840 answers on /organ_collision/contacts: 1836 ok, 4 no transform".
  std::string summary() const {
    std::size_t all = 0;
    std::string by_status;
    for (const auto& [status, count] : counts_) {
      all += count;
      by_status +=
          (by_status.empty() ? ": " : ", ") + std::to_string(count) + " " + reason_of(status);
    }
    return std::to_string(all) + " answers on " + topic_ + by_status;
  }

 private:
  template <typename... Message>
  void write(const Message&... message) {
    try {
      bag_.write(message...);
    } catch (const rosbag::BagException& error) {
      throw std::runtime_error(file_ + ": cannot be written: " + error.what());
    }
  }

  std::string file_;
  std::string topic_;
  std::string incomplete_;
  rosbag::Bag bag_;
  std::map<std::uint8_t, std::size_t> counts_;  ///< the number of answers, by status
};

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

void open(rosbag::Bag& bag, const std::string& file) {
  try {
    bag.open(file, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw InputError(file +
                     ": has no index, as after an interrupted recording; repair it with "
                     "`rosbag reindex`");
  } catch (const std::exception& error) {
    throw InputError(file + ": is no bag that can be read: " + plain_text(error.what(), 200));
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

/// Whether a topic has answers of another version of this package.
bool has_other_answers(const rosbag::Bag& bag, const std::string& topic) {
  rosbag::View answers(bag, rosbag::TopicQuery(topic));
  const auto connections = answers.getConnections();
  return std::any_of(connections.begin(), connections.end(), [](const auto* connection) {
    return connection->md5sum != ros::message_traits::md5sum<ContactArray>();
  });
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

void replay(const ReplayOptions& options) {
  check_files(options);
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

  if (has_other_answers(bag, contacts)) {
    std::cerr << "replay: " << options.in << ": its answers on " << contacts
              << " are of another version; they are made anew, in today's type" << std::endl;
  }

  RecordedMessages messages(bag, [&](const rosbag::ConnectionInfo& connection) {
    const bool is_copied = options.with_input && connection.topic != contacts;
    return is_copied || replay.topics().count(connection.topic) > 0;
  });
  Progress progress("replay", "messages", messages.size());
  std::size_t done = 0;
  messages.for_each([&](const rosbag::MessageInstance& message) {
    if (interrupted) throw std::runtime_error("interrupted");
    if (options.with_input) answers.copy(message);
    if (replay.topics().count(message.getTopic()) > 0) replay.take(message);
    progress.report(++done);
  });
  replay.finish();
  check_frames(tools, options.in, replay);
  answers.complete();
  std::cout << answers.summary() << std::endl;
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  return exit_code("replay", [&] {
    const std::optional<ReplayOptions> options = parse_options({argv + 1, argv + argc});
    try {
      if (options) replay(*options);
    } catch (const ParameterError& error) {
      throw InputError(std::string("replay: ") + error.what());
    }
  });
}
