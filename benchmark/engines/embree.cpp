#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine.hpp"
#include "exact_clip.hpp"

namespace organ_collision::bench {

/// Embree's device, which works in the calling thread alone.
class EmbreeDevice {
 public:
  EmbreeDevice() : device_(rtcNewDevice("threads=1,set_affinity=0")) {
    if (!device_) throw std::runtime_error("Embree gives no device");
  }
  ~EmbreeDevice() { rtcReleaseDevice(device_); }
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;
  RTCDevice get() const { return device_; }

 private:
  RTCDevice device_;
};

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

namespace {

using Eigen::Vector3f;

float squared_distance(const Vector3f& point, const Vector3f& from, const Vector3f& to) {
  const Vector3f edge = to - from;
  const float place = edge.dot(point - from) / std::max(edge.squaredNorm(), 1e-30F);
  return (from + std::clamp(place, 0.0F, 1.0F) * edge - point).squaredNorm();
}

/// The squared distance from a point to a face: to its plane if the point is above its interior,
/// else to its edges.
float squared_distance(const Vector3f& point, const std::array<Vector3f, 3>& face) {
  const Vector3f normal = (face[1] - face[0]).cross(face[2] - face[0]);
  bool is_above = true;
  for (int i = 0; i < 3; ++i) {
    const Vector3f inward = normal.cross(face[(i + 1) % 3] - face[i]);
    is_above = is_above && inward.dot(point - face[i]) > 0.0F;
  }
  if (is_above) {
    const float height = normal.dot(point - face[0]);
    return height * height / normal.squaredNorm();
  }
  return std::min({squared_distance(point, face[0], face[1]),
                   squared_distance(point, face[1], face[2]),
                   squared_distance(point, face[2], face[0])});
}

class EmbreePointQuery : public Locator {
 public:
  EmbreePointQuery()
      : geometry_(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE)),
        scene_(rtcNewScene(device_.get())) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    // Embree refits only in scenes of low quality, which keep a tree for each geometry.
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
  }
  ~EmbreePointQuery() override {
    rtcReleaseScene(scene_);
    rtcReleaseGeometry(geometry_);
  }
  EmbreePointQuery(const EmbreePointQuery&) = delete;
  EmbreePointQuery& operator=(const EmbreePointQuery&) = delete;

  void set_topology(const OrganSurface& organ) override {
    organ_ = &organ;
    void* triangles = rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              3 * sizeof(std::uint32_t), organ.face_count());
    std::copy(organ.triangles.begin(), organ.triangles.end(),
              static_cast<std::uint32_t*>(triangles));
    // A buffer of its own: Embree reads 16 bytes for each vertex, past the end of a message's
    // array.
    vertices_ = static_cast<float*>(rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0,
                                                            RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                            organ.vertices.size() / 3));
    std::copy(organ.vertices.begin(), organ.vertices.end(), vertices_);
    rtcCommitGeometry(geometry_);
    rtcAttachGeometry(scene_, geometry_);
    rtcCommitScene(scene_);
  }

  void update(const SharedVertices& vertices) override {
    std::copy(vertices->begin(), vertices->end(), vertices_);
    rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }

  Location locate(const ShaftAxis& axis, double /*radius*/) override {
    RTCPointQuery query;
    tip_ = axis.tip.cast<float>();
    Eigen::Map<Vector3f>(&query.x) = tip_;
    query.time = 0.0F;
    query.radius = static_cast<float>(kWhereLimit);
    least_ = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, &EmbreePointQuery::visit, this);
    Location location;
    location.tip_distance = least_;
    return location;
  }

 private:
  Vector3f corner(unsigned face, int i) const {
    return Eigen::Map<const Vector3f>(vertices_ + 3 * organ_->triangles[3 * face + i]);
  }

  /// Measures one face, and shrinks the query to the nearest one so far.
  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& locator = *static_cast<EmbreePointQuery*>(arguments->userPtr);
    const unsigned face = arguments->primID;
    const float distance = std::sqrt(squared_distance(
        locator.tip_, {locator.corner(face, 0), locator.corner(face, 1), locator.corner(face, 2)}));
    if (distance >= arguments->query->radius) return false;
    locator.least_ = arguments->query->radius = distance;
    return true;
  }

  EmbreeDevice device_;
  RTCGeometry geometry_;
  RTCScene scene_;
  const OrganSurface* organ_ = nullptr;
  float* vertices_ = nullptr;
  Vector3f tip_;
  float least_ = 0.0F;
};

}  // namespace

std::unique_ptr<Locator> make_embree_locator() { return std::make_unique<EmbreePointQuery>(); }

}  // namespace organ_collision::bench
