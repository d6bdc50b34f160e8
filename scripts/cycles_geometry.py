# SPDX-License-Identifier: MIT
"""Meshes for Blender: our PLY files, and quadrics as triangles."""

import numpy

# A quadric is a grid of so many cells along v and u. Chords of a circle are then at most 1.9e-5 of its radius below
# it; spheres and discs are scaled to their area, which leaves +- 2e-5.
ROWS, COLUMNS = 256, 512

# What shines is coarser: Cycles chooses among triangles by a float, and the more there are the darker it renders them. Three
# spheres (scenes/analytic/three_lamps.json) come out up to 0.02 % too dark where each has 64 columns, 0.1 % with 128, 0.4 % with
# 256. Seen from any side a sphere of 64 has the disc it should to within 9e-4, 2e-4 in the root mean square.
BRIGHT_ROWS, BRIGHT_COLUMNS = 32, 64


class Triangles:
    """positions (n, 3), normals (n, 3) or None, uv (n, 2) or None; triangles (m, 3), counter-clockwise seen from the
    front."""

    def __init__(self, positions, triangles, normals=None, uv=None):
        self.positions, self.triangles, self.normals, self.uv = positions, triangles, normals, uv


def read_ply(path, mesh):
    """A mesh as renderer/export/ply_file.cpp writes it; `mesh` is its entry of the description."""
    with open(path, "rb") as file:
        data = file.read()
    begin = data.index(b"end_header\n") + len(b"end_header\n")
    columns = 3 + 3 * mesh["has_normals"] + 2 * mesh["has_uv"]
    vertices = numpy.frombuffer(data, "<f4", mesh["vertices"] * columns, begin).reshape(-1, columns)
    begin += vertices.nbytes
    faces = numpy.frombuffer(data, numpy.dtype([("count", "u1"), ("vertices", "<u4", 3)]), mesh["triangles"], begin)
    if begin + faces.nbytes != len(data) or not (faces["count"] == 3).all():
        raise ValueError(f"{path}: not the mesh of {mesh['vertices']} vertices that the description names")
    return Triangles(
        vertices[:, :3],
        faces["vertices"].astype(numpy.int32),
        vertices[:, 3:6] if mesh["has_normals"] else None,
        vertices[:, -2:] if mesh["has_uv"] else None,
    )


def _sphere(phi, v, _):
    theta = numpy.pi * (1 - v)
    point = numpy.stack([numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)], -1)
    return point, point, v


def _of_revolution(phi, radius, z, slope, v):
    """Radius r(z) about z: the normal is (cos, sin, -dr/dz), `slope` being dr/dz (or r dr/dz with radius scaled in)."""
    cosine, sine = numpy.cos(phi), numpy.sin(phi)
    point = numpy.stack([radius * cosine, radius * sine, z], -1)
    return point, numpy.stack([slope[0] * cosine, slope[0] * sine, -slope[1]], -1), v


def _cylinder(phi, v, _):
    return _of_revolution(phi, 1.0 + 0 * v, v, (1.0 + 0 * v, 0 * v), v)


def _cone(phi, v, _):
    return _of_revolution(phi, 1 - v, v, (1.0 + 0 * v, -1.0 + 0 * v), v)


def _paraboloid(phi, v, _):
    # Rows of equal steps in the radius: z = r^2, and the gradient of x^2 + y^2 - z is (2 x, 2 y, -1).
    return _of_revolution(phi, v, v * v, (2 * v, 1.0 + 0 * v), v * v)


def _hyperboloid(phi, v, flare):
    z = 2 * v - 1
    radius = numpy.sqrt(1 + flare * z * z)
    return _of_revolution(phi, radius, z, (radius, flare * z), v)


def _disc(phi, v, _):
    point, normal, _ = _of_revolution(phi, v, 0 * v, (0 * v, -1.0 + 0 * v), v)
    return point, normal, None


