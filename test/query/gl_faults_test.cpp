// Tests collision_query.hpp when OpenGL fails during a query. This program is linked to a library
// that stands between the package and OSMesa, and makes calls fail.
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "faulty_osmesa.hpp"
#include "scenes.hpp"

namespace organ_collision {
namespace {

using faulty_osmesa::Fault;
using oracle::Random;

class GlFaults : public testing::TestWithParam<std::tuple<PickerKind, Fault>> {
 protected:
  ~GlFaults() override { faulty_osmesa::befall(Fault::kNone, 0); }

  PickerKind picker() const { return std::get<0>(GetParam()); }
  Fault fault() const { return std::get<1>(GetParam()); }
  /// Exact distances then decide on all faces that were drawn.
  bool may_lose_only_the_witness() const {
    return fault() == Fault::kDrawsNothing ||
           (fault() == Fault::kReturnsGarbage && picker() == PickerKind::kSelect);
  }

  CollisionQuery query_{{picker(), GlPlatform::kOsmesa}};
  CollisionResult result_;
};

// Legs and links are drawn one after the other. The fault befalls each draw once. Either the query
// fails, or its answer is whole.
TEST_P(GlFaults, NeverLookLikeNoContactAndTheNextQueryIsWhole) {
  Random random(51);
  std::size_t befallen = 0, found = 0;
  for (int i = 0; i < 6 && !HasFailure(); ++i) {
    LinkScene scene(true, random);
    scene.request.regions = i % 2 == 0;
    if (i % 3 == 2) {  // GL draws the faces of a paper mode again for their regions.
      scene.remove_links(random);
      scene.request.mode = QueryMode::kPaperStatic;
      scene.request.regions = true;
    }
    query_.evaluate(scene.request, result_);
    const CollisionResult whole = result_;
    found += whole.contacts.size();
    for (int number = 0; number < 20; ++number) {
      faulty_osmesa::befall(fault(), number);
      try {
        query_.evaluate(scene.request, result_);
        expect_same(result_.contacts, whole.contacts, 0.0);
        EXPECT_EQ(result_.regions, whole.regions);
        if (!faulty_osmesa::has_befallen()) break;
        EXPECT_TRUE(may_lose_only_the_witness()) << "a fault was overlooked";
        ++befallen;
        continue;
      } catch (const GlError&) {
        ++befallen;
      }
      EXPECT_TRUE(result_.contacts.empty());
      EXPECT_TRUE(result_.regions.empty());
      query_.evaluate(scene.request, result_);
      expect_same(result_.contacts, whole.contacts, 0.0);
      EXPECT_EQ(result_.regions.size(), whole.regions.size());
    }
    faulty_osmesa::befall(Fault::kNone, 0);
  }
  EXPECT_GE(befallen, 6U);
  EXPECT_GT(found, 50U);
}

std::string name(const testing::TestParamInfo<GlFaults::ParamType>& info) {
  const char* const kinds[] = {"Feedback", "Select"};
  const char* const faults[] = {"None",           "ReportsError", "DrawsNothing", "ReturnsTooMuch",
                                "ReturnsGarbage", "IsTaken",      "StaysAway"};
  return std::string(kinds[static_cast<int>(std::get<0>(info.param))]) +
         faults[static_cast<int>(std::get<1>(info.param))];
}

TEST_P(GlFaults, ThatStayMakeEachQueryFail) {
  Random random(52);
  int touching = 0;
  for (int i = 0; i < 20 && touching < 3; ++i) {
    LinkScene scene(true, random);
    query_.evaluate(scene.request, result_);
    const CollisionResult whole = result_;
    if (whole.contacts.empty()) continue;
    ++touching;
    faulty_osmesa::befall(fault(), 0, faulty_osmesa::Duration::kForGood);
    for (int k = 0; k < 3; ++k) {
      EXPECT_THROW(query_.evaluate(scene.request, result_), GlError);
      EXPECT_TRUE(result_.contacts.empty());
    }
    faulty_osmesa::befall(Fault::kNone, 0);
    query_.evaluate(scene.request, result_);
    expect_same(result_.contacts, whole.contacts, 0.0);
  }
  EXPECT_EQ(touching, 3);
}

// LeakSanitizer cannot tell, because Mesa itself keeps memory.
TEST_P(GlFaults, LeaveNoContextBehind) {
  const int before = faulty_osmesa::living_contexts();
  Random random(53);
  const LinkScene scene(true, random);
  {
    CollisionQuery query({picker(), GlPlatform::kOsmesa});
    query.evaluate(scene.request, result_);
    const int of_one_query = faulty_osmesa::living_contexts();
    EXPECT_GT(of_one_query, before);
    for (int i = 0; i < 5; ++i) {
      faulty_osmesa::befall(fault(), 0, faulty_osmesa::Duration::kForGood);
      EXPECT_THROW(query.evaluate(scene.request, result_), GlError);
      EXPECT_LE(faulty_osmesa::living_contexts(), of_one_query);
      faulty_osmesa::befall(Fault::kNone, 0);
      query.evaluate(scene.request, result_);
      EXPECT_EQ(faulty_osmesa::living_contexts(), of_one_query);
    }
  }
  EXPECT_EQ(faulty_osmesa::living_contexts(), before);
}

INSTANTIATE_TEST_SUITE_P(
    Pickers, GlFaults,
    testing::Combine(testing::Values(PickerKind::kFeedback, PickerKind::kSelect),
                     testing::Values(Fault::kReportsError, Fault::kDrawsNothing,
                                     Fault::kReturnsTooMuch, Fault::kReturnsGarbage,
                                     Fault::kIsTaken, Fault::kStaysAway)),
    name);

}  // namespace
}  // namespace organ_collision
