#pragma once

/// All tolerances of the geometry, each with its unit, its meaning and its consequences.
namespace organ_collision::tolerance {

/// [m] The search for the first touch stops when the distance is within this of the radius. While
/// the tool moves, a face that comes within the radius is touched, and a face that stays farther
/// than radius + kTouch is not. At the start of a step, and in static queries, the rounded distance
/// alone decides.
inline constexpr double kTouch = 1e-10;

/// [1] The same tolerance as a share of the largest coordinate: a few rounding errors of that
/// coordinate. Smaller differences of distance or time are noise. It is larger than kTouch for
/// coordinates above 12.5 km.
inline constexpr double kRounding = 8e-15;

/// [m] While tool or organ move, the smallest distance that is found is at most this much above the
/// true one. A fraction of the step at which it occurs is therefore not unique.
inline constexpr double kApproach = 5e-7;

/// [m] Axis and face count as piercing up to this distance. The direction between their nearest
/// points is then noise, so the normal of the face is used instead.
inline constexpr double kPierced = 1e-9;

/// [m] Radius of parts of links with flat faces (convex margin). It keeps the contact direction
/// well defined: such a part touches faces that are nearer than this. It is about as large as the
/// rounding of a 32-bit vertex coordinate 0.2 m from the origin.
inline constexpr double kConvexMargin = 1e-8;

/// [m] Nearest pairs are tied if their separation vectors differ by less than this. Of tied pairs,
/// the points nearest the tip are used. The least distance decides whether there is a touch.
inline constexpr double kTie = 1e-12;

/// [1] Two directions count as parallel below this sine of the angle between them. An axis then
/// lies in the plane of a face. A face is degenerate if its height is a smaller share of its
/// longest edge.
inline constexpr double kParallel = 1e-12;

/// [m] Vertices that were at one place in the mesh message count as one vertex as long as they are
/// within this of each other. Where they are farther apart, the surface has a gap, and the sides of
/// points are unknown.
inline constexpr double kSeam = 1e-6;

/// [m] The largest legal coordinate. An organ farther away is a mistake of units. At this distance,
/// neighbouring 32-bit coordinates differ by 6 cm.
inline constexpr double kFarthest = 1e6;

// Contacts are exact to 1e-9 m only if the tolerances have this order.
static_assert(kTie < kTouch && kTouch < kPierced && kPierced <= 1e-9);

}  // namespace organ_collision::tolerance
