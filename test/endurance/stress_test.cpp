#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>
#include <organ_collision/ContactArray.h>
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <boost/function.hpp>
#include <boost/shared_ptr.hpp>
#include <chrono>
#include <functional>
#include <iostream>
#include <iterator>
#include <list>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "load.hpp"
#include "stress_clients.hpp"
#include "stress_simulator.hpp"

// Organs, tools, queries, batches and changed settings at the same time. Each answer must keep the
// contract of ContactArray.msg, and at the end each tool must get an answer about the organ again.
// With the parameter ~nodelet, the nodelet runs in this process.

namespace organ_collision::stress {
namespace {

using SteadyClock = std::chrono::steady_clock;

bool wait_for(const std::function<bool()>& condition) {
  const auto give_up = SteadyClock::now() + std::chrono::seconds(60);
  while (!condition() && SteadyClock::now() < give_up) ros::WallDuration(0.02).sleep();
  return condition();
}

/// Whether the node advertises all of its services. It advertises one after another, and on a busy
/// machine there is time for a call in between, which then finds no service.
bool serves() {
  const char* const services[] = {"query",        "query_batch",    "list_organs", "remove_organ",
                                  "reload_tools", "set_parameters", "reset"};
  return std::all_of(std::begin(services), std::end(services), [](const std::string& service) {
    return ros::service::exists("organ_collision/" + service, false);
  });
}

/// Subscribes to a topic for a moment.
template <typename Message>
void look_at(const std::string& topic) {
  const boost::function<void(const boost::shared_ptr<const Message>&)> ignore =
      [](const boost::shared_ptr<const Message>&) {};
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<Message>(topic, 1, ignore);
  ros::WallDuration(0.05).sleep();
}

/// The tools that have answered with OK about an organ.
class Answerers {
 public:
  void add(const ContactArray& answer) {
    const std::lock_guard lock(mutex_);
    if (answer.status == ContactArray::OK && answer.organ == "quick") tools_.insert(answer.tool);
  }
  std::set<std::string> tools() const {
    const std::lock_guard lock(mutex_);
    return tools_;
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    tools_.clear();
  }

 private:
  mutable std::mutex mutex_;
  std::set<std::string> tools_;
};

class StressTest : public testing::Test {
 protected:
  StressTest() {
    spinner_.start();
    using Event = ros::MessageEvent<const ContactArray>;
    const boost::function<void(const Event&)> take = [this](const Event& event) {
      findings_.check_step(*event.getConstMessage(), event.getPublisherName());
      answerers_.add(*event.getConstMessage());
    };
    contacts_ = node_.subscribe<ContactArray>("organ_collision/contacts", 1000, take);
  }

  /// Starts what goes on during the whole test.
  void start_simulator() {
    simulator_.emplace_back(1e-3, [this] { tools_.send(); });
    simulator_.emplace_back(2e-3, [this] { organs_.move_quick(); });
  }

  void disturb(double seconds) {
    std::list<Repeated> all;
    all.emplace_back(1.5, [this] { clock_.jump_back(); });
    all.emplace_back(0.1, [this] { organs_.change_large(); });
    all.emplace_back(0.03, [this] { organs_.change_brief(); });
    all.emplace_back(0.7, [this] { organs_.restore_quick(); });
    QueryClient first(0, findings_), second(1, findings_), third(2, findings_);
    all.emplace_back(1e-3, [&] { first.ask_query(); });
    all.emplace_back(1e-3, [&] { second.ask_batch(); });
    all.emplace_back(5e-3, [&] {
      third.ask_query();
      third.ask_batch();
      third.list_organs();
    });
    Operator user(findings_);
    all.emplace_back(0.31, [&] { user.reset(); });
    all.emplace_back(0.23, [&] { user.reload_tools(); });
    all.emplace_back(0.17, [&] { user.change_parameters(); });
    all.emplace_back(0.11, [&] { user.remove_organ(); });
    all.emplace_back(0.13, [] { look_at<ContactArray>("organ_collision/contacts"); });
    all.emplace_back(0.19,
                     [] { look_at<visualization_msgs::MarkerArray>("organ_collision/markers"); });
    all.emplace_back(0.29, [] { look_at<diagnostic_msgs::DiagnosticArray>("/diagnostics"); });
    ros::WallDuration(seconds).sleep();
  }

  ros::NodeHandle node_;
  ros::AsyncSpinner spinner_{1};
  Findings findings_;
  Answerers answerers_;
  SimulatedClock clock_;
  ros::Subscriber contacts_;
  MovingTools tools_;
  OrganTraffic organs_;
  std::list<Repeated> simulator_;
};

TEST_F(StressTest, EverythingAtOnce) {
  nodelet::Loader loader(false);
  if (ros::param::param("~nodelet", false)) {
    const std::string name = ros::names::resolve("organ_collision");
    ASSERT_TRUE(loader.load(name, "organ_collision/CollisionNodelet", {}, {}));
  }
  ASSERT_TRUE(wait_for(serves));
  organs_.restore_quick();
  start_simulator();
  disturb(ros::param::param("~seconds", 5.0));

  Operator(findings_).restore_tools();
  organs_.restore_quick();
  answerers_.clear();
  const std::set<std::string> all = {"probe", "needle", "jaw", "stylus"};
  EXPECT_TRUE(wait_for([&] { return answerers_.tools() == all; }))
      << "of four tools, " << answerers_.tools().size() << " answer at the end";
  simulator_.clear();
  EXPECT_EQ(findings_.text(), "");
  EXPECT_GT(findings_.answered(), 0U);
  std::cout << findings_.checked() << " answers, " << findings_.answered() << " of them OK\n";
}

}  // namespace

}  // namespace organ_collision::stress

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "stress_test");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
