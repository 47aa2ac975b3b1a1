#include "organ_collision/query/haptic_proxy.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "mobility.hpp"
#include "proxy_entry.hpp"
#include "proxy_motion.hpp"
#include "tissue.hpp"

namespace organ_collision {
namespace {

/// [m] A proxy that is nearer to the hand is where the hand is: this is rounding.
constexpr double kSamePlace = 1e-12;

/// Whether the organ moved from its last shape to this one.
bool is_same_organ(const TriangleMesh& before, const TriangleMesh& now) {
  return before.topology() == now.topology() && before.same_faces(now);
}

void check(bool is_legal, const std::string& what) {
  if (!is_legal) throw std::invalid_argument(what);
}

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void check_tool(const ProxyTool& tool) {
  check(
      std::isfinite(tool.radius) && tool.radius >= 0.0,
      "the radius of the proxy's tool is " + shown(tool.radius) + " m; it must be >= 0 and finite");
  check(tool.radius > 0.0 || !tool.links.empty(),
        "the proxy's tool has neither a shaft nor links; give it a radius > 0 or links");
  check(tool.radius > 0.0 || tool.freedom == ProxyFreedom::kFree,
        "the proxy's tool has no shaft (its radius is 0), so it cannot go through a trocar; let it "
        "be free");
}

void check_settings(const ProxyTool& tool, const ProxySettings& settings) {
  check(std::isfinite(settings.clearance) && settings.clearance > 0.0,
        "the clearance is " + shown(settings.clearance) + " m; it must be > 0 and finite");
  check(settings.jump > 0.0, "the jump is " + shown(settings.jump) + " m; it must be > 0");
  check(!settings.puncture || *settings.puncture > 0.0,
        "the puncture is " + shown(settings.puncture.value_or(0.0)) + " m; it must be > 0");
  check(!settings.puncture || tool.freedom == ProxyFreedom::kTrocar,
        "a puncture is set for a free tool; only a shaft through a trocar can pierce tissue");
  check(std::isfinite(settings.friction) && settings.friction >= 0.0,
        "the friction is " + shown(settings.friction) + " m; it must be >= 0 and finite");
}

void check_hand(const ProxyTool& tool, const ToolPose& hand) {
  const bool is_finite =
      hand.axis.trocar.allFinite() && hand.axis.tip.allFinite() &&
      std::all_of(hand.links.begin(), hand.links.end(),
                  [](const Eigen::Isometry3d& link) { return link.matrix().allFinite(); });
  check(is_finite, "the hand's pose has a value that is not finite");
  check(hand.links.size() == tool.links.size(),
        "the hand's pose has " + std::to_string(hand.links.size()) + " links; the tool has " +
            std::to_string(tool.links.size()));
}

void check_organs(const std::vector<ProxyOrgan>& organs) {
  for (const ProxyOrgan& organ : organs) {
    check(organ.shape != nullptr, "organ '" + organ.name + "' has no shape");
    check(organ.T_organ_proxy.matrix().allFinite(),
          "the frame of organ '" + organ.name + "' has a pose that is not finite");
    check(std::count_if(organs.begin(), organs.end(),
                        [&](const ProxyOrgan& other) { return other.name == organ.name; }) == 1,
          "two organs have the name '" + organ.name + "'");
  }
}

}  // namespace

struct HapticProxy::State {
  State(ProxyTool its_tool, const ProxySettings& its_settings, PickerKind picker)
      : tool(std::move(its_tool)),
        mobility(make_mobility(tool)),
        tissue(tool, picker),
        motion(*mobility, tissue) {
    set_settings(its_settings);
  }

  void set_settings(const ProxySettings& its_settings);
  void follow(const ToolPose& hand, const std::vector<ProxyOrgan>& organs);
  std::vector<OrganTick> match(const std::vector<ProxyOrgan>& organs) const;
  bool has_new_organ(const std::vector<OrganTick>& ticks) const;
  double way_of(const ToolPose& hand) const;
  void describe(const ProxyPlace& now, const ToolPose& hand);

  ProxyTool tool;
  ProxySettings settings;
  std::unique_ptr<Mobility> mobility;
  Tissue tissue;
  ProxyMotion motion;
  LeastConstraint solver;

