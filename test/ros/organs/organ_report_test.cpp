#include "ros/organs/organ_report.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>
#include <future>

#include "organ_fixture.hpp"
#include "ros/organs/organ_services.hpp"

using namespace organ_collision;

namespace {

DeformableOrgan kidney(const std::vector<std::uint32_t>& triangles = kOutward, float unit = 1.0F) {
  DeformableOrgan organ("kidney", "kidney_frame", tetrahedron(triangles, unit), {}, {});
  organ.surface()->find();
  return organ;
}

}  // namespace

TEST(OrganReport, SaysWhatCame) {
  EXPECT_EQ(summary(kidney()), "organ 'kidney': 4 faces, closed, 0.03 x 0.04 x 0.05 m");
  EXPECT_EQ(summary(kidney({0, 1, 2})),
            "organ 'kidney': 1 face, open (3 edges), 0.03 x 0.04 x 0.05 m");
  EXPECT_EQ(orientation(*kidney().surface()), "outward");
  EXPECT_EQ(orientation(*kidney(kInward).surface()), "inward");
  EXPECT_EQ(orientation(*kidney({0, 1, 2}).surface()), "none");
}

TEST(OrganReport, BeforeTheSurfaceIsFound) {
  const DeformableOrgan organ("kidney", "kidney_frame", tetrahedron(kInward), {}, {});
  EXPECT_EQ(closedness(*organ.surface()), "not yet known");
  EXPECT_EQ(orientation(*organ.surface()), "not yet known");
  EXPECT_TRUE(doubts(organ).empty());
}

TEST(OrganReport, DoubtsWhatIsProbablyAMistake) {
  EXPECT_TRUE(doubts(kidney()).empty());
  EXPECT_TRUE(doubts(kidney({0, 1, 2})).empty()) << "an open surface is no mistake";
  const auto millimetres = doubts(kidney(kOutward, 1000.0F));
  ASSERT_EQ(millimetres.size(), 1u);
  EXPECT_NE(millimetres[0].find("are these millimetres?"), std::string::npos) << millimetres[0];
  const auto both = doubts(kidney(kInward, 1e-3F));
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NE(both[0].find("twice"), std::string::npos) << both[0];
  EXPECT_NE(both[1].find("organ 'kidney' point inward"), std::string::npos) << both[1];
}

using namespace organ_collision;

namespace {

using Texts = std::vector<std::string>;

class SurfaceInspectorTest : public testing::Test {
 protected:
  void send(const std::string& organ, std::uint32_t topology,
            const std::vector<std::uint32_t>& triangles = kOutward) {
    const auto mesh = boost::make_shared<OrganMesh>();
    mesh->header.frame_id = "frame";
    mesh->organ = organ;
    mesh->topology = topology;
    mesh->vertices = corners();
    mesh->triangles = triangles;
    organs_.apply(OrganMeshConstPtr(mesh), ros::Time(1));
  }
  void remove(const std::string& organ) {
    const auto mesh = boost::make_shared<OrganMesh>();
    mesh->organ = organ;
    organs_.apply(OrganMeshConstPtr(mesh), ros::Time(1));
  }
  /// What is logged while the background thread works, and the node's thread takes it over.
  Texts inspect(std::chrono::seconds later = std::chrono::seconds(0)) {
    now_ += later;
    inspector_.update(organs_, now_);
    background_.callAvailable();
    inspector_.update(organs_, now_);
    return log_.take();
  }

  CapturedLog log_;
  ros::CallbackQueue background_;
  OrganRegistry organs_{MeshLimits{}};
  SurfaceInspector inspector_{background_};
  SurfaceInspector::Time now_{std::chrono::hours(1)};
};

const char kWhatCame[] = "INFO organ 'kidney': 4 faces, closed, 0.03 x 0.04 x 0.05 m";

}  // namespace

TEST_F(SurfaceInspectorTest, TheBackgroundThreadDoesTheWork) {
  send("kidney", 1);
  inspector_.update(organs_, now_);
  EXPECT_FALSE(organs_.at("kidney").surface()->is_found());
  EXPECT_TRUE(log_.take().empty());
  background_.callAvailable();
  EXPECT_TRUE(organs_.at("kidney").surface()->is_found());
  inspector_.update(organs_, now_);
  EXPECT_EQ(log_.take(), Texts{kWhatCame});
}

