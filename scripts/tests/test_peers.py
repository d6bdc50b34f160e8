# SPDX-License-Identifier: MIT
"""Triangles for Cycles, and what scripts/peers says where no peer is installed."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(SCRIPTS))

import cycles_geometry  # noqa: E402

FLARE = 0.7
# x^2 + y^2 as a function of z; the surfaces of renderer/scene/stores.h.
PROFILES = {
    "sphere": lambda z: 1 - z * z,
    "cylinder": lambda z: 1 + 0 * z,
    "cone": lambda z: (1 - z) ** 2,
    "paraboloid": lambda z: z,
    "hyperboloid": lambda z: 1 + FLARE * z * z,
}


def face_normals(surface):
    a, b, c = (surface.positions[surface.triangles[:, i]] for i in range(3))
    return numpy.cross(b - a, c - a)


def area(surface):
    return cycles_geometry.areas(surface.positions, surface.triangles).sum()


class Tessellation(unittest.TestCase):
    def test_points_lie_on_the_surface(self):
        for kind, profile in PROFILES.items():
            x, y, z = cycles_geometry.tessellate(kind, FLARE).positions.T
            self.assertLess(abs(x * x + y * y - profile(z)).max(), 1e-4, kind)

    def test_normals_are_those_of_the_triangles(self):
        for kind in [*PROFILES, "disc"]:
            for bright in (False, True):
                surface = cycles_geometry.place(cycles_geometry.tessellate(kind, FLARE, bright), numpy.eye(4))
                flat = face_normals(surface)
                flat /= numpy.linalg.norm(flat, axis=1, keepdims=True)
                cosines = (flat * surface.normals[surface.triangles].mean(1)).sum(1)
                # The two triangles at the tip of a paraboloid's cell turn most; the tip of a cone has no normal.
                self.assertGreater(cosines.min(), 0.99, kind)
                self.assertLess(abs(numpy.linalg.norm(surface.normals, axis=1) - 1).max(), 1e-12)

    def test_areas(self):
        for kind, expected in {"sphere": 4 * numpy.pi, "disc": numpy.pi, "cylinder": 2 * numpy.pi,
                               "cone": numpy.sqrt(2) * numpy.pi, "paraboloid": numpy.pi / 6 * (5**1.5 - 1)}.items():
            self.assertAlmostEqual(area(cycles_geometry.tessellate(kind)) / expected, 1, delta=5e-5, msg=kind)

    def test_coordinates(self):
        sphere = cycles_geometry.tessellate("sphere")
        x, y, z = (sphere.positions / numpy.linalg.norm(sphere.positions, axis=1, keepdims=True)).T
        inside = abs(z) < 0.999
        phi = numpy.arctan2(y, x)[inside] / (2 * numpy.pi) % 1
        self.assertLess(abs((sphere.uv[inside, 0] - phi + 0.5) % 1 - 0.5).max(), 1e-9)
        self.assertLess(abs(sphere.uv[:, 1] - (1 - numpy.arccos(numpy.clip(z, -1, 1)) / numpy.pi)).max(), 1e-7)
        disc = cycles_geometry.tessellate("disc")
        numpy.testing.assert_allclose(disc.uv, (disc.positions[:, :2] + 1) / 2, atol=2e-5)

    def test_a_mirror_keeps_the_front(self):
        for matrix in (numpy.diag([2.0, 1, 1, 1]), numpy.diag([-2.0, 1, 1, 1])):
            matrix[:3, 3] = [5, 6, 7]
            placed = cycles_geometry.place(cycles_geometry.tessellate("sphere"), matrix)
            centres = placed.positions[placed.triangles].mean(1) - matrix[:3, 3]
            self.assertGreater((face_normals(placed) * centres).sum(1).min(), 0)
            self.assertGreater((placed.normals * (placed.positions - matrix[:3, 3])).sum(1).min(), 0)

    def test_splitting_keeps_area_and_front(self):
        whole = cycles_geometry.Triangles(numpy.array([[0.0, 0, 0], [4, 0, 0], [0, 3, 0], [0, 0, 1]]),
                                          numpy.array([[0, 1, 2], [0, 3, 1]]), None,
                                          numpy.array([[0.0, 0], [1, 0], [0, 1], [1, 1]]))
        pieces = cycles_geometry.split(whole, 0.7)
        self.assertAlmostEqual(area(pieces), area(whole), places=12)
        numpy.testing.assert_allclose(face_normals(pieces).sum(0), face_normals(whole).sum(0), atol=1e-12)
        corners = pieces.positions[pieces.triangles]
        self.assertLess(numpy.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(), 0.7 + 1e-12)
        flat = pieces.positions[:, 2] == 0
        numpy.testing.assert_allclose(pieces.uv[flat][:, 0][pieces.positions[flat][:, 1] == 0],
                                      pieces.positions[flat][:, 0][pieces.positions[flat][:, 1] == 0] / 4, atol=1e-12)


class MissingPeers(unittest.TestCase):
    def test_says_what_to_install(self):
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder) / "scripts/peers"  # a tree without build/peers
            script.parent.mkdir()
            for name in ("peers", "peers_table.py"):
                (script.parent / name).write_text((SCRIPTS / name).read_text())
            done = subprocess.run([sys.executable, script, "--programs", folder], capture_output=True, text=True,
                                  check=False, env={"PATH": folder})
            self.assertEqual(done.returncode, 77, done.stderr)
            self.assertIn("scripts/install --peers", done.stderr)
            self.assertFalse((pathlib.Path(folder) / "build").exists())


if __name__ == "__main__":
    unittest.main()