  // As the last tick left them.
  std::optional<ProxyPlace> place;
  ToolPose last_hand;
  double last_way = 0.0;  ///< [m] of the proxy
  std::vector<ProxyOrgan> last_organs;
  ProxyAnswer answer;
};

HapticProxy::HapticProxy(ProxyTool tool, const ProxySettings& settings, PickerKind picker) {
  check_tool(tool);
  check_settings(tool, settings);
  state_ = std::make_unique<State>(std::move(tool), settings, picker);
}
HapticProxy::~HapticProxy() = default;
HapticProxy::HapticProxy(HapticProxy&&) noexcept = default;
HapticProxy& HapticProxy::operator=(HapticProxy&&) noexcept = default;

const ProxyAnswer& HapticProxy::follow(const ToolPose& hand,
                                       const std::vector<ProxyOrgan>& organs) {
  check_hand(state_->tool, hand);
  check_organs(organs);
  state_->follow(hand, organs);
  return state_->answer;
}

void HapticProxy::reset() {
  state_->place.reset();
  state_->answer = {};
}

void HapticProxy::set_settings(const ProxySettings& settings) {
  check_settings(state_->tool, settings);
  state_->set_settings(settings);
}

void HapticProxy::State::set_settings(const ProxySettings& its_settings) {
  settings = its_settings;
  motion.set_clearance(settings.clearance);
}

/// One tick: the proxy gives way to the tissue that moved, and then follows the hand.
void HapticProxy::State::follow(const ToolPose& hand, const std::vector<ProxyOrgan>& organs) {
  const std::vector<OrganTick> ticks = match(organs);
  tissue.set_organs(ticks);
  mobility->measure(hand);
  std::string why_anew;
  std::optional<ProxyPlace> now;
  double hand_way = 0.0;
  if (!place) {
    why_anew = "there was no proxy";
  } else if (hand_way = way_of(hand); hand_way > settings.jump) {
    why_anew = "the hand jumped " + shown(hand_way) + " m";
  } else {
    ProxyPlace start = *place;
    if (has_new_organ(ticks)) start.clearance = ProxyPlace().clearance;
    now = motion.give_way(start, hand, ticks);
    if (!now) why_anew = "tissue moved through the proxy";
  }
  const bool is_placed_anew = !now;
  if (!now) {
    const ProxyEntry entry = enter(tool, *mobility, hand, settings.clearance, ticks, tissue);
    now = entry.place;
    if (!now) why_anew += ", and " + entry.why_not;
  }
  double way = 0.0;
  if (now) {
    const ToolPose start = now->pose;
    const bool is_clear = now->clearance >= settings.clearance;
    const double reach = 2.0 * std::max(hand_way, last_way);
    if (!is_clear || !motion.fly(*now, hand)) motion.slide(*now, hand, reach);
    way = mobility->longest_way(hand, mobility->between(start, now->pose));
  }
  answer = {};
  answer.is_placed_anew = is_placed_anew;
  answer.message = why_anew;
  answer.proxy = hand;
  answer.center = mobility->center(hand);
  answer.size = mobility->size();
  if (now) describe(*now, hand);
  place = std::move(now);
  last_way = is_placed_anew ? 0.0 : way;
  last_hand = hand;
  last_organs = organs;
}

/// How each organ moved since the last tick.
std::vector<OrganTick> HapticProxy::State::match(const std::vector<ProxyOrgan>& organs) const {
  std::vector<OrganTick> ticks;
  for (const ProxyOrgan& organ : organs) {
    OrganTick tick;
    tick.now = organ.shape.get();
    tick.topology = organ.topology;
    tick.T_now = tick.T_before = organ.T_organ_proxy;
    for (const ProxyOrgan& last : last_organs) {
      if (last.name != organ.name || !is_same_organ(*last.shape, *organ.shape)) continue;
      tick.before = last.shape.get();
      tick.T_before = last.T_organ_proxy;
    }
    ticks.push_back(tick);
  }
  return ticks;
}

bool HapticProxy::State::has_new_organ(const std::vector<OrganTick>& ticks) const {
  return std::any_of(ticks.begin(), ticks.end(),
                     [](const OrganTick& organ) { return !organ.before; });
}

/// [m] How far the hand moved since the last tick.
double HapticProxy::State::way_of(const ToolPose& hand) const {
  const double free_way = mobility->longest_way(hand, mobility->between(last_hand, hand));
  if (tool.freedom == ProxyFreedom::kFree) return free_way;
  return std::max(free_way, (hand.axis.trocar - last_hand.axis.trocar).norm());
}

/// Says in the answer where the proxy is, what holds it, and how it pulls the hand.
void HapticProxy::State::describe(const ProxyPlace& now, const ToolPose& hand) {
  Displacement back = mobility->between(now.pose, hand);
  if (back.norm() < kSamePlace) back.setZero();
  answer.proxy = back.isZero(0.0) ? hand : now.pose;
  answer.pull = -back.head<3>();
  answer.twist = -answer.size * back.tail<3>();
  const double clearance = settings.clearance;
  std::vector<Wall> holding;
  double nearest = now.clearance;
  for (std::size_t i = 0; i < motion.contacts().size(); ++i) {
    const TissueContact& near = motion.contacts()[i];
    nearest = std::min(nearest, near.distance);
    if (near.distance >= 2.0 * clearance) continue;
    ProxyContact contact{near.organ, near.contact, 0.0};
    contact.contact.fraction = 0.0;
    contact.contact.depth = -near.distance;
    answer.contacts.push_back(contact);
    // Only walls that the proxy has reached bear a load. A row of zeros bears none.
    const bool holds = near.distance <= 1.02 * clearance;
    holding.push_back({holds ? motion.walls()[i].row : Displacement(Displacement::Zero()), 0.0});
  }
  solver.solve(back, holding);
  for (std::size_t i = 0; i < holding.size(); ++i) answer.contacts[i].load = solver.load(i);
  if (nearest < ProxyClearance{clearance}.least()) {
    answer.state = ProxyState::kSqueezed;
  } else {
    answer.state = back.isZero(0.0) ? ProxyState::kFree : ProxyState::kTouching;
  }
}

}  // namespace organ_collision
