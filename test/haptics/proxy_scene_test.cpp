#include "haptics/proxy_scene.hpp"

#include <cmath>

#include "haptics/organ_interpolation.hpp"
#include "test/node/motion/tool_poses_fixture.hpp"
#include "test/node/organs/organ_fixture.hpp"

using namespace organ_collision;

namespace {

class ProxySceneTest : public OrganRegistryTest {
 protected:
  ProxyScene scene(const std::string& frame, const AgeLimits& limits = {}) {
    return proxy_scene(store_, transforms_, frame, limits, ros::Time(8), latest_shape);
  }

  static Timed<std::shared_ptr<const TriangleMesh>> latest_shape(const DeformableOrgan& organ) {
    return {organ.latest().mesh, organ.latest().stamp};
  }

  static OrganMesh new_mesh() {
    OrganMesh message = mesh("liver");
    message.header.stamp = ros::Time(7.9);
    return message;
  }

  void expect_refused(const std::string& frame, const AgeLimits& limits, std::uint8_t status,
                      const std::string& word) {
    try {
      scene(frame, limits);
      ADD_FAILURE() << "accepted";
    } catch (const Rejection& rejection) {
      EXPECT_EQ(rejection.status(), status);
      EXPECT_NE(std::string(rejection.what()).find(word), std::string::npos) << rejection.what();
    }
  }

  /// Sends a transform, which comes at `now` [s] with any stamp.
  void send_frame(double now, const char* parent, const char* child, double stamp = 7.0) {
    ros::Time::setNow(ros::Time(now));
    set_point(transforms_, parent, child, stamp, {0.1, 0.2, 0.3});
  }

  /// Without a frame, removes the organ.
  void send(const std::string& organ, const std::string& frame) {
    OrganMesh message;
    message.organ = organ;
    if (!frame.empty()) message = mesh(organ);
    if (!frame.empty()) message.header.frame_id = frame;
    apply(message, ros::Time(9));
  }

  TransformBuffer transforms_;
};

}  // namespace

TEST_F(ProxySceneTest, TheFrameIsThatOfTheFirstOrganAndStays) {
  ProxyFrame frame(""), fixed("world");
  const struct {
    const char *organ, *organ_frame;  ///< that comes, or leaves if it has no frame
    bool changes;
    const char* frame;
  } rows[] = {
      {"liver", "liver_frame", true, "liver_frame"},
      // The name of another organ comes first, but it came later.
      {"kidney", "kidney_frame", false, "liver_frame"},
      {"liver", "", true, "kidney_frame"},
      {"kidney", "", false, "kidney_frame"},
  };
  EXPECT_FALSE(frame.update(store_));
  EXPECT_EQ(frame.name(), "");
  for (const auto& row : rows) {
    send(row.organ, row.organ_frame);
    EXPECT_EQ(frame.update(store_), row.changes);
    EXPECT_EQ(frame.name(), row.frame);
    EXPECT_FALSE(fixed.update(store_));
    EXPECT_EQ(fixed.name(), "world");
  }
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
  EXPECT_EQ(found.motions[0].stamp, store_.at("kidney").latest().stamp);
}

TEST_F(ProxySceneTest, AnOrganWithoutATransformIsNamed) {
  apply(mesh("liver"), ros::Time(7));
  expect_refused("world", {}, ContactArray::NO_TRANSFORM, "organ 'liver': frame");
}

/// The stamps do not count: the clocks of the senders differ.
TEST_F(ProxySceneTest, AnOldFrameIsRefusedAndNamed) {
  apply(new_mesh(), ros::Time(7));
  send_frame(6.0, "world", "table", 6.5);
  send_frame(6.1, "world", "stand", 6.4);
  send_frame(6.2, "world", "stand", 8.9);
  send_frame(6.5, "world", "table", 8.5);
  send_frame(7.6, "table", "liver_frame", 8.0);
  struct {
    AgeLimits limits;
    const char* refusal;  ///< empty: accepted
  } const rows[] = {
      {{0.0, 0.0}, ""},
      {{0.0, 1.6}, ""},
      {{0.0, 1.4}, "frame 'table' came 1.5 s ago; at most 1.4 s are allowed (frame_timeout_sec)"},
      {{1.3, 0.0}, "frame 'table' came 1.5 s ago; at most 1.3 s are allowed (mesh_timeout_sec)"},
      {{1.3, 1.4}, "at most 1.3 s are allowed (mesh_timeout_sec)"},
      {{1.4, 1.3}, "at most 1.3 s are allowed (frame_timeout_sec)"},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.refusal);
    if (std::string(row.refusal).empty()) {
      EXPECT_NO_THROW(scene("world", row.limits));
    } else {
      expect_refused("world", row.limits, ContactArray::STALE_MESH, row.refusal);
    }
  }
  EXPECT_NO_THROW(scene("table", {0.0, 0.5})) << "the table carries both";
  expect_refused("stand", {0.0, 1.6}, ContactArray::STALE_MESH, "frame 'stand' came 1.8 s ago");
}

