// collision_query.hpp: the contacts of whole tools, with each picker; what is refused.
#include "organ_collision/query/collision_query.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "picking/pickers/picker.hpp"
#include "picking/volumes/paper_volumes.hpp"
#include "scenes.hpp"
#include "test/proof/exact_distance.hpp"
#include "test/refusals.hpp"

namespace organ_collision {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using oracle::Random;

/// The shaft and the organ's vertices as they are at a share of the step.
ShaftAxis axis_at(const ToolPath& path, double fraction) {
  std::size_t next = 1;
  while (next + 1 < path.size() && path[next].fraction < fraction) ++next;
  const ToolWaypoint &from = path[next - 1], &to = path[next];
  const double share = (fraction - from.fraction) / (to.fraction - from.fraction);
  return {from.axis.trocar + share * (to.axis.trocar - from.axis.trocar),
          from.axis.tip + share * (to.axis.tip - from.axis.tip)};
}
std::vector<float> vertices_at(const TriangleMesh& before, const TriangleMesh& after,
                               double fraction) {
  std::vector<float> vertices;
  for (std::size_t i = 0; i < after.vertices().size(); ++i) {
    const double from = before.vertices()[i], to = after.vertices()[i];
    vertices.push_back(static_cast<float>(from + fraction * (to - from)));
  }
  return vertices;
}

// The organ has many clusters, made for its first shape. Most of them are far from the tool. At
// several times of the step, what is nearer to the axis than the radius is touched.
TEST_P(CollisionQueryWith, ClustersCostNoContact) {
  constexpr double kRounding = 1e-6;  // [m] of vertices in 32 bits
  Random random(6);
  std::size_t found = 0;
  for (int i = 0; i < 60 && !HasFailure(); ++i) {
    const int side = random.integer(2, 90);
    const bool shuffle = random.chance(0.5);
    const auto sheet = [&](double phase) {
      const GridSurface grid = grid_surface(side, phase);
      return mesh(shuffle ? shuffled(grid, 4) : grid);
    };
    TriangleMesh organ = sheet(0.0);
    const double phase = random.uniform(0.0, 3.0);
    const TriangleMesh before = sheet(phase);
    organ.move_vertices(sheet(phase + 0.1).vertices());
    CollisionRequest request =
        swept(organ, random_path(random.chance(0.5), random), random.scale(0.2e-3, 0.01));
    const bool moves = random.chance(0.5);
    if (moves) request.organ_before = &before;
    std::vector<bool> is_touched(organ.face_count());
    for (const FaceContact& contact : contacts(request)) {
      is_touched[contact.face] = true;
      ++found;
    }
    TriangleMesh then = organ;
    for (const double fraction : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
      then.move_vertices(vertices_at(moves ? before : organ, organ, fraction));
      const CollisionRequest at_rest =
          swept(then, {{0.0, axis_at(request.path, fraction)}}, request.radius);
      const std::vector<double> distances = distances_at_end(at_rest);
      for (std::uint32_t face = 0; face < distances.size(); ++face) {
        EXPECT_TRUE(is_touched[face] || distances[face] >= -kRounding) << face;
      }
    }
  }
  EXPECT_GT(found, 600U);
}

// The face lies in the plane z = 0. One triangle of the tool ends 5e-9 m above it, the other 0.01 m
// below.
TEST_P(CollisionQueryWith, TheDeepestOfAToolsTrianglesIsTheContact) {
  const TriangleMesh organ({-1.0F, -1.0F, 0.0F, 2.0F, -1.0F, 0.0F, -1.0F, 2.0F, 0.0F}, {0, 1, 2});
  ToolMesh tool;
  tool.vertices = {{0.00, 0.0, 0.1}, {0.01, 0.0, 0.1}, {0.0, 0.0, 5e-9},
                   {0.02, 0.0, 0.1}, {0.03, 0.0, 0.1}, {0.02, 0.0, -0.01}};
  for (const std::vector<FaceIndices>& faces :
       {std::vector<FaceIndices>{{0, 1, 2}, {3, 4, 5}}, {{3, 4, 5}, {0, 1, 2}}}) {
    tool.faces = faces;
    const std::vector<Link> links = {{"jaw", {LinkPart::mesh(tool.surface())}}};
    CollisionRequest request = swept(organ, {{0.0, kNoShaft, {Isometry3d::Identity()}}}, 0.0);
    request.links = &links;
    request.mode = QueryMode::kStatic;
    ASSERT_EQ(contacts(request).size(), 1U);
    EXPECT_NEAR(result_.contacts[0].depth, 0.01, 1e-7);
  }
}

// A region lies in its face, and in the volume of a part of the link that touched.
TEST_P(CollisionQueryWith, RegionsAreInTheFaceAndInTheVolumeOfTheLinkThatTouched) {
  Random random(24);
  std::size_t filled = 0, all = 0;
  for (int i = 0; i < 30; ++i) {
    LinkScene scene(false, random, 0.1);
    CollisionRequest& request = scene.request;
    request.organ_before = nullptr;
    request.path = {{0.0, request.path[0].axis, request.path[0].links},
                    {1.0, request.path[1].axis, request.path[1].links}};
    request.regions = true;
    contacts(request);
    ASSERT_EQ(result_.regions.size(), result_.contacts.size());
    all += result_.regions.size();
    for (std::size_t k = 0; k < result_.regions.size(); ++k) {
      const FaceContact& contact = result_.contacts[k];
      filled += result_.regions[k].size() >= 3;
      std::vector<ViewingVolume> volumes;
      const ToolWaypoint &from = request.path[0], &to = request.path[1];
      if (contact.link < 0) {
        const ShaftMotion shaft{from.axis, to.axis};
        volumes.push_back(PartSweep(shaft, request.radius).tool_volume());
      } else {
        const auto link = static_cast<std::size_t>(contact.link);
        const RigidMotion motion(from.links[link], to.links[link]);
        for (const LinkPart& part : scene.links[link].parts) {
          const MovingLinkPart moving(part, scene.links[link], contact.link, motion,
                                      to.links[link]);
          volumes.push_back(moving.sweep(0.0).tool_volume());
        }
      }
      for (const Vector3d& corner : result_.regions[k]) {
        EXPECT_LE(oracle::distance({corner, corner, corner}, scene.organ.triangle(contact.face)),
                  1e-7);
        EXPECT_TRUE(std::any_of(volumes.begin(), volumes.end(), [&](const ViewingVolume& volume) {
          for (std::size_t plane = 0; plane < volume.half_space_count(); ++plane) {
            const HalfSpace space = volume.half_space(plane);
            if (space.normal.dot(corner - volume.origin()) > space.offset + 2e-6) return false;
          }
          return true;
        }));
      }
    }
  }
  EXPECT_GT(all, 300U);
  EXPECT_GT(filled, all * 9 / 10);
}

double perimeter(const Region& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sum += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  }
  return sum;
}

