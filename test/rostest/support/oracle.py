"""The definition of a contact, computed naively for each face in double precision.

An axis is a pair (trocar, tip), a face has three corners, and lengths are in metres. First touch is found by
conservative advancement: while the distance exceeds the radius by a gap, nothing can touch before the fastest corner
and the fastest end together have covered that gap."""

from collections import namedtuple

from .vectors import add, cross, dot, length, lerp, scaled, sub, unit

TIE = 1e-12  # [m] Nearest pairs are tied if their distances differ by at most this; the one nearest the tip counts.
PIERCED = 1e-9  # [m] up to this distance, the axis counts as piercing the face
TOUCH = 1e-11  # [m] first touch stops at this gap
EDGES = ((0, 1), (1, 2), (2, 0))

# `behind` is None if the nearest point of the axis lies in the face: then either answer is right.
Contact = namedtuple('Contact', 'face fraction point normal barycentric shaft depth behind')
Nearest = namedtuple('Nearest', 'distance shaft barycentric')


def weighted(face, weights):
    """The point of the face with these barycentric coordinates."""
    return add(add(scaled(face[0], weights[0]), scaled(face[1], weights[1])), scaled(face[2], weights[2]))


def area_normal(face):
    return cross(sub(face[1], face[0]), sub(face[2], face[0]))


def barycentric(p, face):
    """The barycentric coordinates of p's projection onto the face's plane. None for a degenerate face."""
    n = area_normal(face)
    if dot(n, n) == 0.0:
        return None
    b = dot(cross(sub(p, face[0]), sub(face[2], face[0])), n) / dot(n, n)
    c = dot(cross(sub(face[1], face[0]), sub(p, face[0])), n) / dot(n, n)
    return (1 - b - c, b, c)


def place_on_segment(p, a, b):
    """The place in [0, 1] of the segment's point that is nearest to p."""
    ab = sub(b, a)
    return min(1.0, max(0.0, dot(sub(p, a), ab) / dot(ab, ab))) if dot(ab, ab) > 0 else 0.0


def nearest_pairs(axis, face):
    """Yields all candidates (shaft, barycentric) for the nearest points of axis and face."""
    trocar, tip = axis

    def on_edge(i, j, place):
        weights = [0.0, 0.0, 0.0]
        weights[i], weights[j] = 1 - place, place
        return tuple(weights)

    for shaft, end in ((0.0, trocar), (1.0, tip)):
        weights = barycentric(end, face)
        if weights and min(weights) >= 0:
            yield shaft, weights
        for i, j in EDGES:
            yield shaft, on_edge(i, j, place_on_segment(end, face[i], face[j]))
    d, n = sub(tip, trocar), area_normal(face)
    for i, j in EDGES:
        yield place_on_segment(face[i], trocar, tip), on_edge(i, j, 0.0)
        e, r = sub(face[j], face[i]), sub(face[i], trocar)
        det = dot(d, d) * dot(e, e) - dot(d, e) ** 2
        if det > 0:
            shaft = (dot(r, d) * dot(e, e) - dot(r, e) * dot(d, e)) / det
            place = (dot(r, d) * dot(d, e) - dot(r, e) * dot(d, d)) / det
            if 0 <= shaft <= 1 and 0 <= place <= 1:
                yield shaft, on_edge(i, j, place)
    if dot(n, d) != 0.0:
        shaft = dot(n, sub(face[0], trocar)) / dot(n, d)
        weights = barycentric(lerp(trocar, tip, shaft), face)
        if 0 <= shaft <= 1 and min(weights) >= 0:
            yield shaft, weights


def nearest(axis, face):
    found = [Nearest(length(sub(weighted(face, weights), lerp(*axis, shaft))), shaft, weights)
             for shaft, weights in nearest_pairs(axis, face)]
    least = min(f.distance for f in found)
    return max((f for f in found if f.distance <= least + TIE), key=lambda f: f.shaft)


def first_touch(axis_at, face_at, radius):
    """The earliest time in [0, 1] at which the face is within `radius` of the axis, or None."""
    speed = sum(max(length(sub(b, a)) for a, b in zip(at(0.0), at(1.0))) for at in (axis_at, face_at))
    time = 0.0
    while True:
        gap = nearest(axis_at(time), face_at(time)).distance - radius
        if gap <= TOUCH:
            return time
        if speed == 0.0 or time + gap / speed > 1.0:
            return None
        time += gap / speed


def contact_of_face(number, axis_at, face_at, radius):
    """The contact of one face in a step, or None. `axis_at` and `face_at` map a time in [0, 1] to the axis and to the
    face."""
    time = first_touch(axis_at, face_at, radius)
    if time is None:
        return None
    axis, face, axis_end, face_end = axis_at(time), face_at(time), axis_at(1.0), face_at(1.0)
    at = nearest(axis, face)
    point, point_end = weighted(face, at.barycentric), weighted(face_end, at.barycentric)
    place_end = lerp(*axis_end, at.shaft)
    if at.distance <= PIERCED:
        normal = unit(area_normal(face))
        if dot(normal, sub(axis[1], axis[0])) < 0:
            normal = scaled(normal, -1.0)
        depth = radius + dot(normal, sub(axis_end[1], point_end))
    else:
        normal = unit(sub(point, lerp(*axis, at.shaft)))
        depth = radius - dot(normal, sub(point_end, place_end))
    height = dot(sub(place_end, face_end[0]), unit(area_normal(face_end)))
    behind = height < 0 if abs(height) > PIERCED else None
    return Contact(number, time, point, normal, at.barycentric, at.shaft, depth, behind)


def contacts(mesh, before, motion, radius):
    """All contacts of a step, sorted by face. The mesh moves from `before` to `mesh`, and the axis from motion[0] to
    motion[1]. The step is static if both are equal."""

    def axis_at(t):
        return tuple(lerp(a, b, t) for a, b in zip(*motion))

    # A ball around the whole motion of the axis. Faces outside of it cannot touch.
    ends = motion[0] + motion[1]
    centre = scaled(add(add(ends[0], ends[1]), add(ends[2], ends[3])), 0.25)
    reach = radius + max(length(sub(e, centre)) for e in ends)

    found = []
    for number in range(len(mesh.faces)):
        start, end = before.face(number), mesh.face(number)
        if min(dot(sub(c, centre), unit(sub(start[0], centre))) for c in start + end) > reach:
            continue
        contact = contact_of_face(number, axis_at, lambda t: [lerp(a, b, t) for a, b in zip(start, end)], radius)
        if contact:
            found.append(contact)
    return found


def static_contacts(mesh, axis, radius):
    return contacts(mesh, mesh, (axis, axis), radius)


def swept_contacts(mesh, previous, axis, radius):
    return contacts(mesh, mesh, (previous, axis), radius)
