#include "ros/organs/organ_report.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>
#include <future>
#include <list>

#include "ros/organs/organ_services.hpp"
#include "test/ros/organs/organ_fixture.hpp"

using namespace organ_collision;

namespace {

using Texts = std::vector<std::string>;

/// A kidney whose surface is found.
OrganSurface& kidney(const std::vector<std::uint32_t>& triangles = kOutward, float unit = 1.0F) {
  static std::list<OrganSurface> surfaces;
  OrganSurface& surface = surfaces.emplace_back(tetrahedron(triangles, unit));
  surface.find();
  return surface;
}

const char kWhatCame[] = "organ 'kidney': 4 faces, closed, 0.03 x 0.04 x 0.05 m";

OrganMeshConstPtr message(const std::string& organ, const std::vector<std::uint32_t>& triangles,
                          double stamp, float unit = 1.0F) {
  const auto mesh = boost::make_shared<OrganMesh>();
  mesh->header.frame_id = "/" + organ + "_frame";
  mesh->header.stamp = ros::Time(stamp);
  mesh->organ = organ;
  mesh->topology = 7;
  mesh->vertices = corners(unit);
  mesh->triangles = triangles;
  return mesh;
}

}  // namespace

TEST(OrganReport, SaysWhatCame) {
  EXPECT_EQ(summary("kidney", kidney()), kWhatCame);
  EXPECT_EQ(summary("kidney", kidney({0, 1, 2})),
            "organ 'kidney': 1 face, open (3 edges), 0.03 x 0.04 x 0.05 m");
  EXPECT_EQ(orientation(kidney()), "outward");
  EXPECT_EQ(orientation(kidney(kInward)), "inward");
  EXPECT_EQ(orientation(kidney({0, 1, 2})), "none");
  const OrganSurface unknown(tetrahedron(kInward));
  EXPECT_EQ(closedness(unknown), "not yet known");
  EXPECT_EQ(orientation(unknown), "not yet known");
  EXPECT_TRUE(doubts("kidney", unknown.box(), unknown).empty());
}

TEST(OrganReport, DoubtsWhatIsProbablyAMistake) {
  const auto doubts_about = [](const OrganSurface& surface) {
    return doubts("kidney", surface.box(), surface);
  };
  EXPECT_TRUE(doubts_about(kidney()).empty());
  EXPECT_TRUE(doubts_about(kidney({0, 1, 2})).empty()) << "an open surface is no mistake";
  const Texts millimetres = doubts_about(kidney(kOutward, 1000.0F));
  ASSERT_EQ(millimetres.size(), 1U);
  EXPECT_NE(millimetres[0].find("are these millimetres?"), std::string::npos) << millimetres[0];
  const Texts both = doubts_about(kidney(kInward, 1e-3F));
  ASSERT_EQ(both.size(), 2U);
  EXPECT_NE(both[0].find("twice"), std::string::npos) << both[0];
  EXPECT_NE(both[1].find("organ 'kidney' point inward"), std::string::npos) << both[1];
}

TEST(SurfaceLog, CutsAtEveryStepDoNotFloodTheLog) {
  CapturedLog captured;
  SurfaceLog log;
  SurfaceLog::Time now{std::chrono::hours(1)};
  const auto logged = [&](const OrganSurface& surface, std::chrono::seconds later) {
    log.tell("kidney", surface, now += later);
    return captured.take();
  };
  using std::chrono::seconds;
  const Texts came = {std::string("INFO ") + kWhatCame};
  EXPECT_EQ(logged(kidney(), seconds(0)), came);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(logged(kidney(), seconds(1)).empty());
  const Texts doubted = logged(kidney(kInward), seconds(1));  // A doubt is said at once.
  ASSERT_EQ(doubted.size(), 1U);
  EXPECT_EQ(doubted[0].find("WARN the faces of organ 'kidney' point inward"), 0U) << doubted[0];
  EXPECT_EQ(logged(kidney(kInward), seconds(1)), came);
  EXPECT_EQ(logged(kidney(kInward), seconds(5)).size(), 2U);
  log.tell("liver", kidney(), now);
  EXPECT_EQ(captured.take().size(), 1U) << "another organ";
}