double area(const Region& polygon) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i + 1 < polygon.size(); ++i) {
    sum += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  return 0.5 * sum.norm();
}

/// Expects that `region` is the part of `face` in `volume`, in 32 bits: it is in the face, in the
/// volume grown by the rounding, and as large as the part.
void expect_part(const Region& region, const Triangle& face, const ViewingVolume& volume) {
  constexpr double kRounding = 2e-6;  // [m]
  for (const Vector3d& corner : region) {
    EXPECT_LE(oracle::distance({corner, corner, corner}, face), 1e-7);
    for (std::size_t i = 0; i < volume.half_space_count(); ++i) {
      const HalfSpace space = volume.half_space(i);
      EXPECT_LE(space.normal.dot(corner - volume.origin()) - space.offset, kRounding);
    }
  }
  // Corners in another order than along the border would give another area.
  const Region exact = region_of(face, volume);
  EXPECT_NEAR(area(region), area(exact), kRounding * (perimeter(exact) + kRounding));
}

// Each of the paper's modes picks in its own volume. It looks at the shaft alone. A region is the
// part of the face in that volume.
TEST_P(CollisionQueryWith, PaperModesPickInThePapersVolumes) {
  Random random(10);
  const TriangleMesh organs[] = {mesh(liver()), mesh(scattered_faces(500, random))};
  const auto picker = make_picker(GetParam());
  std::size_t found = 0;
  const std::vector<Link> links = random_links(true, random);
  for (std::size_t i = 0; i < 40; ++i) {
    const TriangleMesh& organ = organs[i % 2];
    CollisionRequest request = swept(organ, random_link_path(links.size(), 0.1, random), 5e-3);
    request.links = &links;
    request.regions = i % 4 < 2;
    ShaftMotion motion{request.path.front().axis, request.path.front().axis};
    motion.end.tip = random.point(0.1);
    request.path.back().axis = motion.end;
    const std::pair<QueryMode, ViewingVolume> volumes[] = {
        {QueryMode::kPaperStatic, paper_static_volume(motion.end, 5e-3)},
        {QueryMode::kPaperSwept, paper_swept_volume(motion, 5e-3)},
        {QueryMode::kPaperNaive, paper_naive_volume(motion, 5e-3)}};
    for (const auto& [mode, volume] : volumes) {
      request.mode = mode;
      std::vector<Candidate> expected;
      picker->pick(volume, organ, expected);
      contacts(request);
      ASSERT_EQ(result_.contacts.size(), expected.size());
      ASSERT_EQ(result_.regions.size(), request.regions ? expected.size() : 0U);
      for (std::size_t k = 0; k < result_.regions.size(); ++k) {
        expect_part(result_.regions[k], organ.triangle(expected[k].face), volume);
      }
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_EQ(result_.contacts[k].face, expected[k].face);
        EXPECT_EQ(result_.view_ranges.at(k).min, expected[k].view_min);
        EXPECT_EQ(result_.view_ranges[k].max, expected[k].view_max);
      }
      found += expected.size();
    }
    picker->release();
  }
  EXPECT_GT(found, 500U);
}

