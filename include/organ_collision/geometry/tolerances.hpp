#pragma once

/// All tolerances of the geometry, each with its unit, its meaning and what follows from it.
namespace organ_collision::tolerance {

/// [m] First touch stops advancing when the distance is within this of the radius. On the tool's
/// way, a face that comes within the radius is touched, and one that stays beyond radius + kTouch
/// is not. Where the step begins, and in static queries, the distance as rounded decides.
inline constexpr double kTouch = 1e-10;

/// [1] The same as a share of the largest coordinate: some roundings of it. Nearer than that, a
/// distance and the next time of the leg are rounding. More than kTouch from 12.5 km on.
inline constexpr double kRounding = 8e-15;

/// [m] At most this distance between axis and face counts as piercing: the direction between the
/// nearest points is then noise, so the normal is taken from the face.
inline constexpr double kPierced = 1e-9;

/// [m] Radius that parts of links with flat faces are given, so that the direction in which they
/// first touch is none of rounding: they touch what is nearer than this. Less than 32 bits round
/// off a vertex 0.2 m from the origin.
inline constexpr double kConvexMargin = 1e-8;

/// [m] Nearest pairs that are apart by the same vector, within this, are tied; the one nearest the
/// tip is taken.
inline constexpr double kTie = 1e-12;

/// [1] Sine of the angle below which two directions count as parallel: an axis lies in the plane of
/// a face, a face is degenerate (its height over its longest edge, as a share of that edge).
inline constexpr double kParallel = 1e-12;

/// [m] No coordinate may be larger: an organ there is a mistake of units, and clipping with 32-bit
/// floats would over-report within a metre of the tool.
inline constexpr double kFarthest = 1e6;

// The guarantee for contacts, 1e-9 m, depends on this order.
static_assert(kTie < kTouch && kTouch < kPierced && kPierced <= 1e-9);

}  // namespace organ_collision::tolerance
