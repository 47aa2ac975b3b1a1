#include "ros/organs/surface_inspector.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <boost/make_shared.hpp>

#include "test/ros/organs/captured_log.hpp"
#include "test/ros/organs/solids.hpp"

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
