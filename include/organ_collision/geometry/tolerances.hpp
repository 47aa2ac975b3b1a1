#pragma once

/// All tolerances of the geometry, each with its unit, its meaning and its consequences.
namespace organ_collision::tolerance {

/// [m] The search for the first touch stops when the distance exceeds the radius by at most this
/// much. While the tool moves, a face that comes within the radius is touched, and a face that
/// stays farther away than radius + kTouch is not. At the start of a step, and in static queries, a
/// face is touched if the rounded distance is at most the radius.
inline constexpr double kTouch = 1e-10;

/// [1] A few rounding errors of a coordinate, as a share of the coordinate. The search for the
/// first touch adds this share of the largest coordinate to kTouch, because smaller differences of
/// distance are noise. The share is the larger one for coordinates above 12.5 km.
inline constexpr double kRounding = 8e-15;

/// [m] While tool or organ move, the smallest distance that is found is at most this much above the
/// true one. The fraction of the step at which it occurs is therefore not unique.
inline constexpr double kApproach = 5e-7;

/// [m] An axis or link pierces a face if their distance is at most this. The direction between the
/// nearest points is then noise, so the normal of the face is used instead.
inline constexpr double kPierced = 1e-9;

/// [m] The radius of boxes, cylinders and meshes of links (convex margin). Such a part touches
/// faces that are nearer than this, so the contact direction is well defined. It is about as large
/// as the rounding of a 32-bit vertex coordinate 0.2 m from the origin.
inline constexpr double kConvexMargin = 1e-8;

/// [m] Pairs of nearest points of an axis and a face are tied if their separation vectors differ by
/// less than this. Of tied pairs, the pair nearest to the tip is used. The least distance of all
/// pairs decides whether there is a touch.
inline constexpr double kTie = 1e-12;

/// [1] Two directions count as parallel below this sine of the angle between them. An axis that is
/// parallel to a face that it pierces lies in the plane of the face. A face is degenerate if its
/// height is at most this share of its longest edge.
inline constexpr double kParallel = 1e-12;

/// [m] Vertices that were at one place in the mesh message count as one vertex as long as they are
/// within this of each other. Where they are farther apart, the surface has a gap, and the sides of
/// points are unknown.
inline constexpr double kSeam = 1e-6;

/// [m] The largest legal coordinate. An organ that is farther away is taken to be a mistake of
/// units. At this distance, neighbouring 32-bit coordinates differ by 6 cm.
inline constexpr double kFarthest = 1e6;

// Contacts are exact to 1e-9 m only if the tolerances have this order.
static_assert(kTie < kTouch && kTouch < kPierced && kPierced <= 1e-9);

}  // namespace organ_collision::tolerance
