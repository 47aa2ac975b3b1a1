#include "node/organs/organ_intake.hpp"

#include <gtest/gtest.h>
#include <organ_collision/ContactArray.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>
#include <functional>

#include "test/node/organs/organ_fixture.hpp"

using namespace organ_collision;

namespace {

using Texts = std::vector<std::string>;

constexpr std::size_t kFaces = OrganIntake::kLarge + 1;

/// An intake whose threads work when the test says so.
struct Intake {
  Intake() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(50.0));
  }

  static boost::shared_ptr<OrganMesh> message(const std::string& organ, std::uint32_t topology,
                                              std::size_t faces) {
    const auto mesh = boost::make_shared<OrganMesh>();
    mesh->header.frame_id = "frame";
    mesh->organ = organ;
    mesh->topology = topology;
    mesh->vertices = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (std::size_t i = 0; i < faces; ++i) {
      mesh->triangles.insert(mesh->triangles.end(), {0, 1, 2});
    }
    return mesh;
  }
  void mesh(const std::string& organ, std::uint32_t topology, std::size_t faces = 1) {
    intake.take_mesh(message(organ, topology, faces));
  }
  void vertices(const std::string& organ, std::uint32_t topology, float z = 1.0F) {
    const auto vertices = boost::make_shared<OrganVertices>();
    vertices->header.frame_id = "frame";
    vertices->organ = organ;
    vertices->topology = topology;
    vertices->vertices = {0, 0, z, 1, 0, z, 0, 1, z};
    intake.take_vertices(vertices);
  }
  bool remove(const std::string& organ, const std::string& says) {
    RemoveOrgan::Request request;
    RemoveOrgan::Response response;
    request.organ = organ;
    EXPECT_TRUE(intake.on_remove(request, response));
    EXPECT_NE(response.message.find(says), std::string::npos) << response.message;
    return response.success;
  }

  /// Builds the next large mesh.
  void build() { builder.callOne(); }

  /// The messages that are applied now, for example "liver mesh 1". "liver vertices 1 refused":
  /// they were not applied.
  Texts next() {
    Texts texts;
    while (const auto update = intake.next()) {
      const OrganMessage& message = update->message;
      std::string text =
          message.organ() + (message.mesh ? " mesh " : " vertices ") +
          std::to_string(message.mesh ? message.mesh->topology : message.vertices->topology);
      if (!update->change) text += " refused";
      if (update->change == OrganChange::kRemoved) text = message.organ() + " removed";
      EXPECT_EQ(update->why_not.empty(), update->status == ContactArray::OK);
      texts.push_back(text);
    }
    return texts;
  }

  AheadLimit ahead;
  OrganRegistry organs{MeshLimits{}, ahead};
  FailureLog rejected;
  ros::CallbackQueue node, builder, inspector;
  OrganIntake intake{organs, rejected, OrganIntake::Threads{node, builder, inspector}};
};

struct IntakeCase {
  std::string name;
  std::function<void(Intake&)> play;
};

