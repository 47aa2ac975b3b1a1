// A model of tools that obey the guard: 10 000 random approaches to moving tissue. A tool that
// obeys never touches, unless the tissue alone comes faster than the tool may retreat.
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <deque>
#include <random>
#include <sstream>
#include <string>

#include "common/messages/conversions.hpp"
#include "guard/tool_guard.hpp"
#include "organ_collision/query/collision_query.hpp"

namespace organ_collision {
namespace {

constexpr double kStep = 0.0005;         ///< [s] of the model
constexpr double kLongestWait = 0.0225;  ///< [s] between two states without answers

enum class Fault { kNone, kNodeEnds, kGuardEnds };

/// How an approach ended.
struct Outcome {
  bool tool_touched = false;    ///< while it moved towards the tissue
  bool tissue_touched = false;  ///< while the tool stood or went back
  double least = kUnlimited;    ///< [m]
};

/// One tool that moves towards tissue along a line. The tissue's speed is drawn once. Wishes of the
/// operator change, and so do the delays of the messages, whose order is kept.
class Approach {
 public:
  explicit Approach(unsigned seed) : random_(seed) {
    p_.deceleration = uniform(0.5, 10.0);
    p_.latency = uniform(0.12, 0.4);
    p_.watch_time = uniform(0.03, 0.1);
    p_.stop_distance = uniform(1e-4, 3e-3);
    p_.max_speed = uniform(0.05, 0.5);
    p_.hold_sec = one_of(2) ? 0.0 : uniform(0.0, 0.2);
    p_.tissue_speed = 0.5;
    const double speeds[] = {0.0, uniform(-0.5, 0.5), uniform(0.0, 0.95 * p_.retreat_speed)};
    tissue_ = speeds[one_of(3)];
    distance_ = uniform(p_.stop_distance + 0.001, 0.3);
    answer_delay_ = uniform(0.0, 0.9 * p_.longest_age());
    state_delay_ = uniform(0.0, (p_.latency - p_.watch_time) / 3.0);
    period_ = uniform(0.001, 0.016);
    shape_period_ = uniform(0.001, 0.05);
    noise_ = one_of(2) ? 0.0 : p_.stop_distance;
    fault_ = one_of(2) ? Fault::kNone : one_of(2) ? Fault::kNodeEnds : Fault::kGuardEnds;
    fault_time_ = uniform(0.0, 2.0);
    steady_push_ = one_of(4) == 0;
    OrganInfo organ;
    organ.name = "tissue";
    guard_.set_organs({organ}, 0.0);
  }

  Outcome run(double duration) {
    Outcome outcome;
    for (time_ = 0.0; time_ < duration; time_ += kStep) {
      answer();
      guard();
      move();
      outcome.least = std::min(outcome.least, distance_);
      if (distance_ > 0.0) continue;
      (speed_ > 0.0 ? outcome.tool_touched : outcome.tissue_touched) = true;
      break;
    }
    return outcome;
  }

  /// Whether the operator pushes on to tissue at rest whose distance is known.
  bool pushes_to_rest() const {
    return steady_push_ && tissue_ == 0.0 && noise_ == 0.0 && fault_ == Fault::kNone;
  }
  /// Whether tissue may touch a tool that does not go on: it comes faster than the tool may go
  /// back, or nobody tells the tool any more where back is.
  bool may_be_touched() const {
    return tissue_ > p_.retreat_speed ||
           (tissue_ > 0.0 && fault_ != Fault::kNone && is_over(fault_));
  }
  double error() const { return p_.stop_distance; }
  std::string in_words() const {
    std::ostringstream text;
    text.precision(17);
    text << "a " << p_.deceleration << " T " << p_.latency << " watch " << p_.watch_time << " e "
         << p_.stop_distance << " max " << p_.max_speed << " hold " << p_.hold_sec << " tissue "
         << tissue_ << " delays " << answer_delay_ << " " << state_delay_ << " periods " << period_
         << " " << shape_period_ << " noise " << noise_ << " fault " << static_cast<int>(fault_)
         << " at " << fault_time_ << "; at " << time_ << " speed " << speed_;
    return text.str();
  }