_SURFACES = {
    "sphere": (_sphere, 4 * numpy.pi),
    "disc": (_disc, numpy.pi),
    "cylinder": (_cylinder, None),
    "cone": (_cone, None),
    "paraboloid": (_paraboloid, None),
    "hyperboloid": (_hyperboloid, None),
}


def areas(positions, triangles):
    a, b, c = (positions[triangles[:, i]] for i in range(3))
    return 0.5 * numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1)


def tessellate(kind, flare=0.0, is_bright=False):
    """The canonical surface of renderer/scene/stores.h, in double."""
    surface, area = _SURFACES[kind]
    rows, columns = (BRIGHT_ROWS, BRIGHT_COLUMNS) if is_bright else (ROWS, COLUMNS)
    if kind == "disc":
        rows = 1
    u, v = numpy.meshgrid(numpy.linspace(0, 1, columns + 1), numpy.linspace(0, 1, rows + 1))
    positions, normals, texture_v = surface(2 * numpy.pi * u, v, flare)
    if texture_v is None:
        uv = (positions[..., :2] + 1) / 2
    else:
        uv = numpy.stack([u, texture_v], -1)
        if kind in ("sphere", "cone", "paraboloid"):  # a pole has the u of the middle of the triangle below it
            for row in [0, rows] if kind == "sphere" else [rows] if kind == "cone" else [0]:
                uv[row, :, 0] = (numpy.arange(columns + 1) + 0.5) / columns
    first = (numpy.arange(rows)[:, None] * (columns + 1) + numpy.arange(columns)).reshape(-1)
    above = first + columns + 1
    triangles = numpy.concatenate(
        [numpy.stack([first, first + 1, above + 1], 1), numpy.stack([first, above + 1, above], 1)]
    )
    positions, normals, uv = (values.reshape(-1, values.shape[-1]) for values in (positions, normals, uv))
    size = areas(positions, triangles)
    triangles = triangles[size > 1e-6 * size.mean()]  # not those at the poles that have no area
    if area is not None:
        positions = positions * numpy.sqrt(area / areas(positions, triangles).sum())
    return Triangles(positions, triangles.astype(numpy.int32), normals, uv)


def split(surface, longest_edge):
    """The same surface with each triangle cut into n^2 like it, so that no edge is longer."""
    ends = surface.positions[surface.triangles]
    edges = numpy.linalg.norm(ends - ends[:, [1, 2, 0]], axis=2).max(1)
    if edges.max() <= longest_edge:
        return surface
    pieces, corners, first = [], [], 0
    for triangle, edge in zip(surface.triangles, edges):
        n = max(1, int(numpy.ceil(edge / longest_edge)))
        index, weights = {}, []
        for i in range(n + 1):
            for j in range(n + 1 - i):
                index[i, j] = first + len(weights)
                weights.append([(n - i - j) / n, i / n, j / n])
        corners.append(numpy.array([[*triangle, *weight] for weight in weights]))
        first += len(weights)
        for i in range(n):
            for j in range(n - i):
                pieces.append([index[i, j], index[i + 1, j], index[i, j + 1]])
                if i + j < n - 1:
                    pieces.append([index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]])
    corners = numpy.concatenate(corners)

    def mixed(values):
        if values is None:
            return None
        return (values[corners[:, :3].astype(int)] * corners[:, 3:, None]).sum(1)

    triangles = numpy.array(pieces, numpy.int32)
    return Triangles(mixed(surface.positions), triangles, mixed(surface.normals), mixed(surface.uv))


def place(surface, world_from_object):
    """The surface under an affine transform, its front where its normals point."""
    matrix = numpy.array(world_from_object)
    positions = surface.positions @ matrix[:3, :3].T + matrix[:3, 3]
    normals = surface.normals @ numpy.linalg.inv(matrix[:3, :3])  # (M^-T n)^T
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    triangles = surface.triangles
    a, b, c = (positions[triangles[:, i]] for i in range(3))
    if (numpy.cross(b - a, c - a) * normals[triangles[:, 0]]).sum() < 0:
        triangles = triangles[:, ::-1]
    return Triangles(positions, triangles, normals, surface.uv)
