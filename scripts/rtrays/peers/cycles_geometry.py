# SPDX-License-Identifier: MIT
"""Reads exported PLY meshes for Blender and splits emissive triangles into smaller ones."""

import numpy


class Triangles:
    """A triangle mesh: positions (n, 3), normals (n, 3) or None, uv (n, 2) or None, and triangles
    (m, 3), which are counter-clockwise seen from the front."""

    def __init__(self, positions, triangles, normals=None, uv=None):
        self.positions, self.triangles, self.normals, self.uv = positions, triangles, normals, uv


def read_ply(path, mesh):
    """Reads a mesh that renderer/export/ply_file.cpp wrote; `mesh` is its entry in the scene
    description. Drops triangles that name a vertex twice: they have no area, and Blender 3.4
    crashes on their smooth normals. Raises ValueError if the file does not match the entry."""
    with open(path, "rb") as file:
        data = file.read()
    begin = data.index(b"end_header\n") + len(b"end_header\n")
    columns = 3 + 3 * mesh["has_normals"] + 2 * mesh["has_uv"]
    vertices = numpy.frombuffer(data, "<f4", mesh["vertices"] * columns, begin).reshape(-1, columns)
    begin += vertices.nbytes
    faces = numpy.frombuffer(
        data, numpy.dtype([("count", "u1"), ("vertices", "<u4", 3)]), mesh["triangles"], begin
    )
    if begin + faces.nbytes != len(data) or not (faces["count"] == 3).all():
        raise ValueError(
            f"{path}: expected {mesh['vertices']} vertices and only triangles, "
            "as in the scene description; export the scene again"
        )
    triangles = faces["vertices"].astype(numpy.int32)
    return Triangles(
        vertices[:, :3],
        triangles[(triangles != triangles[:, [1, 2, 0]]).all(1)],
        vertices[:, 3:6] if mesh["has_normals"] else None,
        vertices[:, -2:] if mesh["has_uv"] else None,
    )


def split(surface, longest_edge):
    """Returns the surface with each triangle split into n^2 similar ones, so that no edge is longer
    than `longest_edge`."""
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
