#include <cmath>
#include <limits>

#include "soak.hpp"

namespace organ_collision::soak {
namespace {

constexpr Sheet kSheet{224};              // squares a side, of two faces each
constexpr std::size_t kShapes = 64;       // ticks of a wave
constexpr double kPhaseStep = 0.01;       // [rad] of the tools, from tick to tick
constexpr double kSide = 0.1;             // [m] of the sheet
constexpr double kWaveHeight = 2e-3;      // [m]
constexpr double kWaveNumber = 90.0;      // [rad/m]
constexpr double kReach = 0.01;           // [m] of the tools, above and below the sheet
constexpr double kTurn = 0.8;             // [rad] of the jaw to either side
constexpr std::size_t kSquaresCut = 90;   // by one cut
constexpr std::uint32_t kCuts = 6;        // before the sheet is whole again
constexpr std::uint64_t kGlitches = 900;  // One shape of so many has a glitch.
constexpr float kSpike = 0.05F;           // [m]
constexpr Tick kGapBlock = 1500;          // Of two such blocks of ticks, about one has a gap.
constexpr Tick kLongestGap = 200;

const Eigen::Vector3d kTurningAxis = Eigen::Vector3d(1.0, 2.0, -0.5).normalized();

enum Purpose : std::uint64_t { kGap, kGlitchKind, kGlitchVertex };

/// SplitMix64 (Steele, Lea and Flood, 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

}  // namespace

std::vector<float> Sheet::vertices(double phase) const {
  std::vector<float> vertices;
  vertices.reserve(3 * (cells + 1) * (cells + 1));
  for (std::size_t row = 0; row <= cells; ++row) {
    for (std::size_t column = 0; column <= cells; ++column) {
      const double x = kSide * (static_cast<double>(column) / static_cast<double>(cells) - 0.5);
      const double y = kSide * (static_cast<double>(row) / static_cast<double>(cells) - 0.5);
      const double z = kWaveHeight * std::sin(kWaveNumber * (x + 0.3 * y) + phase);
      for (const double value : {x, y, z}) vertices.push_back(static_cast<float>(value));
    }
  }
  return vertices;
}

std::vector<std::uint32_t> Sheet::triangles(std::size_t cut) const {
  std::vector<std::uint32_t> triangles;
  triangles.reserve(6 * (cells * cells - cut));
  for (std::size_t square = cut; square < cells * cells; ++square) {
    const auto corner = static_cast<std::uint32_t>(square / cells * (cells + 1) + square % cells);
    const auto above = static_cast<std::uint32_t>(corner + cells + 1);
    for (const std::uint32_t vertex : {corner, corner + 1, above + 1, corner, above + 1, above}) {
      triangles.push_back(vertex);
    }
  }
  return triangles;
}

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

ToolPlaces Script::tools(Tick tick) const {
  const double phase = kPhaseStep * static_cast<double>(tick);
  const double height = kReach * std::sin(phase), side = kReach * std::cos(0.3 * phase);
  const Eigen::AngleAxisd turn(kTurn * std::sin(0.7 * phase), kTurningAxis);
  return {{side, 0.0, height},
          {0.0, side, -height},
          {-side, 0.0, height},
          Eigen::Translation3d(side, side, height) * turn};
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
