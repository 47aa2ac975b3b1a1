#include <gtest/gtest.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "node/motion/path_builder.hpp"
#include "organ_collision/query/collision_query.hpp"
#include "soak.hpp"

using namespace organ_collision;
using namespace organ_collision::soak;

namespace {

constexpr std::uint32_t kTopology = 2;

/// Answers steps of the jaw as the node does.
class SecondEvaluationTest : public testing::Test {
 protected:
  TriangleMesh mesh(Tick tick) const {
    return {script_.vertices(tick), script_.triangles(kTopology)};
  }

  ToolPath path(Tick begin, Tick end) const {
    const auto pose = [this](Tick tick) { return ToolPose{{}, {script_.tools(tick).jaw}}; };
    PathBuilder path(jaw_, pose(begin));
    for (Tick tick = begin + 1; tick <= end; ++tick) {
      if (!script_.has_poses(tick)) continue;
      path.add(static_cast<double>(tick - begin) / static_cast<double>(end - begin), pose(tick));
    }
    return path.take(1000).path;
  }

  /// `shape`: the tick of the organ's shape at the end of the step.
  boost::shared_ptr<ContactArray> answer(Tick begin, Tick end, Tick shape) {
    const TriangleMesh before = mesh(begin), now = mesh(shape);
    CollisionRequest request;
    request.organ = &now;
    request.organ_before = &before;
    request.path = path(begin, end);
    request.links = &jaw_;
    request.mode = QueryMode::kSwept;
    query_.evaluate(request, result_);
    const auto answer = boost::make_shared<ContactArray>();
    answer->tool = "jaw";
    answer->mode = ContactArray::SWEPT;
    answer->step_start = stamp_of(begin);
    answer->header.stamp = answer->mesh_stamp = stamp_of(end);
    answer->topology = kTopology;
    for (const FaceContact& found : result_.contacts) {
      Contact contact;
      contact.face = found.face;
      contact.fraction = found.fraction;
      answer->contacts.push_back(contact);
    }
    return answer;
  }

  std::optional<std::string> judge(const ContactArrayConstPtr& answer) const {
    const auto before = boost::make_shared<ContactArray>();
    before->header.stamp = before->mesh_stamp = answer->step_start;
    before->topology = kTopology;
    return wrong_contacts(script_, {answer, before});
  }

  const Script script_{1};
  const std::vector<Link> jaw_ = {
      {"jaw", {LinkPart::box(Eigen::Isometry3d::Identity(), {0.004, 0.003, 0.02})}}};
  CollisionQuery query_;
  CollisionResult result_;
};

}  // namespace

// The node leaves out poses that change a link's path by at most 1e-6 m.
TEST_F(SecondEvaluationTest, AnswersOfTheNodeAreRight) {
  std::size_t contacts = 0;
  for (const Tick end : {100'452, 100'463}) {
    const auto answered = answer(100'450, end, end);
    EXPECT_EQ(judge(answered), "") << "to " << end;
    contacts += answered->contacts.size();
  }
  EXPECT_GT(contacts, 0U);
}

TEST_F(SecondEvaluationTest, ContactsOfAnotherShapeAreWrong) {
  EXPECT_NE(judge(answer(100'450, 100'463, 100'462)).value(), "");
}

TEST_F(SecondEvaluationTest, AMissingContactIsFound) {
  const auto answered = answer(100'450, 100'463, 100'463);
  ASSERT_FALSE(answered->contacts.empty());
  answered->contacts.erase(answered->contacts.begin());
  EXPECT_EQ(judge(answered), "a touched face has no contact");
}

TEST_F(SecondEvaluationTest, AContactAtAnotherTimeIsWrong) {
  const auto answered = answer(100'450, 100'463, 100'463);
  const auto late = std::find_if(answered->contacts.begin(), answered->contacts.end(),
                                 [](const Contact& contact) { return contact.fraction > 0.1; });
  ASSERT_NE(late, answered->contacts.end());
  late->fraction -= 0.05;
  EXPECT_EQ(judge(answered), "a contact does not touch");
}
