#include <embree3/rtcore.h>

#include <algorithm>

#include "embree_device.hpp"
#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {
namespace {

/// A scene with one user geometry, whose primitives are boxes: rtcCollide accepts no other kind.
class BoxScene {
 public:
  BoxScene(RTCDevice device, RTCBuildQuality quality)
      : geometry_(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER)), scene_(rtcNewScene(device)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    // Embree refits only in scenes of low quality, which keep a tree for each geometry.
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(geometry_, quality);
    rtcAttachGeometry(scene_, geometry_);
  }
  ~BoxScene() {
    rtcReleaseScene(scene_);
    rtcReleaseGeometry(geometry_);
  }
  BoxScene(const BoxScene&) = delete;
  BoxScene& operator=(const BoxScene&) = delete;

  void set_primitives(std::size_t count, RTCBoundsFunction bounds, void* user) {
    rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(count));
    rtcSetGeometryUserData(geometry_, user);
    rtcSetGeometryBoundsFunction(geometry_, bounds, nullptr);
  }
  void commit() {
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }
  RTCScene scene() const { return scene_; }

 private:
  RTCGeometry geometry_;
  RTCScene scene_;
};

class Embree : public Engine {
 public:
  Embree()
      : organ_scene_(device_.get(), RTC_BUILD_QUALITY_REFIT),
        tool_scene_(device_.get(), RTC_BUILD_QUALITY_LOW) {
    tool_scene_.set_primitives(1, &Embree::tool_bounds, this);
  }

  void set_topology(const OrganSurface& organ, const std::vector<float>& rest) override {
    organ_ = &organ;
    vertices_ = &rest;
    organ_scene_.set_primitives(organ.face_count(), &Embree::face_bounds, this);
    organ_scene_.commit();
  }

  void update(const SharedVertices& vertices) override {
    vertices_ = vertices.get();
    organ_scene_.commit();
  }

  void query(const VolumeQuery& query, std::vector<std::uint32_t>& faces) override {
    tool_box_ = box_within_organ(query).cast<float>();
    tool_scene_.commit();
    faces.clear();
    rtcCollide(organ_scene_.scene(), tool_scene_.scene(), &Embree::on_collisions, &faces);
    keep_faces_that_meet(query, *organ_, *vertices_, faces);
  }

 private:
  static void set(const Eigen::Array3f& low, const Eigen::Array3f& high, RTCBounds& bounds) {
    Eigen::Map<Eigen::Array3f>(&bounds.lower_x) = low;
    Eigen::Map<Eigen::Array3f>(&bounds.upper_x) = high;
  }

  static void face_bounds(const RTCBoundsFunctionArguments* arguments) {
    const Embree& engine = *static_cast<Embree*>(arguments->geometryUserPtr);
    const std::uint32_t* corner = &engine.organ_->triangles[3 * arguments->primID];
    const auto vertex = [&](int i) {
      return Eigen::Map<const Eigen::Array3f>(&(*engine.vertices_)[3 * corner[i]]);
    };
    set(vertex(0).min(vertex(1)).min(vertex(2)), vertex(0).max(vertex(1)).max(vertex(2)),
        *arguments->bounds_o);
  }

  static void tool_bounds(const RTCBoundsFunctionArguments* arguments) {
    const Embree& engine = *static_cast<Embree*>(arguments->geometryUserPtr);
    set(engine.tool_box_.min(), engine.tool_box_.max(), *arguments->bounds_o);
  }

  static void on_collisions(void* user, RTCCollision* collisions, unsigned count) {
    auto& faces = *static_cast<std::vector<std::uint32_t>*>(user);
    for (unsigned i = 0; i < count; ++i) faces.push_back(collisions[i].primID0);
  }

  EmbreeDevice device_;
  BoxScene organ_scene_;
  BoxScene tool_scene_;
  const OrganSurface* organ_ = nullptr;
  const std::vector<float>* vertices_ = nullptr;
  Eigen::AlignedBox3f tool_box_;
};

}  // namespace

std::unique_ptr<Engine> make_embree() { return std::make_unique<Embree>(); }

}  // namespace organ_collision::bench