 private:
  template <typename Message>
  struct Delayed {
    double arrives;
    Message message;
  };

  double uniform(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random_);
  }
  unsigned one_of(unsigned count) { return static_cast<unsigned>(random_() % count); }
  /// When a message that takes `delay` arrives: not before the one that was sent before it.
  template <typename Queue>
  double arrival(const Queue& queue, double delay) const {
    return std::max(time_ + delay, queue.empty() ? 0.0 : queue.back().arrives);
  }
  bool is_over(Fault fault) const { return fault_ == fault && time_ >= fault_time_; }
  ros::Time ros_time() const { return ros::Time(100.0 + time_); }

  /// The collision node measures.
  void answer() {
    if (time_ < next_answer_ || is_over(Fault::kNodeEnds)) return;
    next_answer_ += period_;
    if (time_ >= shape_time_ + shape_period_) shape_time_ = time_;
    auto answer = boost::make_shared<ContactArray>();
    answer->header.stamp = ros_time();
    answer->mesh_stamp = ros::Time(100.0 + shape_time_);
    answer->organ = "tissue";
    answer->placement.tip = ToolPlacement::OUTSIDE;
    Clearance& clearance = answer->clearance;
    clearance.state = Clearance::KNOWN;
    clearance.margin = 10.0;
    const double since_shape = tissue_ * (time_ - shape_time_);
    clearance.distance = distance_ + since_shape + uniform(-noise_, noise_);
    clearance.normal.x = 1.0;
    clearance.normal_defined = 1;
    Contact& near = answer->near.emplace_back();
    near.depth = -clearance.distance;
    near.normal.x = 1.0;
    near.velocity.x = -tissue_;
    answers_.push_back({arrival(answers_, uniform(0.0, answer_delay_)), answer});
  }

  void guard() {
    if (is_over(Fault::kGuardEnds)) return;
    bool decides = false;
    while (!answers_.empty() && answers_.front().arrives <= time_) {
      guard_.take(answers_.front().message, {0.0, 0.0, 0.0}, {time_, ros_time()});
      answers_.pop_front();
      decides = true;
    }
    if (!decides && time_ < last_sent_ + kLongestWait) return;
    last_sent_ = time_;
    states_.push_back(
        {arrival(states_, uniform(0.0, state_delay_)), guard_.decide({time_, ros_time()})});
  }

  /// The tool obeys: it speeds up at once, and slows down with its deceleration.
  void move() {
    while (!states_.empty() && states_.front().arrives <= time_) {
      state_ = states_.front().message;
      heard_ = time_;
      states_.pop_front();
    }
    if (time_ >= next_wish_) {
      next_wish_ = time_ + uniform(0.02, 0.4);
      wish_ = steady_push_ ? 0.5 : std::max(0.0, uniform(-0.2, 0.5));
    }
    const bool is_heard = time_ - heard_ < p_.watch_time;
    double target = is_heard ? std::min(wish_, state_.speed_scale * p_.max_speed) : 0.0;
    const bool may_retreat = is_heard && state_.retreat.x < 0.0;
    if (target == 0.0 && may_retreat && tissue_ > 0.0) target = -p_.retreat_speed;
    const double before = speed_;
    speed_ = std::max(target, before - p_.deceleration * kStep);
    const double mean = before > speed_ ? 0.5 * (before + speed_) : speed_;
    distance_ -= (mean + tissue_) * kStep;
  }

