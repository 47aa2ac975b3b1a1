#include "organ_collision/query/haptic_proxy.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "mobility.hpp"
#include "needle.hpp"
#include "proxy_motion.hpp"
#include "query/request_check.hpp"
#include "tissue.hpp"

namespace organ_collision {
namespace {

/// [m] A proxy nearer to the hand than this counts as being where the hand is.
constexpr double kSamePlace = 1e-12;
/// [1] A face can bear load if its distance from the proxy is at most this many times the larger of
/// two lengths: the clearance, and the distance of the nearest face.
constexpr double kResting = 1.02;

/// A face near a tool, without a load.
ProxyFace face_at(const TissueContact& near) {
  ProxyFace face{near.organ, near.contact, near.clearance, 0.0};
  face.contact.fraction = 0.0;
  face.contact.depth = -near.distance;
  return face;
}

/// The nearest first.
void sort(std::vector<ProxyFace>& faces) {
  std::stable_sort(faces.begin(), faces.end(), [](const ProxyFace& a, const ProxyFace& b) {
    return a.contact.depth > b.contact.depth;
  });
}

}  // namespace

struct HapticProxy::State {
  State(ProxyTool its_tool, const ProxySettings& its_settings, const PickerSettings& picker)
      : tool(std::move(its_tool)),
        mobility(make_mobility(tool)),
        tissue(tool, picker),
        motion(*mobility, tissue) {
    set_settings(its_settings);
  }

  ProxyTool tool;
  ProxySettings settings;
  // The result of the last tick.
  std::optional<ProxyPlace> place;
  std::optional<Needle> needle;  ///< if the proxy has pierced tissue
  ProxyAnswer answer;

  void set_settings(const ProxySettings& its_settings);
  void follow(const ToolPose& hand, const std::vector<ProxyOrgan>& organs);

  /// How far a hand moved [m].
  struct HandWay {
    double jump = 0.0;     ///< as ProxySettings::jump counts it
    double longest = 0.0;  ///< no point of the tool moved farther
  };
  /// The data of a tick. The results become those of the State only if the whole tick succeeds.
  struct Tick {
    const ToolPose& hand;
    const std::vector<ProxyOrgan>& organs;
    HandWay hand_way;  ///< since the last tick
    std::vector<OrganTick> motions = {};
    ProxyAnswer answer = {};
    std::optional<ProxyPlace> place = {};
    std::optional<Needle> needle = {};
    double way = 0.0;  ///< [m] how far the proxy moved
  };
  bool move_needle(Tick& tick);
  void hold(Tick& tick, Needle&& held) const;
  void move_proxy(Tick& tick);
  std::vector<OrganTick> match(const std::vector<ProxyOrgan>& organs, bool goes_on) const;
  void set_clearances(Tick& tick);
  void choose_sides(Tick& tick);
  bool is_in_new_tissue(Tick& tick);
  HandWay way_of(const ToolPose& hand) const;
  void describe(Tick& tick);
  bool add_rows(const ToolPose& pose, std::vector<ProxyFace>& rows);
  void describe_hand(Tick& tick);

  std::unique_ptr<Mobility> mobility;
  Tissue tissue;
  ProxyMotion motion;
  LeastConstraint solver;
  std::vector<TissueContact> found;

