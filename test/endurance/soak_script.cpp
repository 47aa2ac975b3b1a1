#include "soak_script.hpp"

#include <cmath>
#include <limits>

namespace organ_collision::soak {
namespace {

constexpr stress::Sheet kSheet{224};      // squares a side, of two faces each
constexpr std::size_t kShapes = 64;       // ticks of a wave
constexpr double kPhaseStep = 0.01;       // [rad] of the tools, from tick to tick
constexpr std::size_t kSquaresCut = 90;   // by one cut
constexpr std::uint32_t kCuts = 6;        // before the sheet is whole again
constexpr std::uint64_t kGlitches = 900;  // One shape of so many has a glitch.
constexpr float kSpike = 0.05F;           // [m]
constexpr Tick kGapBlock = 1500;          // Of two such blocks of ticks, about one has a gap.
constexpr Tick kLongestGap = 200;

enum Purpose : std::uint64_t { kGap, kGlitchKind, kGlitchVertex };

/// SplitMix64 (Steele, Lea and Flood, 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

}  // namespace

Script::Script(std::uint64_t seed) : seed_(seed) {
  for (std::size_t i = 0; i < kShapes; ++i) {
    shapes_.push_back(kSheet.vertices(2.0 * M_PI * static_cast<double>(i) / kShapes));
  }
}

std::vector<std::uint32_t> Script::triangles(std::uint32_t topology) const {
  return kSheet.triangles(kSquaresCut * (topology % kCuts));
}

Glitch Script::glitch(Tick tick) const {
  const std::uint64_t drawn = draw(tick, kGlitchKind);
  if (drawn % kGlitches != 0) return Glitch::kNone;
  constexpr Glitch kKinds[] = {Glitch::kSpike, Glitch::kHuge, Glitch::kNotFinite};
  return kKinds[drawn / kGlitches % 3];
}

std::vector<float> Script::vertices(Tick tick) const {
  std::vector<float> vertices = shapes_[static_cast<std::size_t>(tick) % kShapes];
  float& value = vertices[draw(tick, kGlitchVertex) % vertices.size()];
  switch (glitch(tick)) {
    case Glitch::kNone:
      break;
    case Glitch::kSpike:
      value += kSpike;
      break;
    case Glitch::kHuge:
      value = 1e30F;
      break;
    case Glitch::kNotFinite:
      value = std::numeric_limits<float>::quiet_NaN();
      break;
  }
  return vertices;
}

stress::ToolPlaces Script::tools(Tick tick) const {
  return stress::tool_places(kPhaseStep * static_cast<double>(tick));
}

bool Script::has_poses(Tick tick) const {
  const std::uint64_t drawn = draw(tick / kGapBlock, kGap);
  if (drawn % 2 != 0) return true;
  const auto begin = static_cast<Tick>(drawn / 2 % (kGapBlock - kLongestGap));
  const auto length = 5 + static_cast<Tick>(drawn / 0x10000 % (kLongestGap - 5));
  const Tick place = tick % kGapBlock;
  return place < begin || place >= begin + length;
}

std::uint64_t Script::draw(Tick tick, std::uint64_t purpose) const {
  return mixed(mixed(seed_ + purpose) ^ static_cast<std::uint64_t>(tick));
}

}  // namespace organ_collision::soak