  std::mt19937 random_;
  GuardParameters p_;
  ToolGuard guard_{p_, [] {
                     ToolInfo tool;
                     tool.name = "tool";
                     tool.margin = 10.0;
                     return tool;
                   }()};
  double tissue_ = 0.0, distance_ = 0.0, answer_delay_ = 0.0, state_delay_ = 0.0, period_ = 0.0,
         shape_period_ = 0.0, noise_ = 0.0;
  Fault fault_ = Fault::kNone;
  double fault_time_ = 0.0;
  bool steady_push_ = false;

  double time_ = 0.0, next_answer_ = 0.0, last_sent_ = -1.0, heard_ = -1.0, next_wish_ = 0.0,
         wish_ = 0.0, speed_ = 0.0, shape_time_ = 0.0;
  std::deque<Delayed<ContactArray::ConstPtr>> answers_;
  std::deque<Delayed<GuardState>> states_;
  GuardState state_;
};

TEST(GuardModel, AToolThatObeysDoesNotTouch) {
  double unused = 0.0;
  unsigned pushed = 0, touched_by_tissue = 0;
  for (unsigned seed = 0; seed < 10'000; ++seed) {
    Approach approach(seed);
    // In 12 s, also the slowest tool comes to the end of the longest way.
    const Outcome outcome = approach.run(approach.pushes_to_rest() ? 12.0 : 3.0);
    ASSERT_FALSE(outcome.tool_touched) << seed << ": " << approach.in_words();
    touched_by_tissue += outcome.tissue_touched;
    ASSERT_TRUE(approach.may_be_touched() || !outcome.tissue_touched)
        << seed << ": " << approach.in_words();
    if (!approach.pushes_to_rest()) continue;
    ++pushed;
    unused = std::max(unused, outcome.least - approach.error());
  }
  std::printf(
      "%u approaches pushed on for 12 s to tissue at rest; the largest unused distance is %.3g m. "
      "Fast "
      "tissue touched %u tools that stood or went back\n",
      pushed, unused, touched_by_tissue);
  EXPECT_GT(pushed, 150u);
  EXPECT_GT(touched_by_tissue, 100u);
  EXPECT_LT(unused, 2e-4);
}

/// Two walls of one organ with folds, and a ball between them that obeys the guard. A place of a
/// wall may rise as fast as `tissue_speed`.
class FineOrgan {
 public:
  FineOrgan(unsigned seed, std::uint32_t faces, std::size_t max_near, bool rises)
      : random_(seed), max_near_(max_near), rises_(rises) {
    p_.hold_sec = 0.0;
    p_.tissue_speed = rises ? uniform(0.0, 0.03) : one_of(2) ? 0.0 : 0.05;
    gap_ = 2 * kRadius + uniform(0.004, 0.03);
    fold_ = uniform(0.0, 0.002);
    wave_ = uniform(100.0, 400.0);
    rise_at_ = {uniform(-0.02, 0.02), uniform(-0.02, 0.02), 0.0};
    size_ = static_cast<std::uint32_t>(std::sqrt(faces / 4.0));
    for (std::uint32_t wall = 0; wall < 2; ++wall) {
      for (std::uint32_t row = 0; row < size_; ++row) {
        for (std::uint32_t column = 0; column < size_; ++column) {
          const std::uint32_t a = (wall * (size_ + 1) + row) * (size_ + 1) + column;
          const std::uint32_t b = a + size_ + 1;
          triangles_.insert(triangles_.end(), {a, a + 1, b, a + 1, b + 1, b});
        }
      }
    }
    shape_ = before_ = shape(0.0);
    center_ = {uniform(-0.02, 0.02), uniform(-0.02, 0.02),
               kRadius + fold_ + uniform(0.0005, 0.002)};
    OrganInfo organ;
    organ.name = "tissue";
    for (ToolGuard* guard : {&guard_, &seeing_}) guard->set_organs({organ}, 0.0);
  }

