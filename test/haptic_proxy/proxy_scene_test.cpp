#include "haptic_proxy/proxy_scene.hpp"

#include "test/ros/motion/hand_filled_transforms.hpp"
#include "test/ros/organs/organ_registry_fixture.hpp"

using namespace organ_collision;

namespace {

class ProxySceneTest : public OrganRegistryTest {
 protected:
  ProxyScene scene(const std::string& frame, double mesh_timeout_sec = 0.0) {
    return proxy_scene(store_, transforms_, frame, mesh_timeout_sec, ros::Time(8));
  }

  void expect_refused(const std::string& frame, double mesh_timeout_sec, std::uint8_t status,
                      const std::string& word) {
    try {
      scene(frame, mesh_timeout_sec);
      ADD_FAILURE() << "accepted";
    } catch (const Rejection& rejection) {
      EXPECT_EQ(rejection.status(), status);
      EXPECT_NE(std::string(rejection.what()).find(word), std::string::npos) << rejection.what();
    }
  }

  TransformBuffer transforms_;
};

}  // namespace

TEST_F(ProxySceneTest, WithoutAnOrganThereIsNone) {
  expect_refused("liver_frame", 0.0, ContactArray::NO_MESH, "there is no organ");
}

TEST_F(ProxySceneTest, HasEachOrganWithItsLatestShapeAndPose) {
  apply(mesh("liver"), ros::Time(7));
  OrganMesh moved = mesh("kidney");
  moved.header.frame_id = "kidney_frame";
  apply(moved, ros::Time(7));
  const Eigen::Isometry3d T_liver_kidney =
      Eigen::Translation3d(0.0, 0.25, 0.0) *
      Eigen::AngleAxisd(1.3, Eigen::Vector3d(0.2, -0.6, 0.7).normalized());
  set_transform(transforms_, "liver_frame", "kidney_frame", 6.0, T_liver_kidney);
  const ProxyScene found = scene("liver_frame");
  ASSERT_EQ(found.organs.size(), 2U);
  EXPECT_EQ(found.organs[0].name, "kidney");
  EXPECT_EQ(found.organs[0].shape, store_.at("kidney").latest().mesh);
  EXPECT_EQ(found.sources[1], &store_.at("liver"));
  EXPECT_TRUE(found.organs[1].T_organ_proxy.matrix().isIdentity(0.0));
  EXPECT_TRUE(found.organs[0].T_organ_proxy.isApprox(T_liver_kidney.inverse(), 1e-9));
}

TEST_F(ProxySceneTest, AnOrganWithoutATransformIsNamed) {
  apply(mesh("liver"), ros::Time(7));
  expect_refused("world", 0.0, ContactArray::NO_TRANSFORM, "organ 'liver': frame");
}

TEST_F(ProxySceneTest, AnOldMeshIsRefused) {
  apply(mesh("liver"), ros::Time(7));
  EXPECT_NO_THROW(scene("liver_frame", 3.5));
  expect_refused("liver_frame", 2.5, ContactArray::STALE_MESH, "mesh_timeout_sec");
}