// Face 0 has a corner in the tool's volume. Face 1 crosses it with its corners outside. Face 2
// passes beside one of its edges. Outcodes reject face 3.
TEST_P(CollisionQueryWith, CountsTheFacesThatItLooksAt) {
  const TriangleMesh organ({0,    0,     0.1F, 1,     0,    0.1F, 1,    1,    0.1F,  //
                            -1,   -0.5F, 0.1F, 1,     -0.5, 0.1F, 0,    1,    0.1F,  //
                            0.05, -0.02, 0.1F, -0.02, 0.05, 0.1F, 0.06, 0.05, 0.1F,  //
                            1,    1,     1,    2,     1,    1,    1,    2,    1},
                           {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  CollisionRequest request = swept(organ, resting_path({{{0, 0, 0}, {0, 0, 0.2}}, {}}), 0.01);
  const bool draws = GetParam() != PickerKind::kCpu;
  for (int round = 0; round < 2; ++round) {  // Earlier queries do not count.
    request.mode = QueryMode::kStatic;
    EXPECT_EQ(contacts(request).size(), 2U);
    EXPECT_EQ(result_.picked.drawn, draws ? 2U : 0U);
    EXPECT_EQ(result_.picked.undrawn, draws ? 1U : 3U);
    request.mode = QueryMode::kPaperStatic;
    EXPECT_EQ(contacts(request).size(), 2U);
    EXPECT_EQ(result_.picked.drawn, !draws ? 0U : GetParam() == PickerKind::kSelect ? 4U : 3U);
    EXPECT_EQ(result_.picked.undrawn, draws ? 0U : 3U);
  }
}

INSTANTIATE_TEST_SUITE_P(Pickers, CollisionQueryWith, testing::ValuesIn(picker_kinds()));

/// A request that is legal, what spoils it, and a word of the refusal.
class Refusals : public testing::Test {
 protected:
  using Spoil = std::function<void(CollisionRequest&)>;

  void expect_refused(const CollisionRequest& good, const std::string& word, const Spoil& spoil) {
    query_.evaluate(good, result_);
    CollisionRequest request = good;
    spoil(request);
    const auto evaluate = [&] { query_.evaluate(request, result_); };
    const std::string refusal = refusal_by<std::invalid_argument>(evaluate);
    EXPECT_NE(refusal, "accepted") << word;
    expect_words(refusal, {word});
    EXPECT_TRUE(result_.contacts.empty());
    EXPECT_TRUE(result_.placement.crossings.empty());
  }

  using Request = CollisionRequest;
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Random random_{8};
  const TriangleMesh organ_ = mesh(liver()), other_ = mesh(scattered_faces(4, random_));
  CollisionQuery query_{PickerKind::kCpu};
  CollisionResult result_;
};

TEST_F(Refusals, NameWhatIsWrongWithAShaft) {
  const ShaftAxis axis = random_axis(random_);
  const CollisionRequest good = swept(organ_, {{0.0, axis}, {1.0, axis}}, 5e-3);
  const std::pair<const char*, Spoil> rows[] = {
      {"organ", [](Request& r) { r.organ = nullptr; }},
      {"radius is 0", [](Request& r) { r.radius = 0.0; }},
      {"radius is -0.001", [](Request& r) { r.radius = -1e-3; }},
      {"radius is nan", [](Request& r) { r.radius = kNan; }},
      {"radius is inf", [](Request& r) { r.radius = INFINITY; }},
      {"path", [](Request& r) { r.path.clear(); }},
      {"tip of waypoint 1", [](Request& r) { r.path[1].axis.tip.y() = kNan; }},
      {"trocar of waypoint 0", [](Request& r) { r.path[0].axis.trocar.x() = INFINITY; }},
      {"fraction 0", [](Request& r) { r.path[1].fraction = 0.0; }},
      {"to 0.5", [](Request& r) { r.path[1].fraction = 0.5; }},
      {"from fraction 0.1", [](Request& r) { r.path[0].fraction = 0.1; }},
      {"mode is 7", [](Request& r) { r.mode = static_cast<QueryMode>(7); }},
      {"earlier shape", [this](Request& r) { r.organ_before = &other_; }},
      {"from which velocities count",
       [this](Request& r) {
         r.velocity_from = &other_;
         r.velocity_sec = 0.1;
       }},
      {"velocity_sec is 0", [this](Request& r) { r.velocity_from = &organ_; }},
      {"pose_before_sec is nan",
       [&](Request& r) {
         r.pose_before = ToolPose{axis};
         r.pose_before_sec = kNan;
       }},
      {"tip of pose_before",
       [&](Request& r) {
         r.pose_before = ToolPose{{axis.trocar, {0.0, kNan, 0.0}}};
         r.pose_before_sec = 0.1;
       }},
      {"margin is -0.1", [](Request& r) { r.margin = -0.1; }},
      {"margin is nan", [](Request& r) { r.margin = kNan; }},
      {"max_near is 3", [](Request& r) { r.max_near = 3; }},
      {"no clearance",
       [](Request& r) {
         r.mode = QueryMode::kPaperStatic;
         r.clearance = true;
       }},
      {"",
       [](Request& r) {
         r.mode = QueryMode::kPaperStatic;
         r.path[1].axis.tip = r.path[1].axis.trocar;
       }},
      {"1e-20",
       [](Request& r) {
         r.mode = QueryMode::kPaperNaive;
         r.radius = 1e-20;
       }},
      {"trocar moves by",
       [](Request& r) {
         r.mode = QueryMode::kPaperSwept;
         r.path[0].axis.trocar.x() += 0.01;
       }},
  };
  for (const auto& [word, spoil] : rows) expect_refused(good, word, spoil);
}

TEST_F(Refusals, NameWhatIsWrongWithALink) {
  const std::vector<Link> links = {{"left_jaw", {random_part(false, random_)}}}, none;
  CollisionRequest good = swept(organ_, random_link_path(1, 0.1, random_), 0.0);
  good.links = &links;
  const auto pose = [](Request& r) -> Isometry3d& { return r.path.back().links[0]; };
  const std::pair<const char*, Spoil> rows[] = {
      {"poses of 0 links", [](Request& r) { r.path.back().links.clear(); }},
      {"the tool has 1",
       [](Request& r) { r.path.front().links.resize(2, Isometry3d::Identity()); }},
      {"left_jaw", [&](Request& r) { pose(r).translation().y() = kNan; }},
      {"left_jaw", [&](Request& r) { pose(r).translation().x() = 2.0 * tolerance::kFarthest; }},
      {"must be a rotation", [&](Request& r) { pose(r).linear()(1, 2) = kNan; }},
      {"must be a rotation", [&](Request& r) { pose(r).linear() *= 1.001; }},
      {"must be a rotation", [&](Request& r) { pose(r).linear().col(0) *= -1.0; }},
      {"must be a rotation", [&](Request& r) { pose(r).linear().setZero(); }},
      {"pose_before has poses of 0 links",
       [](Request& r) {
         r.pose_before.emplace();
         r.pose_before_sec = 0.1;
       }},
      {"radius is -0.001", [](Request& r) { r.radius = -1e-3; }},
      {"radius is nan", [](Request& r) { r.radius = kNan; }},
      {"need a shaft", [](Request& r) { r.mode = QueryMode::kPaperStatic; }},
      {"need a shaft", [](Request& r) { r.mode = QueryMode::kPaperNaive; }},
      {"radius is 0",
       [&](Request& r) {
         r.links = &none;
         for (ToolWaypoint& waypoint : r.path) waypoint.links.clear();
       }},
  };
  for (const auto& [word, spoil] : rows) expect_refused(good, word, spoil);
  // A tool without a shaft has no axis, so the coordinates of the axis are not checked.
  good.path.back().axis.tip.x() = kNan;
  EXPECT_NO_THROW(query_.evaluate(good, result_));
  const std::vector<Link> without_parts = {{"left_jaw", {}}};
  good.links = &without_parts;
  EXPECT_NO_THROW(query_.evaluate(good, result_));
  EXPECT_TRUE(result_.contacts.empty());
}

TEST_F(Refusals, NameWhatIsWrongWithAPlacement) {
  const SurfaceTopology topology(organ_.faces(), organ_.vertices());
  const SurfaceTopology other({{0, 1, 2}}, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  CollisionRequest good = swept(organ_, resting_path({random_axis(random_)}), 5e-3);
  good.placement = true;
  good.surface_topology = &topology;
  good.tip = Vector3d(0.1, 0.2, 0.3);  // not used by a shaft
  const std::pair<const char*, Spoil> rows[] = {
      {"3 vertices", [&](Request& r) { r.surface_topology = &other; }},
      {"tip is (nan", [](Request& r) { r.tip->x() = NAN; }},
      {"inf, 0.3)", [](Request& r) { r.tip->y() = INFINITY; }},
      {"-1.1e+06", [](Request& r) { r.tip->z() = -1.1 * tolerance::kFarthest; }},
      {"paper", [](Request& r) { r.mode = QueryMode::kPaperStatic; }},
  };
  for (const auto& [word, spoil] : rows) expect_refused(good, word, spoil);
}

}  // namespace
}  // namespace organ_collision