  /// Lets the ball obey. Counts the states that stop it, and their ways out.
  void run(double duration) {
    for (; time_ < duration; time_ += kTick) {
      if (rises_ && time_ >= shaped_ + 0.02) {
        before_ = std::exchange(shape_, shape(time_));
        shaped_ = time_;
      }
      const CollisionResult now = measure(*shape_, center_, max_near_);
      const Vector3d normal = now.clearance.normal;
      ASSERT_FALSE(now.clearance.distance <= 0.0 && velocity_.dot(normal) > 0.0) << in_words();
      if (now.clearance.distance <= 0.0) return;  // The tissue came.
      const GuardState state = decide(guard_, now);
      if (time_ >= next_wish_) {
        next_wish_ = time_ + uniform(0.05, 1.0);
        wish_ = 0.1 * Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      }
      const Vector3d retreat = to_eigen(state.retreat);
      if (state.stage == GuardState::STOP) look_at(retreat, now.clearance.distance);
      if (testing::Test::HasFatalFailure()) return;
      const double allowed = state.speed_scale * p_.max_speed;
      Vector3d target = wish_.normalized() * std::min(wish_.norm(), allowed);
      if (allowed == 0.0 && one_of(2) == 0) target = p_.retreat_speed * retreat;
      const Vector3d change = target - velocity_;
      const double most = target.norm() < velocity_.norm() ? p_.deceleration * kTick : 1.0;
      velocity_ += change.normalized() * std::min(change.norm(), most);
      center_ += velocity_ * kTick;
    }
  }

  unsigned stops = 0, ways_out = 0;

 private:
  using Vector3d = Eigen::Vector3d;
  static constexpr double kTick = 0.004, kRadius = 0.003, kSide = 0.06;

  double uniform(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random_);
  }
  unsigned one_of(unsigned count) { return static_cast<unsigned>(random_() % count); }

  std::shared_ptr<const TriangleMesh> shape(double time) const {
    std::vector<float> vertices;
    for (int wall = 0; wall < 2; ++wall) {
      for (std::uint32_t i = 0; i < (size_ + 1) * (size_ + 1); ++i) {
        const double x = kSide * (i % (size_ + 1)) / size_ - 0.5 * kSide;
        const double y = kSide * (i / (size_ + 1)) / size_ - 0.5 * kSide;
        const double fold = fold_ * std::sin(wave_ * (x + wall * 0.003)) * std::cos(wave_ * y);
        const bool is_raised = wall == 0 && std::hypot(x - rise_at_.x(), y - rise_at_.y()) < 0.004;
        const double rise = is_raised ? std::min(time * p_.tissue_speed, 0.4 * gap_) : 0.0;
        for (const double value : {x, y, wall * gap_ + fold + (rises_ ? rise : 0.0)}) {
          vertices.push_back(static_cast<float>(value));
        }
      }
    }
    return std::make_shared<TriangleMesh>(vertices, triangles_);
  }

  CollisionResult measure(const TriangleMesh& organ, const Vector3d& center, std::size_t most) {
    CollisionRequest request;
    request.organ = &organ;
    if (rises_ && before_ != shape_) {
      request.velocity_from = before_.get();
      request.velocity_sec = 0.02;
    }
    request.path.resize(1);
    request.path[0].axis = {center, center};
    request.radius = kRadius;
    request.margin = 0.05;
    request.max_near = most;
    CollisionResult result;
    query_.evaluate(request, result);
    return result;
  }

  static Contact message(const FaceContact& at) {
    Contact contact;
    contact.face = at.face;
    contact.link = at.link;
    contact.depth = at.depth;
    contact.normal = to_vector(at.normal);
    contact.velocity = to_vector(at.velocity);
    return contact;
  }