const std::vector<IntakeCase> kIntakeCases = {
    {"MessagesAreAppliedInTheirOrder",
     [](Intake& in) {
       in.mesh("liver", 1, OrganIntake::kLarge);
       in.vertices("liver", 1);
       EXPECT_TRUE(in.organs.organs().empty()) << "applied before next()";
       EXPECT_EQ(in.next(), (Texts{"liver mesh 1", "liver vertices 1"}));
       EXPECT_EQ(in.organs.at("liver").latest().mesh->vertex(0).z(), 1.0);
     }},
    {"LargeMeshesAreBuiltElsewhereAndOtherOrgansDoNotWait",
     [](Intake& in) {
       in.mesh("spleen", 7);
       in.mesh("liver", 1, kFaces);
       in.vertices("liver", 1);
       in.vertices("spleen", 7);
       EXPECT_EQ(in.next(), (Texts{"spleen mesh 7", "spleen vertices 7"}));
       EXPECT_TRUE(in.node.isEmpty());
       in.build();
       EXPECT_FALSE(in.node.isEmpty()) << "it wakes the node's thread";
       EXPECT_EQ(in.next(), (Texts{"liver mesh 1", "liver vertices 1"}));
       EXPECT_EQ(in.organs.at("liver").latest().mesh->face_count(), kFaces);
     }},
    {"WhatALaterMessageReplacesIsDroppedBehindALargeMesh",
     [](Intake& in) {
       in.mesh("liver", 1, kFaces);
       for (int i = 0; i < 50; ++i) {
         EXPECT_TRUE(in.remove("liver", ""));
         in.mesh("liver", 2, kFaces);
         in.mesh("liver", 3);
         for (int k = 0; k <= i; ++k) in.vertices("liver", 3, static_cast<float>(k));
       }
       EXPECT_EQ(in.intake.counts().waiting, 4U);
       in.build();
       EXPECT_EQ(in.next(),
                 (Texts{"liver mesh 1", "liver removed", "liver mesh 3", "liver vertices 3"}));
       EXPECT_EQ(in.organs.at("liver").latest().mesh->vertex(0).z(), 49.0);
       const OrganMessageCounts counts = in.intake.counts();
       EXPECT_EQ(counts.received, 1U + 50U * 3U + 50U * 51U / 2U);
       EXPECT_EQ(counts.dropped, counts.received - 4U);
       EXPECT_EQ(counts.applied, 3U);
       EXPECT_EQ(counts.removals, 1U);
       EXPECT_EQ(counts.waiting, 0U);
     }},
    {"ARefusedMessageIsCountedAndSaysWhy",
     [](Intake& in) {
       in.vertices("liver", 1);  // At the start, it is answered, but not counted.
       EXPECT_EQ(in.intake.next()->status, ContactArray::UNKNOWN_ORGAN);
       EXPECT_TRUE(in.rejected.by_reason().empty());
       const auto bad = Intake::message("liver", 1, kFaces);
       bad->triangles.back() = 3;
       in.intake.take_mesh(bad);
       in.vertices("liver", 1);
       in.build();
       const auto update = in.intake.next();
       ASSERT_TRUE(update);
       EXPECT_FALSE(update->change);
       EXPECT_EQ(update->message.header().frame_id, "frame");
       EXPECT_EQ(update->status, ContactArray::INVALID_REQUEST);
       EXPECT_NE(update->why_not.find("vertex 3 of 3"), std::string::npos) << update->why_not;
       EXPECT_EQ(in.rejected.by_reason().at("index out of range").count, 1U);
       EXPECT_EQ(in.next(), Texts{"liver vertices 1 refused"});
       EXPECT_EQ(in.intake.counts().received, 3U);
       EXPECT_EQ(in.intake.counts().refused, 3U);
     }},
    {"RemovesAnOrganButNotWhatIsNotThere",
     [](Intake& in) {
       EXPECT_FALSE(in.remove("liver", "organ 'liver' is unknown; no organ is known yet"));
       EXPECT_FALSE(in.remove("", "unknown"));
       EXPECT_FALSE(in.remove("\n", "control characters"));
       in.mesh("liver", 1);
       EXPECT_TRUE(in.remove("liver", "organ 'liver' is removed")) << "it may still wait";
       in.intake.next();
       const auto update = in.intake.next();
       ASSERT_TRUE(update);
       EXPECT_EQ(update->change, OrganChange::kRemoved);
       EXPECT_EQ(update->status, ContactArray::NO_MESH);
       EXPECT_TRUE(in.rejected.by_reason().empty());
       EXPECT_FALSE(in.remove("liver", "organ 'liver' was removed")) << "it is removed already";
     }},
    {"TheSurfaceOfNewTrianglesIsFoundElsewhereAndLoggedOnceUnlessTheOrganIsGone",
     [](Intake& in) {
       CapturedLog log;
       in.mesh("liver", 1);
       in.mesh("liver", 1);
       in.vertices("liver", 1);
       in.next();
       EXPECT_FALSE(in.organs.at("liver").surface()->is_found());
       in.inspector.callAvailable();
       EXPECT_TRUE(in.organs.at("liver").surface()->is_found());
       EXPECT_EQ(log.take(), Texts{"INFO organ 'liver': 1 face, open (3 edges), 1 x 1 x 0 m"});
       in.mesh("spleen", 1);
       in.next();
       in.remove("spleen", "");
       in.next();
       in.inspector.callAvailable();
       EXPECT_TRUE(log.take().empty());
     }},
};

class OrganIntakeTest : public testing::TestWithParam<IntakeCase> {};

TEST_P(OrganIntakeTest, Plays) {
  Intake intake;
  GetParam().play(intake);
}

INSTANTIATE_TEST_SUITE_P(Table, OrganIntakeTest, testing::ValuesIn(kIntakeCases),
                         [](const auto& info) { return info.param.name; });

TEST(LostMessages, AreMissingBetweenTwoOfTheSamePublisher) {
  std::map<std::string, std::uint32_t> last;
  struct Message {
    const char* publisher;
    std::uint32_t number, lost;
  };
  for (const Message& message :
       {Message{"/left", 7, 0},  // What came before was not for us.
        Message{"/left", 8, 0}, Message{"/right", 40, 0}, Message{"/left", 12, 3},
        Message{"/right", 42, 1}, Message{"/left", 0, 0},  // It started again.
        Message{"/left", 0, 0},                            // Within a process, there is no number.
        Message{"/left", 1, 0}}) {
    EXPECT_EQ(lost_before(last, message.publisher, message.number), message.lost)
        << message.publisher << ' ' << message.number;
  }
}

}  // namespace
