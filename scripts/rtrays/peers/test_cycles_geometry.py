# SPDX-License-Identifier: MIT
"""Tests the meshes for Cycles."""

import pathlib
import tempfile
import unittest

import numpy

from rtrays.peers import cycles_geometry


def face_normals(surface):
    a, b, c = (surface.positions[surface.triangles[:, i]] for i in range(3))
    return numpy.cross(b - a, c - a)


def area(surface):
    return 0.5 * numpy.linalg.norm(face_normals(surface), axis=1).sum()


class Reading(unittest.TestCase):
    def test_leaves_out_triangles_that_name_a_vertex_twice(self):
        positions = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4")
        faces = [[0, 1, 2], [0, 0, 2], [0, 1, 1], [2, 1, 2], [2, 1, 0]]
        packed = numpy.array(
            [(3, face) for face in faces], numpy.dtype([("count", "u1"), ("vertices", "<u4", 3)])
        )
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "mesh.ply"
            file.write_bytes(b"ply\nend_header\n" + positions.tobytes() + packed.tobytes())
            entry = {"vertices": 3, "triangles": 5, "has_normals": False, "has_uv": False}
            read = cycles_geometry.read_ply(file, entry)
        numpy.testing.assert_array_equal(read.triangles, [faces[0], faces[4]])
        numpy.testing.assert_array_equal(read.positions, positions)


class Splitting(unittest.TestCase):
    def test_keeps_area_and_front(self):
        whole = cycles_geometry.Triangles(
            numpy.array([[0.0, 0, 0], [4, 0, 0], [0, 3, 0], [0, 0, 1]]),
            numpy.array([[0, 1, 2], [0, 3, 1]]),
            None,
            numpy.array([[0.0, 0], [1, 0], [0, 1], [1, 1]]),
        )
        pieces = cycles_geometry.split(whole, 0.7)
        self.assertAlmostEqual(area(pieces), area(whole), places=12)
        numpy.testing.assert_allclose(
            face_normals(pieces).sum(0), face_normals(whole).sum(0), atol=1e-12
        )
        corners = pieces.positions[pieces.triangles]
        self.assertLess(
            numpy.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(), 0.7 + 1e-12
        )
        flat = pieces.positions[:, 2] == 0
        numpy.testing.assert_allclose(
            pieces.uv[flat][:, 0][pieces.positions[flat][:, 1] == 0],
            pieces.positions[flat][:, 0][pieces.positions[flat][:, 1] == 0] / 4,
            atol=1e-12,
        )


if __name__ == "__main__":
    unittest.main()