  GuardState decide(ToolGuard& guard, const CollisionResult& result) const {
    const GuardTime now{time_, ros::Time(100.0 + time_)};
    auto answer = boost::make_shared<ContactArray>();
    answer->header.stamp = now.ros;
    answer->organ = "tissue";
    answer->placement.tip = answer->placement.trocar = ToolPlacement::OUTSIDE;
    for (const FaceContact& at : result.contacts) answer->contacts.push_back(message(at));
    for (const FaceContact& at : result.near) answer->near.push_back(message(at));
    for (const FaceContact& at : result.around) answer->around.push_back(message(at));
    answer->near_more = result.near_more;
    answer->around_up_to = result.around_up_to;
    Clearance& clearance = answer->clearance;
    clearance.margin = 0.05;
    clearance.state = static_cast<std::uint8_t>(result.clearance.state);
    clearance.distance = result.clearance.distance;
    clearance.face = result.clearance.face;
    clearance.link = result.clearance.link;
    clearance.normal = to_vector(result.clearance.normal);
    clearance.normal_defined = result.clearance.normal_defined;
    guard.take(answer, {0.0, 0.0, 0.0}, now);
    return guard.decide(now);
  }

  /// A guard that sees all faces, and a look at where the way leads, tell whether it is right.
  void look_at(const Vector3d& retreat, double distance) {
    ++stops;
    ways_out += retreat.isZero(0.0) ? 0 : 1;
    constexpr double kWay = 0.0005;  // [m]
    if (!retreat.isZero(0.0)) {
      const double then = measure(*shape_, center_ + kWay * retreat, 0).clearance.distance;
      ASSERT_GE(then, std::min(0.79 * distance, 0.00125)) << in_words();
    } else if (triangles_.size() < 10'000 || stops % 64 == 1) {
      CollisionResult all = measure(*shape_, center_, triangles_.size());
      ASSERT_TRUE(to_eigen(decide(seeing_, all).retreat).isZero(0.0)) << in_words();
    }
  }

  std::string in_words() const {
    std::ostringstream text;
    text << "gap " << gap_ << " fold " << fold_ << " wave " << wave_ << " faces "
         << triangles_.size() / 3 << " max_near " << max_near_ << " tissue " << p_.tissue_speed
         << "; at " << time_ << " s the centre is " << center_.transpose() << ", its velocity "
         << velocity_.transpose();
    return text.str();
  }

  std::mt19937 random_;
  const std::size_t max_near_;
  const bool rises_;
  GuardParameters p_;
  static ToolInfo ball() {
    ToolInfo tool;
    tool.name = "tool";
    tool.tip_frame = "tip";
    tool.margin = 0.05;
    return tool;
  }
  ToolGuard guard_{p_, ball()}, seeing_{p_, ball()};
  CollisionQuery query_{PickerKind::kCpu};
  std::uint32_t size_ = 0;
  std::vector<std::uint32_t> triangles_;
  std::shared_ptr<const TriangleMesh> shape_, before_;
  double gap_ = 0.0, fold_ = 0.0, wave_ = 0.0, time_ = 0.0, shaped_ = 0.0, next_wish_ = 0.0;
  Vector3d rise_at_{0, 0, 0}, center_{0, 0, 0}, velocity_{0, 0, 0}, wish_{0, 0, 0};
};

TEST(GuardModel, AToolBetweenFineWallsStaysOutAndFindsTheWayOut) {
  const struct {
    std::uint32_t faces;
    unsigned organs;
  } rows[] = {{1'000, 40}, {10'000, 10}, {100'000, 4}, {1'000'000, 1}};
  for (const auto& row : rows) {
    for (const std::size_t max_near : {1, 8}) {
      unsigned stops = 0, ways_out = 0;
      for (unsigned seed = 0; seed < row.organs; ++seed) {
        FineOrgan organ(seed, row.faces, max_near, row.faces < 100'000 && seed % 2 == 1);
        ASSERT_NO_FATAL_FAILURE(organ.run(2.0)) << "seed " << seed;
        stops += organ.stops;
        ways_out += organ.ways_out;
      }
      std::printf("%u faces, max_near %zu: %u stops, %u with a way out\n", row.faces, max_near,
                  stops, ways_out);
      EXPECT_GT(ways_out, 0U);
    }
  }
}

}  // namespace
}  // namespace organ_collision