  ToolPose last_hand;
  double last_way = 0.0;  ///< [m] how far the proxy moved in the last tick
  ProxyClearance last_clearance{0.0};
  std::vector<ProxyOrgan> last_organs;
};

HapticProxy::HapticProxy(ProxyTool tool, const ProxySettings& settings,
                         const PickerSettings& picker) {
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
  check_organs(state_->tool, organs);
  ToolPose checked = hand;
  if (state_->tool.radius == 0.0) checked.axis = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  state_->follow(checked, organs);
  return state_->answer;
}

void HapticProxy::reset() {
  state_->place.reset();
  state_->needle.reset();
  state_->answer = {};
}

void HapticProxy::set_settings(const ProxySettings& settings) {
  check_settings(state_->tool, settings);
  state_->set_settings(settings);
}

void HapticProxy::State::set_settings(const ProxySettings& its_settings) {
  settings = its_settings;
}

/// One tick. A needle in tissue moves with the tissue. Any other proxy gives way to the tissue that
/// moved, and then follows the hand.
void HapticProxy::State::follow(const ToolPose& hand, const std::vector<ProxyOrgan>& organs) {
  Tick tick{hand, organs, place ? way_of(hand) : HandWay{}};
  if (!place) {
    tick.answer.message = "this is the first tick, or the first after a reset";
  } else if (tick.hand_way.jump > settings.jump) {
    tick.answer.message = "the hand jumped " + std::to_string(tick.hand_way.jump) + " m";
  } else {
    tick.place = place;
  }
  tick.motions = match(organs, tick.place.has_value());
  set_clearances(tick);
  tissue.start_tick();
  tissue.set_organs(tick.motions);
  mobility->measure(hand);
  tick.answer.proxy = hand;
  tick.answer.center = mobility->center(hand);
  tick.answer.size = mobility->size();
  if (!move_needle(tick)) {
    move_proxy(tick);
    if (tick.place) describe(tick);
    if (settings.puncture && tick.answer.state == ProxyStatus::kTouching) {
      auto pierced = Needle::pierce(tick.answer.proxy.axis, hand.axis, tick.answer.contacts, organs,
                                    settings, tissue);
      if (pierced) hold(tick, std::move(*pierced));
    }
  }
  tick.answer.tests = tissue.tests_made();
  if (tissue.is_used_up()) {
    tick.answer.message += tick.answer.message.empty() ? "" : "; ";
    tick.answer.message += "the work of this tick is used up: contacts may be missing";
    if (tick.answer.state == ProxyStatus::kFree) tick.answer.state = ProxyStatus::kTouching;
  }
  answer = std::move(tick.answer);
  place = std::move(tick.place);
  needle = std::move(tick.needle);
  last_way = tick.way;
  last_hand = hand;
  last_organs = organs;
  for (std::size_t i = 0; i < organs.size(); ++i) {
    last_organs[i].keep = tick.motions[i].keep;
    last_organs[i].clearances = tick.motions[i].clearances;
    last_organs[i].advance = last_organs[i].approach = nullptr;  // Only follow() may call them.
  }
  last_clearance = tissue.clearance();
}

/// Moves a needle that is in tissue. Returns whether it is still in tissue.
bool HapticProxy::State::move_needle(Tick& tick) {
  if (!needle || !tick.place) return false;
  Needle moved = *needle;
  const Needle::Fate fate = moved.follow(tick.hand.axis, tick.organs, settings, tissue);
  if (fate == Needle::Fate::kHeld) {
    hold(tick, std::move(moved));
    return true;
  }
  tick.place->pose.axis = moved.axis();
  tick.place->clearance = ProxyPlace().clearance;
  if (fate == Needle::Fate::kLost) {
    tick.answer.message = "the face that the needle entered is gone, or has come to the trocar";
    tick.place.reset();
  }
  return false;
}

/// The proxy becomes, or stays, a needle in tissue.
void HapticProxy::State::hold(Tick& tick, Needle&& held) const {
  ToolPose pose = tick.hand;
  pose.axis = held.axis();
  pose = mobility->combine(pose, tick.hand);
  tick.place = ProxyPlace{pose, ProxyPlace().clearance};
  tick.way = 0.0;
  tick.answer.state = ProxyStatus::kPunctured;
  tick.answer.proxy = pose;
  tick.answer.pull = held.axis().tip - tick.hand.axis.tip;
  tick.answer.contacts.clear();
  tick.answer.crossings = held.crossings();
  tick.needle = std::move(held);
}

void HapticProxy::State::move_proxy(Tick& tick) {
  const ToolPose& hand = tick.hand;
  choose_sides(tick);
  if (tick.place && is_in_new_tissue(tick)) {
    tick.answer.message = "new tissue is where the proxy was";
    tick.place.reset();
  } else if (tick.place) {
    tick.place = motion.give_way(*tick.place, hand, tick.motions);
    if (!tick.place) tick.answer.message = "tissue moved through the proxy";
  }
  tick.answer.is_placed_anew = !tick.place;
  if (!tick.place) {
    std::string why_not;
    tick.place = motion.enter(tool.freedom, hand, tick.motions, why_not);
    if (!tick.place) {
      tick.answer.message += ", and " + why_not;
      return;
    }
  }
  ProxyPlace& now = *tick.place;
  const ToolPose start = now.pose;
  const double reach = 2.0 * std::max(tick.hand_way.longest, last_way);
  const bool was_free = tick.answer.is_placed_anew || answer.state == ProxyStatus::kFree;
  if (!was_free || !motion.fly(now, hand)) motion.slide(now, hand, reach);
  if (!tick.answer.is_placed_anew) {
    tick.way = mobility->longest_way(hand, mobility->between(start, now.pose));
  }
}

/// How each organ moved since the last tick. `goes_on`: the tool keeps the sides that it has.
std::vector<OrganTick> HapticProxy::State::match(const std::vector<ProxyOrgan>& organs,
                                                 bool goes_on) const {
  std::vector<OrganTick> ticks;
  for (const ProxyOrgan& organ : organs) {
    OrganTick& tick = ticks.emplace_back();
    tick.now = organ.shape.get();
    tick.topology = organ.topology;
    tick.T_now = tick.T_before = organ.T_organ_proxy;
    tick.keep = organ.keep;
    tick.given = &organ;
    tick.clearances = organ.clearances;
    tick.clearances.resize(1 + tool.links.size(), settings.clearance);
    if (tool.radius == 0.0) tick.clearances[0] = 0.0;
    for (const ProxyOrgan& last : last_organs) {
      if (last.name != organ.name) continue;
      tick.last = &last;
      if (organ.keep == Side::kUnknown && goes_on) tick.keep = last.keep;
      const bool has_same_triangles =
          last.shape->topology() == organ.shape->topology() && last.shape->same_faces(*organ.shape);
      if (!has_same_triangles) continue;
      tick.before = last.shape.get();
      tick.T_before = last.T_organ_proxy;
      // The proxy may be on the wrong side of an organ that is inspected only now, or kept anew.
      tick.is_new = (organ.topology && !last.topology) || tick.keep != last.keep;
    }
  }
  return ticks;
}

/// Takes the clearances of this tick. What was proven of the place in the scaled distances of the
/// last tick is put into those of this one. An organ that begins to hold a part counts as new.
void HapticProxy::State::set_clearances(Tick& tick) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  ProxyClearance now{kNone};
  for (const OrganTick& organ : tick.motions) {
    for (const double own : organ.clearances) {
      if (own > 0.0) now.rest = std::min(now.rest, own);
      now.most = std::max(now.most, own);
    }
  }
  if (now.rest == kNone) now.rest = settings.clearance;
  motion.set_clearance(now);
  double proven = kNone;
  for (OrganTick& organ : tick.motions) {
    for (std::size_t part = 0; organ.last && part < organ.clearances.size(); ++part) {
      const double own = organ.clearances[part], before = organ.last->clearances[part];
      if (own == 0.0 || !tick.place) continue;
      if (before == 0.0) organ.is_new = organ.holds_more = true;
      if (before == 0.0) continue;
      const double distance = last_clearance.distance(tick.place->clearance, before);
      proven = std::min(proven, now.scaled(distance, own));
    }
  }
  if (proven < kNone) tick.place->clearance = proven;
}

