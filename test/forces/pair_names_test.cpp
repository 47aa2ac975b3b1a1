#include "forces/pair_names.hpp"

#include <gtest/gtest.h>
#include <ros/names.h>

#include "ros/interface/rejection.hpp"

using namespace organ_collision;

TEST(PairNames, LegalNamesStay) {
  PairNames names;
  EXPECT_EQ(names.of("liver", "hook"), "liver/hook");
  EXPECT_EQ(names.of("Liver_2", "hook"), "Liver_2/hook");
  EXPECT_EQ(names.of("liver", "hook"), "liver/hook");
}

TEST(PairNames, OthersAreMadeLegal) {
  PairNames names;
  EXPECT_EQ(names.of("left lobe", "robot1/hook"), "left_lobe/robot1_hook");
  EXPECT_EQ(names.of("2", "_x"), "organ_2/tool__x");
  EXPECT_EQ(names.of("", "~"), "organ_/tool__");
  for (const char* name : {"9-7", "f\xC3\xB6ie", " ", "a\nb", "..", "://"}) {
    std::string error;
    EXPECT_TRUE(ros::names::validate(names.of(name, name), error)) << error;
  }
}

TEST(PairNames, TwoThatWouldShareTopicsAreRefused) {
  PairNames names;
  names.of("left lobe", "hook");
  try {
    names.of("left_lobe", "hook");
    FAIL();
  } catch (const Rejection& rejection) {
    EXPECT_EQ(rejection.reason(), "name taken");
    const std::string message = rejection.what();
    EXPECT_NE(message.find("left_lobe/hook belong to organ 'left lobe'"), std::string::npos)
        << message;
  }
  EXPECT_EQ(names.of("left lobe", "hook"), "left_lobe/hook");
  EXPECT_EQ(names.of("left_lobe", "grasper"), "left_lobe/grasper");
}
