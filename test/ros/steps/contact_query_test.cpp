#include "ros/steps/contact_query.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace organ_collision;

namespace {

const TriangleMesh kMesh({-1, -1, 0, 1, -1, 0, 0, 1, 0, -1, -1, 5, 1, -1, 5, 0, 1, 5},
                         {3, 4, 5, 0, 1, 2});

CollisionRequest request() {
  CollisionRequest request;
  request.organ = &kMesh;
  request.path = {{0.0, {{0.0, 0.0, 1.0}, {0.1, 0.0, -0.5}}}};
  request.radius = 0.01;
  return request;
}

class ContactQueryTest : public testing::TestWithParam<PickerKind> {
 protected:
  ContactQuery contact_query_{GetParam()};
  ContactArray answer_;
};

}  // namespace

TEST_P(ContactQueryTest, FillsContactsAndRegions) {
  CollisionRequest good = request();
  good.regions = true;
  contact_query_.evaluate(good, answer_);
  EXPECT_EQ(answer_.status, ContactArray::OK);
  ASSERT_EQ(answer_.contacts.size(), 1u);
  EXPECT_EQ(answer_.contacts[0].face, 1u);
  EXPECT_EQ(answer_.regions.size(), 1u);
}

TEST_P(ContactQueryTest, RequestWithoutAnswerBecomesAStatus) {
  CollisionRequest bad = request();
  bad.radius = -0.25;
  answer_.contacts.resize(2);
  contact_query_.evaluate(bad, answer_);
  EXPECT_EQ(answer_.status, ContactArray::INVALID_REQUEST);
  EXPECT_NE(answer_.message.find("-0.25"), std::string::npos) << answer_.message;
  EXPECT_TRUE(answer_.contacts.empty());
}

// A long tool rotates among faces that move through each other, as after a mistake of units.
TEST_P(ContactQueryTest, CountsWhatIsNotResolved) {
  std::vector<float> before, now;
  std::vector<std::uint32_t> triangles;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> anywhere(-4e5F, 4e5F);
  for (std::uint32_t i = 0; i < 180'000; ++i) {
    for (int k = 0; k < 3; ++k) before.push_back(anywhere(random));
    for (int k = 0; k < 3; ++k) now.push_back(anywhere(random));
    triangles.push_back(i);
  }
  const TriangleMesh organ_before(before, triangles), organ(now, triangles);
  CollisionRequest wild = request();
  wild.organ = &organ;
  wild.organ_before = &organ_before;
  wild.mode = QueryMode::kSwept;
  wild.path = {{0.0, {{0.0, 0.0, 4e5}, {4e5, 0.0, -4e5}}},
               {1.0, {{0.0, 1e5, 3e5}, {-4e5, 0.0, -3e5}}}};
  contact_query_.evaluate(wild, answer_);
  EXPECT_EQ(answer_.status, ContactArray::OK);
  EXPECT_GT(answer_.unresolved, 0u);
  EXPECT_LE(answer_.unresolved, answer_.contacts.size());
  answer_ = {};
  contact_query_.evaluate(request(), answer_);
  EXPECT_EQ(answer_.unresolved, 0u);
}

TEST_P(ContactQueryTest, TimesWhatItAnswered) {
  EXPECT_GT(contact_query_.evaluate(request(), answer_), 0.0);
  CollisionRequest bad = request();
  bad.radius = -1.0;
  EXPECT_EQ(contact_query_.evaluate(bad, answer_), 0.0);
  EXPECT_FALSE(contact_query_.gl_version().empty());
}

INSTANTIATE_TEST_SUITE_P(BothPickers, ContactQueryTest,
                         testing::Values(PickerKind::kFeedback, PickerKind::kSelect,
                                         PickerKind::kCpu));