/// Chooses the side of each closed organ of which the tool keeps the side where it starts.
void HapticProxy::State::choose_sides(Tick& tick) {
  for (OrganTick& organ : tick.motions) {
    if (organ.keep != Side::kUnknown || !organ.topology || !organ.topology->is_closed()) continue;
    const auto places = tissue.places_of(tick.place ? tick.place->pose : tick.hand, organ);
    if (places.empty()) continue;
    const Side side = tissue.side(organ, places.front());
    if (side != Side::kOnSurface) organ.keep = side;
  }
}

/// Whether the proxy is on the wrong side of an organ that is new, or crosses its surface. If such
/// an organ is nearer than the proxy's clearance, its distance becomes the clearance.
bool HapticProxy::State::is_in_new_tissue(Tick& tick) {
  std::vector<OrganTick> new_organs;
  std::copy_if(tick.motions.begin(), tick.motions.end(), std::back_inserter(new_organs),
               [](const OrganTick& organ) { return organ.is_new; });
  if (new_organs.empty()) return false;
  ProxyPlace& start = *tick.place;
  tissue.set_organs(new_organs);
  // The links of a squeezed tool reach into tissue, so only its first place counts.
  const bool is_wrong = tissue.is_on_wrong_side(start.pose, true);
  start.clearance = std::min(start.clearance, tissue.clearance().rest);
  std::vector<TissueContact> contacts;
  tissue.touch({start.pose}, tissue.clearance().rest, contacts);
  for (const TissueContact& contact : contacts) {
    start.clearance = std::min(start.clearance, contact.scaled);
  }
  tissue.set_organs(tick.motions);
  return is_wrong;
}

