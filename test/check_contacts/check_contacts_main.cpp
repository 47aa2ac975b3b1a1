/// check_contacts: watches topics of contacts for answers that break their contract.

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <boost/program_options/value_semantic.hpp>
#include <cmath>
#include <iostream>
#include <list>

#include "common/messages/failure_log.hpp"
#include "common/messages/text.hpp"
#include "common/program/user_input.hpp"
#include "contact_contract.hpp"

namespace organ_collision {
namespace {

constexpr int kNothingFound = 0, kFound = 1, kIllegalOption = 2, kNoAnswer = 3;
/// [messages] That may wait while this program is busy. If more wait, the oldest are lost.
constexpr std::uint32_t kQueue = 10000;

constexpr char kHelp[] = R"(Usage: rosrun organ_collision check_contacts [TOPIC ...] [--seconds S]

Watches topics of type organ_collision/ContactArray (by default organ_collision/contacts) for answers
that break the contract of the message files, and prints what it finds: each kind at most once a
second, with topic, organ, tool, stamp and value. When it ends, it prints how many answers came, and
how many broke which rule. Its service ~summary (std_srvs/Trigger) tells the same while it runs;
`success` is false if something was found.

What is checked: numbers are finite; fractions and places on the shaft are from 0 to 1; normals have
length 1; barycentric coordinates are from 0 to 1, with the sum 1; links and faces exist; contacts
rise by face and link, near faces by distance; a failure has a message and nothing else; static
answers have no time but one; a swept step begins where the last successful step of its organ and
tool ended.

  --seconds S  how long to watch, by the wall clock; until Ctrl-C by default
  --help       this text

Exit status: 0 nothing found; 1 something found; 2 an illegal option; 3 no answer came.
)";

/// Checks the answers of several topics, and logs and counts what they break. All its work is done
/// in the callbacks of the node's queue.
class ContactWatch {
 public:
  explicit ContactWatch(const std::vector<std::string>& topics) {
    ros::NodeHandle node, private_node("~");
    for (const std::string& name : topics) {
      Topic& topic = topics_.emplace_back(Topic{node.resolveName(name)});
      const boost::function<void(const Event&)> callback = [this, &topic](const Event& event) {
        check(topic, event);
      };
      topic.subscriber = node.subscribe<ContactArray>(name, kQueue, callback);
    }
    server_ = private_node.advertiseService("summary", &ContactWatch::on_summary, this);
  }

  int exit_code() const {
    if (!violations_.by_reason().empty()) return kFound;
    return answers_ > 0 ? kNothingFound : kNoAnswer;
  }

  /// One line.
  std::string summary() const {
    std::uint64_t lost = 0;
    for (const Topic& topic : topics_) lost += topic.contract.lost();
    std::string found;
    for (const auto& [rule, entry] : violations_.by_reason()) {
      found += concatenate(found.empty() ? "" : ", ", rule, " ", entry.count);
    }
    return concatenate(answers_, " answers came, ", successful_, " with status OK; ", lost,
                       " were lost on the way. Broken rules: ", found.empty() ? "none" : found);
  }

 private:
  using Event = ros::MessageEvent<const ContactArray>;

  struct Topic {
    std::string name;
    ContactContract contract = {};
    ros::Subscriber subscriber = {};
  };

  void check(Topic& topic, const Event& event) {
    const ContactArray& answer = *event.getConstMessage();
    ++answers_;
    successful_ += answer.status == ContactArray::OK;
    const Faults faults = topic.contract.check(answer, event.getPublisherName());
    for (const Fault& fault : faults.all()) {
      violations_.add(fault.rule,
                      concatenate(topic.name, ", organ '", plain_text(answer.organ, kLongestName),
                                  "', tool '", plain_text(answer.tool, kLongestName), "', stamp ",
                                  answer.header.stamp, ", ", fault.rule, ": ", fault.sentence));
    }
  }

  bool on_summary(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    response.success = violations_.by_reason().empty();
    response.message = summary();
    return true;
  }

  std::list<Topic> topics_;
  FailureLog violations_;
  std::uint64_t answers_ = 0, successful_ = 0;
  ros::ServiceServer server_;
};

int watch(const std::vector<std::string>& topics, double seconds) {
  const ContactWatch watch(topics);
  const ros::SteadyTime start = ros::SteadyTime::now();
  while (ros::ok() && !((ros::SteadyTime::now() - start).toSec() >= seconds)) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  }
  std::cout << "check_contacts: " << watch.summary() << std::endl;
  return watch.exit_code();
}

int run(int argc, char** argv) {
  std::vector<std::string> topics{"organ_collision/contacts"}, words;
  double seconds = INFINITY;
  namespace po = boost::program_options;
  po::options_description legal;
  legal.add_options()("seconds", po::value(&seconds))("topic", po::value(&topics));
  po::positional_options_description positional;
  positional.add("topic", -1);
  ros::removeROSArgs(argc, argv, words);
  words.erase(words.begin());
  if (!read_command_line("check_contacts", kHelp, words, legal, positional)) return kNothingFound;
  ros::init(argc, argv, "check_contacts");
  return watch(topics, seconds);
}

}  // namespace
}  // namespace organ_collision

int main(int argc, char** argv) {
  using namespace organ_collision;
  int found = kNothingFound;
  // An illegal option, or an illegal name of a topic.
  const bool is_refused = exit_code("check_contacts", [&] { found = run(argc, argv); }) != 0;
  return is_refused ? kIllegalOption : found;
}
