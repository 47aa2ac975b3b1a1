#include "ros/interface/live_parameters.hpp"

#include <gtest/gtest.h>

using namespace organ_collision;

namespace {

const std::vector<LiveParameter> kParameters = {{"rate", "[Hz]", 1.0, 0.0, {0.0, 10.0}},
                                                {"loud", "", true, false}};

XmlRpc::XmlRpcValue change(const char* name, const XmlRpc::XmlRpcValue& value) {
  XmlRpc::XmlRpcValue changes;
  changes[name] = value;
  return changes;
}

}  // namespace

// test/rostest/live_changes_test.py tests the topics and the service.

TEST(LiveParameters, ChangesAreAGroupOfParameters) {
  const ParameterGroup group = live_group(change("rate", 5), kParameters);
  EXPECT_EQ(group.number("rate", 1.0, kParameters[0].range), 5.0);
  EXPECT_TRUE(group.flag("loud", true));
}

TEST(LiveParameters, AnIllegalValueIsRefusedByItsRange) {
  const ParameterGroup group = live_group(change("rate", 10.5), kParameters);
  EXPECT_THROW(group.number("rate", 1.0, kParameters[0].range), ParameterError);
}

TEST(LiveParameters, AnUnknownNameIsRefused) {
  try {
    live_group(change("rates", 5), kParameters);
    ADD_FAILURE() << "accepted";
  } catch (const ParameterError& error) {
    EXPECT_EQ(std::string(error.what()),
              "~rates is no parameter; nearest is 'rate', legal are rate, loud");
  }
}