TEST_F(SurfaceInspectorTest, SaysWhatCameOnce) {
  send("kidney", 1);
  EXPECT_EQ(inspect(), Texts{kWhatCame});
  EXPECT_TRUE(inspect(std::chrono::hours(1)).empty());
  send("kidney", 1);  // The same triangles are a new shape.
  EXPECT_TRUE(inspect().empty());
  EXPECT_TRUE(background_.isEmpty());
}

TEST_F(SurfaceInspectorTest, CutsAtEveryStepDoNotFloodTheLog) {
  send("kidney", 1);
  EXPECT_EQ(inspect(), Texts{kWhatCame});
  for (std::uint32_t topology = 2; topology < 6; ++topology) {
    send("kidney", topology);
    EXPECT_TRUE(inspect(std::chrono::seconds(1)).empty());
  }
  send("kidney", 6);
  EXPECT_EQ(inspect(std::chrono::seconds(1)), Texts{kWhatCame});
}

TEST_F(SurfaceInspectorTest, ADoubtIsSaidAtOnceAndThenSeldom) {
  send("kidney", 1);
  inspect();
  send("kidney", 2, kInward);
  const Texts warned = inspect(std::chrono::seconds(1));
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_EQ(warned[0].find("WARN the faces of organ 'kidney' point inward"), 0u) << warned[0];
  send("kidney", 3, kInward);
  EXPECT_TRUE(inspect(std::chrono::seconds(1)).empty());
  send("kidney", 4, kInward);
  EXPECT_EQ(inspect(std::chrono::seconds(5)).size(), 2u);
}

TEST_F(SurfaceInspectorTest, AnOrganThatComesAgainIsNew) {
  send("kidney", 1);
  EXPECT_EQ(inspect(), Texts{kWhatCame});
  remove("kidney");
  EXPECT_TRUE(inspect().empty());
  send("kidney", 1);
  EXPECT_EQ(inspect(), Texts{kWhatCame});
}

TEST_F(SurfaceInspectorTest, ASurfaceThatNobodyNeedsAnyMoreIsLeftOut) {
  send("kidney", 1);
  inspector_.update(organs_, now_);
  send("kidney", 2, {0, 1, 2});
  inspector_.update(organs_, now_);
  background_.callAvailable();
  inspector_.update(organs_, now_);
  EXPECT_EQ(log_.take(),
            Texts{"INFO organ 'kidney': 1 face, open (3 edges), 0.03 x 0.04 x 0.05 m"});
  remove("kidney");
  EXPECT_TRUE(inspect().empty());
}

using namespace organ_collision;

namespace {

OrganMeshConstPtr message(const std::string& organ, const std::vector<std::uint32_t>& triangles,
                          double stamp) {
  const auto mesh = boost::make_shared<OrganMesh>();
  mesh->header.frame_id = "/" + organ + "_frame";
  mesh->header.stamp = ros::Time(stamp);
  mesh->organ = organ;
  mesh->topology = 7;
  mesh->vertices = corners();
  mesh->triangles = triangles;
  return mesh;
}

}  // namespace

TEST(OrganList, EverythingAboutEachOrgan) {
  OrganRegistry organs{MeshLimits{}};
  EXPECT_TRUE(list_organs(organs).empty());
  organs.apply(message("spleen", {0, 1, 2}, 3.0), ros::Time(9));
  organs.apply(message("kidney", kInward, 4.0), ros::Time(9));
  const std::vector<ListedOrgan> list = list_organs(organs);
  ASSERT_EQ(list.size(), 2u);

  const OrganInfo kidney = completed(list[0]);
  EXPECT_EQ(kidney.name, "kidney");
  EXPECT_EQ(kidney.frame, "kidney_frame");
  EXPECT_EQ(kidney.topology, 7u);
  EXPECT_EQ(kidney.faces, 4u);
  EXPECT_EQ(kidney.vertices, 4u);
  EXPECT_TRUE(kidney.closed);
  EXPECT_NEAR(kidney.volume, -1e-5, 1e-11);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.low.x), 0.1F);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.low.z), 0.3F);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.high.y), 0.24F);
  EXPECT_EQ(kidney.stamp, ros::Time(4.0));

  const OrganInfo spleen = completed(list[1]);
  EXPECT_EQ(spleen.name, "spleen");
  EXPECT_FALSE(spleen.closed);
  EXPECT_EQ(spleen.volume, 0.0);
}