/// The organ's shape rises by 0.5 m/s, and TF carries its frame by 1 m/s along x.
TEST_F(ProxySceneTest, TissueMovesWithItsShapeAndWithItsFrame) {
  OrganMesh message = new_mesh();
  apply(message, ros::Time(7.9));
  message.header.stamp = ros::Time(7.92);
  for (std::size_t i = 2; i < message.vertices.size(); i += 3) message.vertices[i] += 0.01F;
  apply(message, ros::Time(7.92));
  for (const double time : {7.91, 7.92, 7.93, 7.94}) {
    set_point(transforms_, "world", "liver_frame", time, {time - 7.9, 0.2, 0.3});
  }
  FaceContact contact;
  contact.face = 0;
  contact.barycentric = {0.2, 0.3, 0.5};
  contact.point = {0.4, 0.5, 0.6};
  const auto velocity = [&](const std::string& frame, double now) {
    return tissue_velocity(
        proxy_scene(store_, transforms_, frame, {}, ros::Time(now), latest_shape), 0, contact);
  };
  EXPECT_LT((velocity("liver_frame", 7.93) - Eigen::Vector3d(0.0, 0.0, 0.5)).norm(), 1e-4);
  EXPECT_LT((velocity("world", 7.93) - Eigen::Vector3d(1.0, 0.0, 0.5)).norm(), 1e-4);
  EXPECT_EQ(velocity("liver_frame", 8.03), Eigen::Vector3d(0.0, 0.0, 0.0)) << "no shape came since";
  // A proxy asks for the corners of faces.
  ProxyScene late = proxy_scene(store_, transforms_, "world", {}, ros::Time(7.93), latest_shape);
  late.motions[0].lag_sec = 0.02;
  late.motions[0].frame_lag_sec = 0.005;
  ProxyOrgan told;
  tell_motion(late, 0, true, true, told);
  for (int axis = 0; axis < 3; ++axis) {
    contact.barycentric = Eigen::Vector3d::Unit(axis);
    contact.normal = -Eigen::Vector3d::Unit(axis);
    EXPECT_NEAR(told.advance(contact), Eigen::Vector3d(0.005, 0.0, 0.01)[axis], 1e-5) << axis;
    EXPECT_NEAR(told.approach(contact), Eigen::Vector3d(1.0, 0.0, 0.5)[axis], 1e-3) << axis;
    EXPECT_LE(told.advance(contact), told.most_advance);
    EXPECT_LE(told.approach(contact), told.most_approach);
  }
}

/// Heights of the first vertex [m], in milliseconds after each shape.
TEST_F(ProxySceneTest, AnInterpolatedOrganGoesFromShapeToShapeOnePeriodLate) {
  using std::chrono::milliseconds;
  OrganInterpolation shapes;
  const OrganInterpolation::Time start{std::chrono::hours(1)};
  OrganMesh message = mesh("liver");
  const float bottom = message.vertices[2];
  const auto send = [&](float height, int at) {
    message.vertices[2] = bottom + height;
    message.header.stamp = ros::Time(7.0 + 1e-3 * at);
    apply(message, ros::Time(7.0 + 1e-3 * at));
    shapes.update(store_, start + milliseconds(at));
  };
  const auto height = [&](int at) {
    return shapes.shape(store_.at("liver"), start + milliseconds(at))->vertices()[2] - bottom;
  };
  send(0.0F, 0);
  EXPECT_EQ(height(5), 0.0F);
  EXPECT_FALSE(shapes.is_moving(start + milliseconds(5)));
  send(0.02F, 20);
  EXPECT_NEAR(height(20), 0.0, 1e-7);
  EXPECT_NEAR(height(25), 0.005, 1e-7);
  EXPECT_TRUE(shapes.is_moving(start + milliseconds(25)));
  send(0.0F, 30);  // It turns back on its way: 10 mm high, it goes down within 10 ms.
  EXPECT_NEAR(height(30), 0.01, 1e-7);
  EXPECT_NEAR(height(35), 0.005, 1e-7);
  EXPECT_EQ(height(50), 0.0F);
  EXPECT_FALSE(shapes.is_moving(start + milliseconds(50)));
  send(0.04F, 5030);  // After a pause, within 100 ms.
  EXPECT_NEAR(height(5080), 0.02, 1e-7);
  message.topology = 9;  // New triangles are there at once.
  send(0.0F, 5090);
  EXPECT_EQ(height(5090), 0.0F);
}
