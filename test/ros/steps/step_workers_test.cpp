#include "ros/steps/step_workers.hpp"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <random>
#include <string>
#include <vector>

#include "ros/threads/realtime.hpp"
#include "test/ros/steps/node_parts.hpp"

namespace organ_collision {
namespace {

constexpr std::size_t kTools = 4;
const std::vector<std::string> kOrgans = {"gallbladder", "liver", "stomach"};

/// A node with several tools and organs: wavy sheets, one above the other.
class Node {
 public:
  explicit Node(int threads) : parts_(threads) {
    parts_.parameters.publish_regions = true;
    for (std::size_t tool = 1; tool < kTools; ++tool) {
      const std::string name = "tool" + std::to_string(tool);
      parts_.tools.push_back(shaft_tool(name, 0.01 * static_cast<double>(tool)));
      set_point(parts_.transforms, "liver_frame", name + "_trocar", 0.0,
                {0.3 * static_cast<double>(tool), 0.1, 1.0}, true);
    }
    parts_.tools.back().fault = "tool3: its robot is not known";
    parts_.steps.change_tools(KeptTools(kTools));
  }

  /// What is published in so many rounds, as bytes. All nodes get the same messages.
  std::string run(int rounds) {
    std::string bytes;
    for (int round = 1; round <= rounds; ++round) {
      const double time = round;
      // Sometimes a tip is late, so that a shape waits for it, and two shapes become due together.
      for (std::size_t tool = 0; tool < kTools; ++tool) {
        if (random_() % 4 > 0) send_tip(tool, time);
      }
      for (const std::string& organ : kOrgans) {
        if (random_() % 5 > 0) send_shape(organ, time);
      }
      if (random_() % 3 == 0) parts_.steps.add_pose(random_() % kTools);
      if (random_() % 3 == 0) parts_.steps.add_tick();
      for (const ContactArray& answer : parts_.evaluate(std::chrono::milliseconds(15))) {
        append(answer, bytes);
      }
    }
    return bytes;
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / static_cast<double>(random_.max());
  }

  void send_tip(std::size_t tool, double time) {
    const std::string frame = tool == 0 ? "hook_tip" : "tool" + std::to_string(tool) + "_tip";
    set_point(parts_.transforms, "liver_frame", frame, time,
              {uniform(-0.8, 0.8), uniform(-0.8, 0.8), uniform(-0.5, 0.5)});
  }

  void send_shape(const std::string& organ, double time) {
    constexpr std::uint32_t kSide = 20;
    OrganMesh message;
    message.header.frame_id = "liver_frame";
    message.header.stamp = ros::Time(time);
    message.organ = organ;
    message.topology = random_() % 10 == 0 ? ++cuts_ : cuts_;
    const auto height = static_cast<float>(uniform(-0.3, 0.3));
    for (std::uint32_t i = 0; i <= kSide; ++i) {
      for (std::uint32_t j = 0; j <= kSide; ++j) {
        const float x = 2.0f * static_cast<float>(i) / kSide - 1.0f;
        const float y = 2.0f * static_cast<float>(j) / kSide - 1.0f;
        message.vertices.insert(message.vertices.end(), {x, y, height + 0.1f * x * y});
      }
    }
    for (std::uint32_t i = 0; i < kSide; ++i) {
      for (std::uint32_t j = 0; j < kSide; ++j) {
        const std::uint32_t a = i * (kSide + 1) + j, b = a + kSide + 1;
        message.triangles.insert(message.triangles.end(), {a, b, b + 1, a, b + 1, a + 1});
      }
    }
    parts_.organ_topics.take_mesh(boost::make_shared<OrganMesh>(message));
    parts_.apply_organ_messages();
  }

  static void append(const ContactArray& answer, std::string& bytes) {
    std::vector<std::uint8_t> buffer(ros::serialization::serializationLength(answer));
    ros::serialization::OStream stream(buffer.data(), static_cast<std::uint32_t>(buffer.size()));
    ros::serialization::serialize(stream, answer);
    bytes.append(buffer.begin(), buffer.end());
  }

  NodeParts parts_;
  std::mt19937 random_{7};
  std::uint32_t cuts_ = 1;
};

TEST(StepWorkers, TheAnswersDoNotDependOnTheNumberOfThreads) {
  const std::string by_one = Node(1).run(60);
  EXPECT_GT(by_one.size(), 100'000u);
  for (const int threads : {2, 3, 8}) EXPECT_TRUE(Node(threads).run(60) == by_one) << threads;
}

TEST(StepWorkers, WithoutStepsNoThreadIsStarted) {
  NodeParts parts(4);
  StepWorkers workers(parts.parameters);
  const StepEvaluator evaluator(parts.parameters, parts.tools, parts.poses);
  const std::size_t before = threads_of_this_process().size();
  std::vector<DueStep> none;
  workers.run(evaluator, none, [](std::size_t) { FAIL() << "delivered"; });
  EXPECT_EQ(threads_of_this_process().size(), before);
}

}  // namespace
}  // namespace organ_collision