TEST(OrganList, VolumeAndBoxAreOfTheLatestShape) {
  OrganRegistry organs{MeshLimits{}};
  organs.apply(message("kidney", kOutward, 4.0), ros::Time(9));
  const auto larger = boost::make_shared<OrganMesh>(*message("kidney", kOutward, 5.0));
  for (float& coordinate : larger->vertices) coordinate *= 2.0F;
  organs.apply(OrganMeshConstPtr(larger), ros::Time(9));
  const OrganInfo kidney = completed(list_organs(organs).front());
  EXPECT_NEAR(kidney.volume, 8e-5, 1e-10);
  EXPECT_FLOAT_EQ(static_cast<float>(kidney.high.x), 0.26F);
  EXPECT_EQ(kidney.stamp, ros::Time(5.0));
}

using namespace organ_collision;

namespace {

/// This thread is the node's thread. Another one takes the place of the background thread.
class OrganServicesTest : public testing::Test {
 protected:
  OrganServicesTest() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(50.0));
  }

  void send(const std::string& organ) {
    const auto mesh = boost::make_shared<OrganMesh>();
    mesh->header.frame_id = "frame";
    mesh->organ = organ;
    mesh->vertices = corners();
    mesh->triangles = kOutward;
    topics_.take_mesh(mesh);
    apply();
  }
  void apply() {
    while (topics_.next()) {
    }
  }

  ListOrgans::Response list() {
    const auto call = [this] {
      ListOrgans::Request request;
      ListOrgans::Response response;
      EXPECT_TRUE(services_.on_list(request, response));
      return response;
    };
    std::future<ListOrgans::Response> answer = std::async(std::launch::async, call);
    node_queue_.callOne(ros::WallDuration(20.0));
    return answer.get();
  }
  RemoveOrgan::Response remove(const std::string& organ) {
    RemoveOrgan::Request request;
    request.name = organ;
    RemoveOrgan::Response response;
    EXPECT_TRUE(services_.on_remove(request, response));
    return response;
  }

  ros::CallbackQueue node_queue_, background_;
  OrganRegistry organs_{MeshLimits{}};
  FailureLog rejected_;
  OrganTopics topics_{organs_, rejected_, node_queue_};
  OrganServices services_{{organs_, topics_, node_queue_, background_}};
};

}  // namespace

TEST_F(OrganServicesTest, ListsWhatTheNodeHas) {
  EXPECT_TRUE(list().organs.empty());
  send("spleen");
  send("kidney");
  const auto organs = list().organs;
  ASSERT_EQ(organs.size(), 2u);
  EXPECT_EQ(organs[0].name, "kidney");
  EXPECT_TRUE(organs[0].closed);
  EXPECT_GT(organs[0].volume, 0.0);
  EXPECT_EQ(organs[1].name, "spleen");
}

TEST_F(OrganServicesTest, RemovesAnOrgan) {
  send("kidney");
  const RemoveOrgan::Response removed = remove("kidney");
  EXPECT_TRUE(removed.success);
  EXPECT_EQ(removed.message, "organ 'kidney' is removed");
  apply();
  EXPECT_TRUE(list().organs.empty());
}

TEST_F(OrganServicesTest, RefusesToRemoveWhatIsNotThere) {
  send("kidney");
  const RemoveOrgan::Response unknown = remove("liver");
  EXPECT_FALSE(unknown.success);
  EXPECT_EQ(unknown.message, "organ 'liver' is unknown; known are 'kidney'");
  EXPECT_FALSE(remove("").success);
  EXPECT_FALSE(remove("\xFF").success);
  apply();
  EXPECT_EQ(organs_.organs().size(), 1u);
}
