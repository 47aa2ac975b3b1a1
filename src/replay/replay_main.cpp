#include <rosbag/bag.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "bags.hpp"
#include "offline/text_reader.hpp"
#include "organ_collision/ros/names.hpp"
#include "replay.hpp"
#include "replay_options.hpp"
#include "ros/messages/text.hpp"
#include "yaml_parameters.hpp"

namespace organ_collision {
namespace {

std::atomic<bool> interrupted{false};

/// Shows on stderr, once a second, how much of the bag is done.
class ReplayProgress {
 public:
  explicit ReplayProgress(std::size_t messages) : messages_(messages) {}

  void count() {
    ++done_;
    if (Clock::now() - shown_ < std::chrono::seconds(1)) return;
    shown_ = Clock::now();
    std::cerr << "replay: " << done_ << " of " << messages_ << " messages" << std::endl;
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::size_t messages_;
  std::size_t done_ = 0;
  Clock::time_point shown_ = Clock::now();
};

/// What is in the file system instead of a regular file.
std::string kind_of(std::filesystem::file_type type) {
  switch (type) {
    case std::filesystem::file_type::symlink:
      return "a symbolic link";
    case std::filesystem::file_type::directory:
      return "a folder";
    case std::filesystem::file_type::fifo:
      return "a FIFO";
    case std::filesystem::file_type::socket:
      return "a socket";
    default:
      return "a device";
  }
}

/// Throws InputError if something is there that the output must not replace.
void check_replaceable(const std::string& file) {
  using std::filesystem::file_type;
  std::error_code ignored;  // What cannot be looked at cannot be written, which is told then.
  const file_type type = std::filesystem::symlink_status(file, ignored).type();
  if (type == file_type::none || type == file_type::not_found || type == file_type::regular) return;
  throw InputError("replay: " + file + " is " + kind_of(type) +
                   ", and only a regular file is replaced; name another OUT.bag");
}

void check_files(const ReplayOptions& options) {
  for (const std::string& written : {options.out, incomplete(options.out)}) {
    check_replaceable(written);
    std::error_code ignored;
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
    const Replay::Type& type = topic->second;
    if (connection->datatype == type.name && connection->md5sum == type.md5sum) continue;
    throw InputError(file + ": topic " + connection->topic + " has messages of type " +
                     connection->datatype + " (" + connection->md5sum + "); must be " + type.name +
                     " (" + type.md5sum + ")");
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

[[noreturn]] void refuse_frame(const std::string& file, const std::string& frame,
                               const std::string& tool) {
  throw InputError(file + ": frame '" + frame + "' of tool '" + tool +
                   "' occurs neither on TF nor on a topic of poses");
}

/// Throws InputError if the bag has never told of a frame of a tool.
void check_frames(const std::vector<Tool>& tools, const std::string& file, const Replay& replay) {
  for (const Tool& tool : tools) {
    const ToolParameters& parameters = tool.parameters;
    std::vector<std::string> frames;
    if (parameters.has_shaft()) frames = {parameters.trocar_frame, parameters.tip_frame};
    for (const std::string& link : parameters.links) frames.push_back(parameters.link_frame(link));
    if (parameters.has_tip_of_links()) frames.push_back(parameters.tip_frame);
    for (const std::string& frame : frames) {
      if (!replay.knows_frame(frame)) refuse_frame(file, frame, parameters.name);
    }
  }
}

void read(RecordedMessages& messages, const std::string& file,
          const std::function<void(const rosbag::MessageInstance&)>& take) {
  try {
    messages.for_each(take);
  } catch (const rosbag::BagException& error) {
    throw InputError(file + ": cannot be read to its end: " + plain_text(error.what(), 200));
  } catch (const ros::serialization::StreamOverrunException&) {
    throw InputError(file + ": a message is damaged: it is shorter than its contents say");
  }
}

void replay(const ReplayOptions& options) {
  check_files(options);
  const YamlParameters parameters(options.parameters, options.node);
  const LoadedParameters loaded = parameters.node_parameters();
  for (const std::string& sentence : loaded.misspelt) std::cerr << "replay: " << sentence << '\n';
  const std::vector<Tool> tools = load_tools(loaded.parameters, parameters);

  rosbag::Bag bag;
  open(bag, options.in);
  const std::string contacts = options.node + "/" + names::kContacts;
  AnswerBag answers(options.out, contacts);
  Replay replay(loaded.parameters, tools, options.node, has_topic(bag, "/clock"),
                [&](const ContactArray& answer, ros::Time time) { answers.add(answer, time); });
  check_organs(bag, options);
  check_types(bag, options.in, replay);

  RecordedMessages messages(bag, [&](const rosbag::ConnectionInfo& connection) {
    const bool is_copied = options.with_input && connection.topic != contacts;
    return is_copied || replay.topics().count(connection.topic) > 0;
  });
  ReplayProgress progress(messages.size());
  read(messages, options.in, [&](const rosbag::MessageInstance& message) {
    if (interrupted) throw std::runtime_error("interrupted");
    if (options.with_input) answers.copy(message);
    if (replay.topics().count(message.getTopic()) > 0) replay.take(message);
    progress.count();
  });
  replay.finish();
  check_frames(tools, options.in, replay);
  answers.complete();
  std::cout << answers.summary() << std::endl;
}

int run(const std::vector<std::string>& arguments) {
  try {
    const ReplayOptions options = parse_replay_options(arguments);
    if (options.help) {
      std::cout << replay_usage();
    } else {
      replay(options);
    }
    return 0;
  } catch (const InputError& error) {
    std::cerr << error.what() << std::endl;
    return 2;
  } catch (const ParameterError& error) {
    std::cerr << "replay: " << error.what() << std::endl;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "replay: " << error.what() << std::endl;
    return 1;
  }
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { organ_collision::interrupted = true; });
  }
  return organ_collision::run({argv + 1, argv + argc});
}