/// How far the hand moved since the last tick.
HapticProxy::State::HandWay HapticProxy::State::way_of(const ToolPose& hand) const {
  const Displacement way = mobility->between(last_hand, hand);
  const double trocar = tool.freedom == ProxyFreedom::kTrocar
                            ? (hand.axis.trocar - last_hand.axis.trocar).norm()
                            : 0.0;
  return {std::max({way.head<3>().norm(), way.tail<3>().norm(), trocar}),
          std::max(mobility->longest_way(hand, way), trocar)};
}

/// Says in the answer where the proxy is, what holds it, and how it pulls the hand.
void HapticProxy::State::describe(Tick& tick) {
  const ProxyPlace& now = *tick.place;
  ProxyAnswer& said = tick.answer;
  Displacement back = mobility->between(now.pose, tick.hand);
  if (back.norm() < kSamePlace) back.setZero();
  said.proxy = back.isZero(0.0) ? tick.hand : now.pose;
  said.pull -= back.head<3>();
  said.twist -= said.size * back.tail<3>();
  const ProxyClearance& clearance = tissue.clearance();
  double nearest = now.clearance, hovers = now.clearance - clearance.rest;
  for (const TissueContact& near : motion.contacts()) {
    nearest = std::min(nearest, near.scaled);
    hovers = std::min(hovers, near.spare());
  }
  // A face bears load up to a distance that exceeds its clearance if the proxy hovers because it
  // did not reach its place in this tick.
  hovers = back.isZero(0.0) ? 0.0 : std::max(0.0, hovers);
  const double told = std::max(clearance.told(), kResting * (clearance.rest + hovers));
  std::vector<Wall> holding;
  for (std::size_t i = 0; i < motion.contacts().size(); ++i) {
    const TissueContact& near = motion.contacts()[i];
    if (near.spare() + clearance.rest >= told) continue;
    said.contacts.push_back(face_at(near));
    const bool holds = near.distance <= kResting * (near.clearance + hovers);
    // A row of zeros bears no load.
    holding.push_back({holds ? motion.walls()[i].row : Displacement(Displacement::Zero()), 0.0});
  }
  solver.solve(back, holding);
  for (std::size_t i = 0; i < holding.size(); ++i) said.contacts[i].load = solver.load(i);
  if (nearest < clearance.least()) {
    said.state = ProxyStatus::kSqueezed;
  } else {
    said.state = back.isZero(0.0) ? ProxyStatus::kFree : ProxyStatus::kTouching;
  }
  if (settings.row_reach > 0.0) add_rows(now.pose, said.contacts);
  sort(said.contacts);
  if (settings.hand_rows) describe_hand(tick);
}

/// Adds the tissue near the tool at a pose, up to row_reach and at least as far as an answer tells:
/// the nearest face of each patch, whose radius is half of that, unless it is listed already.
/// Returns false if the tests of the tick are used up. Tissue is then missing.
bool HapticProxy::State::add_rows(const ToolPose& pose, std::vector<ProxyFace>& rows) {
  const ProxyClearance& clearance = tissue.clearance();
  const double reach = std::max(clearance.told(), settings.row_reach);
  const bool is_complete =
      tissue.look(pose, {clearance.told(), 0.5 * reach, clearance.rest}, found, reach);
  const auto listed = static_cast<std::ptrdiff_t>(rows.size());
  for (const TissueContact& near : found) {
    const bool is_listed =
        std::any_of(rows.begin(), rows.begin() + listed, [&](const ProxyFace& row) {
          return row.organ == near.organ && row.contact.face == near.contact.face &&
                 row.contact.link == near.contact.link;
        });
    if (!is_listed) rows.push_back(face_at(near));
  }
  return is_complete;
}

/// The rows of the hand as it is. None if the way from the proxy to the hand meets tissue: the hand
/// has passed a wall, behind which its rows would point the wrong way. None, too, if the tests of
/// the tick are used up.
void HapticProxy::State::describe_hand(Tick& tick) {
  std::vector<ProxyFace>& rows = tick.answer.hand_contacts;
  if (tick.answer.state == ProxyStatus::kFree) {
    rows = tick.answer.contacts;
    for (ProxyFace& row : rows) row.load = 0.0;
    return;
  }
  tissue.touch({tick.place->pose, tick.hand}, 0.0, found);
  if (!found.empty()) return;
  if (!add_rows(tick.hand, rows)) rows.clear();
  sort(rows);
}

}  // namespace organ_collision
