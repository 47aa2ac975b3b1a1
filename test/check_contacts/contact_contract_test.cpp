#include "contact_contract.hpp"

#include <gtest/gtest.h>

#include <string>

#include "test/check_contacts/good_answer.hpp"

namespace organ_collision {
namespace {

/// Answers of a publisher, one after the other.
class ContactContractTest : public testing::Test {
 protected:
  /// The rules that the next answer breaks. Its step is from `start` to `end` [s].
  std::string broken_rules(ContactArray answer, int start, int end,
                           const std::string& publisher = "/node") {
    answer.header.seq = ++seq_;
    answer.step_start = ros::Time(start);
    answer.header.stamp = ros::Time(end);
    std::string rules;
    const Faults faults = contract_.check(answer, publisher);
    for (const Fault& fault : faults.all()) rules += fault.rule;
    return rules;
  }

  ContactContract contract_;
  std::uint32_t seq_ = 0;
};

TEST_F(ContactContractTest, AStepMustBeginWhereTheLastSuccessfulOneEnded) {
  const struct {
    ContactArray answer;
    int start, end;
    const char* broken;
  } rows[] = {
      {good_static_answer(), 3, 3, ""},
      {good_answer(), 3, 4, ""},
      {good_answer(), 4, 4, ""},
      {good_answer(), 4, 9, ""},
      {good_answer(), 10, 11, "steps that join"},
      {good_answer(), 11, 12, ""},
      {good_answer(), 3, 4, "steps that join"},
      {good_failure(), 5, 5, ""},  // It does not end a step.
      {good_answer(), 4, 6, ""},
      {good_static_answer(), 1, 1, ""},  // History was forgotten.
      {good_answer(), 1, 2, ""},
  };
  for (const auto& row : rows) {
    EXPECT_EQ(broken_rules(row.answer, row.start, row.end), row.broken) << row.start;
  }
}

TEST_F(ContactContractTest, PairsOfOrganAndToolHaveTheirOwnSteps) {
  ContactArray other_tool = good_answer(), other_organ = good_answer();
  other_tool.tool = "scissors";
  other_organ.organ = "kidney";
  EXPECT_EQ(broken_rules(good_answer(), 3, 4), "");
  EXPECT_EQ(broken_rules(other_tool, 1, 2), "");
  EXPECT_EQ(broken_rules(other_organ, 1, 2), "");
  EXPECT_EQ(broken_rules(good_answer(), 4, 5), "");
  EXPECT_EQ(broken_rules(other_tool, 1, 2), "steps that join");
}

TEST_F(ContactContractTest, AfterLostMessagesNothingIsKnownOfTheLastStep) {
  EXPECT_EQ(broken_rules(good_answer(), 3, 4), "");
  seq_ += 7;
  EXPECT_EQ(broken_rules(good_answer(), 5, 6), "");
  EXPECT_EQ(contract_.lost(), 7U);
  seq_ = 0;  // The publisher has restarted.
  EXPECT_EQ(broken_rules(good_answer(), 1, 2), "");
  EXPECT_EQ(contract_.lost(), 7U);
}

TEST_F(ContactContractTest, PublishersCountTheirOwnMessages) {
  EXPECT_EQ(broken_rules(good_answer(), 3, 4, "/left"), "");
  EXPECT_EQ(broken_rules(good_answer(), 1, 2, "/right"), "");
  seq_ = 1;
  EXPECT_EQ(broken_rules(good_answer(), 9, 10, "/left"), "steps that join");
  EXPECT_EQ(contract_.lost(), 0U);
}

TEST_F(ContactContractTest, StepsHaveNoPaperModeAndHaveATool) {
  ContactArray answer = good_answer();
  answer.mode = ContactArray::PAPER_SWEPT;
  EXPECT_EQ(broken_rules(answer, 3, 4), "mode");
  answer = good_answer();
  answer.tool = "";
  EXPECT_EQ(broken_rules(answer, 3, 4), "names");
}

}  // namespace
}  // namespace organ_collision
