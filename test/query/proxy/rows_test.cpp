// haptic_proxy.hpp: the rows for a controller, and what the proxy makes of tissue that moves on
// (ProxyOrgan::advance, approach). The true distances are found face by face.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "geometry/distance/closest_points.hpp"
#include "proxy_scenes.hpp"
#include "query/proxy/least_constraint.hpp"
#include "test/proof/exact_distance.hpp"

namespace organ_collision {
namespace {

using Eigen::Vector3d;
using oracle::Random;

constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// [m] From the surface of a ball to the nearest face of a shape in the proxy's frame.
double distance_of_ball(const Vector3d& center, const TriangleMesh& shape) {
  const ConvexCore ball{ShaftAxis{center, center}};
  double nearest = kNowhere;
  for (std::size_t face = 0; face < shape.face_count(); ++face) {
    nearest = std::min(nearest, oracle::rounded_distance(ball, shape.triangle(face)));
  }
  return nearest - kToolRadius;
}

/// [m] The distance of the nearest row of an organ. Each row must lead from the ball to its point.
double nearest_row(const std::vector<ProxyFace>& rows, std::size_t organ, const Vector3d& center) {
  double nearest = kNowhere;
  for (const ProxyFace& row : rows) {
    const Vector3d point = center + (kToolRadius - row.contact.depth) * row.contact.normal;
    EXPECT_LT((point - row.contact.point).norm(), 1e-8);
    if (row.organ == organ) nearest = std::min(nearest, -row.contact.depth);
  }
  return nearest;
}

/// Checks that a face is listed once, that the nearest rows come first, and that the nearest row of
/// each organ is the least distance, wherever this is less than `reach`.
void expect_rows(const std::vector<ProxyFace>& rows, const std::vector<ProxyOrgan>& organs,
                 const Vector3d& center, double reach) {
  for (std::size_t i = 0; i < organs.size(); ++i) {
    const double away = distance_of_ball(center, *organs[i].shape);
    if (away < reach - 1e-8) {
      EXPECT_NEAR(nearest_row(rows, i, center), away, 1e-8) << "organ " << i;
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(rows[i].organ == rows[k].organ && rows[i].contact.face == rows[k].contact.face);
      EXPECT_LE(rows[i].contact.depth, rows[k].contact.depth);
    }
  }
}

TEST(ProxyRows, TellTheLeastDistanceInEachStateAtAnySpeed) {
  Random random(71);
  std::size_t seen[5] = {}, of_hand = 0, passed_a_wall = 0;
  for (int trial = 0; trial < 24; ++trial) {
    ProxySettings settings;
    settings.row_reach = random.scale(1e-3, 0.03);
    settings.hand_rows = true;
    HapticProxy proxy(ball_tool(), settings);
    std::vector<ProxyOrgan> organs = {
        organ_of(height_field(10, [](double x, double y) { return 4.0 * (x * x + y * y); }),
                 "bowl"),
        organ_of(flat_sheet(5, 0.03), "lid")};
    for (ProxyOrgan& organ : organs) organ.clearances = {random.scale(1e-4, 5e-3)};
    const double way = random.scale(1e-5, 8e-3), closed = random.uniform(2e-3, 0.015);
    Vector3d center(0.0, 0.0, 0.015);
    for (int tick = 0; tick < 60; ++tick) {
      // The lid comes down to the ball and goes up again.
      const auto shape = std::make_shared<TriangleMesh>(*organs[1].shape);
      const double height = std::max(closed, std::abs(1e-3 * (tick - 30)));
      shape->move_vertices(flat_sheet(5, height).vertices);
      organs[1].shape = shape;
      center += random.point(way);
      center.z() = std::clamp(center.z(), tick % 12 == 11 ? -0.005 : 0.004, 0.04);
      const ProxyAnswer& answer = proxy.follow(ball_hand(center), organs);
      SCOPED_TRACE(testing::Message() << trial << ", tick " << tick << ", way " << way);
      ++seen[static_cast<int>(answer.state)];
      const Vector3d held = answer.proxy.axis.tip;
      expect_rows(answer.contacts, organs, held, settings.row_reach);
      double on_the_way = kNowhere;
      for (int step = 0; step <= 25; ++step) {
        const Vector3d on_it = held + step / 25.0 * (center - held);
        for (const ProxyOrgan& organ : organs) {
          if (answer.state == ProxyStatus::kFree && step > 0) continue;
          on_the_way = std::min(on_the_way, distance_of_ball(on_it, *organ.shape));
        }
      }
      if (on_the_way > 1e-6) {
        expect_rows(answer.hand_contacts, organs, center, settings.row_reach);
        ++of_hand;
      } else if (on_the_way < -1e-4) {
        EXPECT_TRUE(answer.hand_contacts.empty()) << "a wall lies between";
        ++passed_a_wall;
      }
      for (const ProxyFace& row : answer.hand_contacts) EXPECT_EQ(row.load, 0.0);
    }
  }
  for (const ProxyStatus state :
       {ProxyStatus::kFree, ProxyStatus::kTouching, ProxyStatus::kSqueezed}) {
    EXPECT_GT(seen[static_cast<int>(state)], 50u) << static_cast<int>(state);
  }
  EXPECT_GT(of_hand, 300u);
  EXPECT_GT(passed_a_wall, 50u);
}

/// [m/s] The velocity nearest to `wanted` that all rows allow. `velocity`: of the tissue of a row.
template <typename Velocity>
Vector3d allowed(const std::vector<ProxyFace>& rows, const Vector3d& wanted, double gain,
                 const Velocity& velocity) {
  std::vector<Wall> walls;
  for (const ProxyFace& row : rows) {
    Wall& wall = walls.emplace_back();
    wall.row.head<3>() = row.contact.normal;
    wall.bound =
        row.contact.normal.dot(velocity(row)) + gain * (-row.contact.depth - row.clearance);
  }
  Displacement goal = Displacement::Zero();
  goal.head<3>() = wanted;
  LeastConstraint solver;
  solver.solve(goal, walls);
  return solver.displacement().head<3>();
}

/// Follows a ball that obeys the rows of organs and wants to go elsewhere. `organs_at` tells the
/// organs at a time, with ProxyOrgan::approach. Returns the least of each organ's distance minus
/// its clearance; `last`: at the end. `visit` gets each place and velocity.
template <typename Organs, typename Velocity, typename Visit>
double least_spare(const Organs& organs_at, const Velocity& velocity, Vector3d center,
                   const Vector3d& wanted, double gain, double dt, int ticks, double& last,
                   const Visit& visit) {
  ProxySettings settings;
  settings.row_reach = 0.02;
  settings.hand_rows = true;
  HapticProxy proxy(ball_tool(), settings);
  double least = kNowhere;
  for (int tick = 0; tick <= ticks; ++tick) {
    const std::vector<ProxyOrgan> organs = organs_at(tick * dt);
    last = kNowhere;
    for (const ProxyOrgan& organ : organs) {
      last = std::min(last, distance_of_ball(center, *organ.shape) - organ.clearances[0]);
    }
    least = std::min(least, last);
    const ProxyAnswer& answer = proxy.follow(ball_hand(center), organs);
    const auto& rows = answer.hand_contacts.empty() ? answer.contacts : answer.hand_contacts;
    const Vector3d velocity_then = allowed(rows, wanted, gain, velocity);
    visit(center, velocity_then);
    center += dt * velocity_then;
  }
  return least;
}

/// A square of tissue whose heights follow a script.
class ScriptedTissue {
 public:
  using Script = std::function<double(double x, double y, double time)>;

