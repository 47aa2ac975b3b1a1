"""The faces in the 1999 paper's own viewing volumes, found by clipping each face in double
precision.

A volume is a list of half-spaces (n, d), each the set of all x with n . x <= d. The first one is
the near plane, from which the depth range along the view is measured."""

from .vectors import add, cross, dot, lerp, scaled, sub, unit


def half_space(normal, through):
    return (normal, dot(normal, through))


def static_volume(axis, radius):
    """The volume of section 3: a box of half-width `radius` around the axis, flat at both ends. Its
    up vector is the frame axis that is least aligned with the view."""
    trocar, tip = axis
    view = unit(sub(tip, trocar))
    least = min(range(3), key=lambda i: abs(view[i]))
    up_vector = tuple(1.0 if i == least else 0.0 for i in range(3))
    right = unit(cross(view, up_vector))
    up = cross(right, view)
    volume = [half_space(scaled(view, -1), trocar), half_space(view, tip)]
    for side in (right, up):
        volume.append(half_space(side, add(trocar, scaled(side, radius))))
        volume.append(half_space(scaled(side, -1), sub(trocar, scaled(side, radius))))
    return volume


def swept_volume(trocar, previous, tip, radius):
    """The hexahedron of section 4, figure 7, between P0 and PP'. Its sides go from P0 - s u to P -
    s u and from P0 + s u to P' + s u. It extends by s to either side of the plane of the motion."""
    along = unit(sub(tip, previous))
    across = unit(cross(sub(previous, trocar), sub(tip, trocar)))
    view = unit(cross(across, along))
    if dot(view, sub(tip, trocar)) < 0:
        view = scaled(view, -1)
    reach = scaled(along, radius)
    volume = [half_space(scaled(view, -1), trocar), half_space(view, tip)]
    for end, shift in ((previous, scaled(reach, -1)), (tip, reach)):
        corner = add(trocar, shift)
        normal = unit(cross(across, sub(add(end, shift), corner)))
        if dot(normal, shift) < 0:
            normal = scaled(normal, -1)
        volume.append(half_space(normal, corner))
    for normal in (across, scaled(across, -1)):
        volume.append(half_space(normal, add(trocar, scaled(normal, radius))))
    return volume


def clipped(face, volume):
    """The corners of the part of the face in the volume; empty if there is no such part."""
    polygon = list(face)
    for normal, offset in volume:
        beyond = [dot(normal, p) - offset for p in polygon]
        kept = []
        for i, p in enumerate(polygon):
            if beyond[i - 1] * beyond[i] < 0:
                kept.append(lerp(polygon[i - 1], p, beyond[i - 1] / (beyond[i - 1] - beyond[i])))
            if beyond[i] <= 0:
                kept.append(p)
        polygon = kept
    return polygon


def picked(mesh, volume):
    """{face: (view_min, view_max)}: the faces in the volume and their depths behind the near plane
    [m]."""
    normal, offset = volume[0]
    found = {}
    for number in range(len(mesh.faces)):
        depths = [offset - dot(normal, p) for p in clipped(mesh.face(number), volume)]
        if depths:
            found[number] = (min(depths), max(depths))
    return found
