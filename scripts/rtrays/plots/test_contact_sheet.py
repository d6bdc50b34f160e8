# SPDX-License-Identifier: MIT
"""Tests the sheet of images."""

import pathlib
import tempfile
import unittest

import numpy
from PIL import Image

from rtrays.documents.document import RunError
from rtrays.plots.contact_sheet import COLUMNS, write_contact_sheet


class ContactSheet(unittest.TestCase):
    def test_images_are_in_rows(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "images").mkdir()
            with self.assertRaisesRegex(RunError, "run the experiment"):
                write_contact_sheet(folder, folder / "sheet.png")
            sizes = []
            for count in (1, COLUMNS + 1):
                for index in range(count):
                    path = folder / f"images/scene_{index}.path_tracing.npy"
                    numpy.save(path, numpy.full((4, 4, 3), 0.5, dtype=numpy.float32))
                write_contact_sheet(folder, folder / "sheet.png")
                with Image.open(folder / "sheet.png") as sheet:
                    sizes.append(sheet.size)
        self.assertEqual(sizes[0][0], sizes[1][0])
        self.assertEqual(sizes[1][1], 2 * sizes[0][1])


if __name__ == "__main__":
    unittest.main()