TEST(OrganList, EverythingAboutTheLatestShapeOfEachOrgan) {
  OrganRegistry organs{MeshLimits{}};
  EXPECT_TRUE(list_organs(organs).empty());
  organs.apply(message("spleen", {0, 1, 2}, 3.0), ros::Time(9));
  organs.apply(message("kidney", kInward, 4.0), ros::Time(9));
  organs.apply(message("kidney", kInward, 5.0, 2.0F), ros::Time(9));
  const std::vector<ListedOrgan> list = list_organs(organs);
  ASSERT_EQ(list.size(), 2U);

  const OrganInfo kidney = completed(list[0]);
  EXPECT_EQ(kidney.name, "kidney");
  EXPECT_EQ(kidney.frame, "kidney_frame");
  EXPECT_EQ(kidney.topology, 7U);
  EXPECT_EQ(kidney.faces, 4U);
  EXPECT_EQ(kidney.vertices, 4U);
  EXPECT_TRUE(kidney.closed);
  EXPECT_NEAR(kidney.volume, -8e-5, 1e-10);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.low.x), 0.2F);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.high.y), 0.48F);
  EXPECT_EQ(kidney.stamp, ros::Time(5.0));

  const OrganInfo spleen = completed(list[1]);
  EXPECT_EQ(spleen.name, "spleen");
  EXPECT_FALSE(spleen.closed);
  EXPECT_EQ(spleen.volume, 0.0);
}

namespace {

/// This thread is the node's thread. Another one takes the place of the background thread.
class OrganServicesTest : public testing::Test {
 protected:
  OrganServicesTest() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(50.0));
    for (const char* organ : {"spleen", "kidney"})
      intake_.take_mesh(message(organ, kOutward, 50.0));
    apply();
  }

  void apply() {
    while (intake_.next()) {
    }
  }
  std::vector<OrganInfo> list() {
    std::future<ListOrgans::Response> answer = std::async(std::launch::async, [this] {
      ListOrgans::Request request;
      ListOrgans::Response response;
      EXPECT_TRUE(services_.on_list(request, response));
      return response;
    });
    node_queue_.callOne(ros::WallDuration(20.0));
    return answer.get().organs;
  }
  RemoveOrgan::Response remove(const std::string& organ) {
    RemoveOrgan::Request request;
    request.name = organ;
    RemoveOrgan::Response response;
    EXPECT_TRUE(services_.on_remove(request, response));
    apply();
    return response;
  }

  ros::CallbackQueue node_queue_, background_;
  OrganRegistry organs_{MeshLimits{}};
  FailureLog rejected_;
  OrganIntake intake_{organs_, rejected_};
  OrganServices services_{organs_, intake_, node_queue_, background_};
};

}  // namespace

TEST_F(OrganServicesTest, ListsWhatTheNodeHas) {
  const auto organs = list();
  ASSERT_EQ(organs.size(), 2U);
  EXPECT_EQ(organs[0].name, "kidney");
  EXPECT_TRUE(organs[0].closed);
  EXPECT_GT(organs[0].volume, 0.0);
  EXPECT_EQ(organs[1].name, "spleen");
}

TEST_F(OrganServicesTest, RemovesAnOrganButNotWhatIsNotThere) {
  const RemoveOrgan::Response unknown = remove("liver");
  EXPECT_FALSE(unknown.success);
  EXPECT_EQ(unknown.message, "organ 'liver' is unknown; known are 'kidney', 'spleen'");
  EXPECT_FALSE(remove("").success);
  EXPECT_FALSE(remove("\xFF").success);
  const RemoveOrgan::Response removed = remove("kidney");
  EXPECT_TRUE(removed.success);
  EXPECT_EQ(removed.message, "organ 'kidney' is removed");
  EXPECT_EQ(list().size(), 1U);
}