  /// `half` [m]: half of its width, with 2 * side * side faces.
  ScriptedTissue(int side, double half, Script script)
      : side_(side), half_(half), script_(std::move(script)), organ_(organ_of(surface(0.0))) {}

  std::shared_ptr<TriangleMesh> shape(double time) const {
    auto shape = std::make_shared<TriangleMesh>(*organ_.shape);
    shape->move_vertices(surface(time).vertices);
    return shape;
  }
  ProxyOrgan organ(const std::shared_ptr<const TriangleMesh>& shape) const {
    ProxyOrgan organ = organ_;
    organ.shape = shape;
    return organ;
  }

 private:
  GridSurface surface(double time) const {
    GridSurface surface = grid_surface(side_);
    for (std::size_t i = 0; i < surface.vertices.size(); i += 3) {
      float* const at = &surface.vertices[i];
      for (int k = 0; k < 2; ++k) at[k] *= static_cast<float>(half_ / 0.1);
      at[2] = static_cast<float>(script_(at[0], at[1], time));
    }
    return surface;
  }

  int side_;
  double half_;
  Script script_;
  ProxyOrgan organ_;
};

/// [m/s] The velocity of a point of a face between two shapes.
Vector3d velocity_at(const FaceContact& at, const TriangleMesh& before, const TriangleMesh& now,
                     double seconds) {
  return (point_at(now.triangle(at.face), at.barycentric) -
          point_at(before.triangle(at.face), at.barycentric)) /
         seconds;
}

/// Scripts of tissue that rises by `speed` [m/s], or up to that, beside the origin.
std::vector<std::pair<std::string, ScriptedTissue::Script>> rising(double speed, Random& random) {
  const double radius = random.uniform(1e-3, 2e-3), beside = random.uniform(2e-3, 2.5e-3);
  const double angle = random.uniform(0.0, 2.0 * M_PI), length = random.uniform(0.02, 0.04);
  const double c = std::cos(angle), s = std::sin(angle);
  return {{"piston",
           [=](double x, double y, double time) {
             const double r = std::hypot(x - (radius + beside) * c, y - (radius + beside) * s);
             return r < radius ? speed * time : 0.0;
           }},
          {"ramp",
           [=](double x, double y, double time) {
             return std::max(0.0, c * x + s * y - beside) * speed * time / 5e-3;
           }},
          {"wave", [=](double x, double y, double time) {
             const double amplitude = 0.05 * length;
             return amplitude *
                    std::sin((c * x + s * y) / length * 2.0 * M_PI + speed / amplitude * time);
           }}};
}

// A row that is not listed allows each velocity that the listed ones allow, at any gain from 10 / s
// on. Without ProxyOrgan::approach, it would allow up to 28 mm/s less.
TEST(ProxyRows, StandForNoTissueThatComesFaster) {
  Random random(83);
  for (int trial = 0; trial < 6; ++trial) {
    const double speed = random.uniform(0.03, 0.1), dt = random.scale(2e-3, 1e-2);
    const double gain = random.scale(10.0, 0.8 / dt), clearance = random.scale(1e-4, 5e-3);
    for (const auto& [name, script] : rising(speed, random)) {
      SCOPED_TRACE(testing::Message()
                   << name << ", trial " << trial << ", speed " << speed << ", dt " << dt
                   << ", gain " << gain << ", clearance " << clearance);
      const ScriptedTissue tissue(16, 0.012, script);
      std::shared_ptr<TriangleMesh> before, now;
      const auto velocity = [&](const FaceContact& at) {
        return velocity_at(at, *before, *now, dt);
      };
      double broken = 0.0;  // [m/s] by how much the row of any face
      const auto organs_at = [&](double time) {
        before = tissue.shape(time - dt);
        now = tissue.shape(time);
        ProxyOrgan organ = tissue.organ(now);
        organ.clearances = {clearance};
        organ.approach = [&](const FaceContact& at) { return -at.normal.dot(velocity(at)); };
        organ.most_approach = 1.0;
        return std::vector<ProxyOrgan>{organ};
      };
      const auto visit = [&](const Vector3d& center, const Vector3d& allowed) {
        FaceContact at;
        for (at.face = 0; at.face < now->face_count(); ++at.face) {
          const ClosestPoints closest =
              axis_closest_points({center, center}, now->triangle(at.face));
          at.barycentric = closest.barycentric;
          const double spare = closest.distance - kToolRadius - clearance;
          const double room = gain * (spare + 0.06 * std::abs(spare) + 0.01 * clearance);
          const double comes = closest.separation.normalized().dot(allowed - velocity(at));
          broken = std::max(broken, comes - room);
        }
      };
      double last = 0.0;
      const double least = least_spare(
          organs_at, [&](const ProxyFace& row) { return velocity(row.contact); },
          {0.0, 0.0, kToolRadius + 1.05 * clearance + 5e-5}, Vector3d::Zero(), gain, dt,
          static_cast<int>(0.15 / dt), last, visit);
      EXPECT_LT(broken, 0.1 * speed);
      // Of a wave, the speed and the place that is the nearest change from step to step.
      const double bend = name == "wave" ? 4e3 * std::pow(speed * dt, 2.0) / (gain * dt) : 0.0;
      EXPECT_GT(least, -0.01 * clearance - 0.05 * speed * dt - bend);
    }
  }
}

TEST(ProxyLag, IsGuardedWhereverTissueRises) {
  Random random(73);
  constexpr double kPeriod = 1.0 / 60.0;
  for (const double clearance : {1e-4, 2e-3, 5e-3}) {
    for (int trial = 0; trial < 4; ++trial) {
      const double speed = random.uniform(0.03, 0.05);
      const int side = random.integer(8, 24);
      for (const auto& [name, script] : rising(speed, random)) {
        SCOPED_TRACE(testing::Message() << name << ' ' << clearance << ", trial " << trial
                                        << ", side " << side << ", speed " << speed);
        const ScriptedTissue tissue(side, 0.012, script);
        ProxySettings settings;
        settings.clearance = clearance;
        HapticProxy proxy(ball_tool(), settings);
        const double lead = random.uniform(0.0, 1.0) * kPeriod;  // The shapes come so late.
        const ToolPose hand = ball_hand({random.uniform(-5e-4, 5e-4), random.uniform(-5e-4, 5e-4),
                                         kToolRadius + clearance + random.uniform(0.0, 5e-4)});
        double least = kNowhere;
        for (int shape = 1; shape < 10; ++shape) {
          const double stamp = shape * kPeriod;
          const auto before = tissue.shape(stamp - kPeriod), now = tissue.shape(stamp);
          for (int tick = 0; tick < 4; ++tick) {
            const double lag = lead + 0.25 * tick * kPeriod;
            ProxyOrgan organ = tissue.organ(now);
            organ.advance = [&](const FaceContact& at) {
              return -lag * at.normal.dot(velocity_at(at, *before, *now, kPeriod));
            };
            organ.most_advance = 0.02;
            const ProxyAnswer& answer = proxy.follow(hand, {organ});
            const auto truth = tissue.shape(stamp + lag);
            double sped_up = 0.0;
            for (std::size_t i = 2; i < now->vertices().size(); i += 3) {
              const double from = before->vertices()[i], to = now->vertices()[i];
              sped_up = std::max(sped_up, truth->vertices()[i] - to - (to - from) * lag / kPeriod);
            }
            const double away = distance_of_ball(answer.proxy.axis.tip, *truth);
            least = std::min(least, away - clearance + sped_up);
          }
        }
        EXPECT_GT(least, -0.01 * clearance - 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace organ_collision
