# SPDX-License-Identifier: MIT
"""Tests the viewer: its images, and its display in a browser."""

import json
import shutil
import subprocess
import unittest

import numpy

from rtrays.documents.document import value
from rtrays.documents.run_document import Run
from rtrays.pages.viewer import to_rgbe
from rtrays.testing import RunFolder


def from_rgbe(pixels):
    """Returns the linear values of pixels that to_rgbe made."""
    mantissa, exponent = pixels[..., :3].astype(float), pixels[..., 3:].astype(float)
    return numpy.where(exponent > 0, (mantissa + 0.5) * 2.0 ** (exponent - 136), 0)


class Viewer(RunFolder):
    def test_viewer_has_the_images(self):
        picture = numpy.array(
            [[[1.0, 0.5, 0.0], [1e4, 1e-4, 3.0]], [[0, 0, 0], [-1, 2e-30, 1e-30]]]
        )
        decoded = from_rgbe(to_rgbe(picture))
        largest = numpy.max(picture, axis=-1, keepdims=True)
        self.assertTrue((abs(decoded - numpy.maximum(picture, 0)) <= largest * 2.0**-8).all())
        self.run_object()
        self.assertEqual(self.results("report", self.folder).returncode, 0)
        text = (self.folder / "images.js").read_text()
        shown = json.loads(text[text.index("[") : text.rindex(";")])
        self.assertEqual(
            [image["name"] for image in shown][:3],
            ["reference, 100 spp", "path tracing (MIS), 64 spp", "path tracing (MIS), 2 spp"],
        )

    @unittest.skipUnless(shutil.which("chromium"), "Chromium is not installed")
    def test_viewer_compares_in_a_browser(self):
        self.run_object()
        self.assertEqual(self.results("report", self.folder).returncode, 0)
        page = self.folder / "driven.html"
        page.write_text(
            (self.folder / "index.html").read_text()
            + """<pre id=told></pre><script>
            const root = document.getElementById("viewer"), canvas = root.querySelector("canvas");
            const [left, right, mode] = root.querySelectorAll("select");
            const [exposure] = root.querySelectorAll("input");
            const set = (control, value) => { control.value = value; control.oninput(); };
            const context = canvas.getContext("2d");
            const data = () => context.getImageData(0, 0, canvas.width, canvas.height).data;
            const shown = () => Array.from(data());
            const told = {size: [canvas.width, canvas.height]};
            set(mode, 1); told.left = shown();
            set(mode, 2); told.right = shown();
            set(mode, 3); set(exposure, 1); told.difference = shown();
            const box = canvas.getBoundingClientRect();
            const corner = {clientX: box.right - 1, clientY: box.bottom - 1};
            canvas.dispatchEvent(new PointerEvent("pointermove", corner));
            told.readout = root.querySelector(".readout").textContent;
            document.getElementById("told").textContent = JSON.stringify(told);</script>"""
        )
        done = subprocess.run(
            [
                "chromium",
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--dump-dom",
                page.as_uri(),
            ],
            capture_output=True,
            text=True,
            timeout=120,
        )
        told = json.loads(done.stdout.rpartition('<pre id="told">')[2].partition("</pre>")[0])
        run = Run(self.folder)
        reference, image = (
            from_rgbe(to_rgbe(run.image(name)))
            for name in (run.get("reference.image"), value(run.curves[-1], "image"))
        )
        height, width = reference.shape[:2]
        self.assertEqual(told["size"], [width, height])

        def bytes_of(linear):  # IEC 61966-2-1
            x = numpy.clip(linear, 0, 1)
            return 255 * numpy.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)

        for key, linear in (
            ("left", reference),
            ("right", image),
            ("difference", 20 * abs(reference - image)),
        ):
            drawn = numpy.array(told[key]).reshape(height, width, 4)
            self.assertTrue((drawn[..., 3] == 255).all())
            self.assertLess(abs(drawn[..., :3] - bytes_of(linear)).max(), 0.51, key)
        self.assertTrue(
            told["readout"].startswith(f"({width - 1}, {height - 1})  left "), told["readout"]
        )


if __name__ == "__main__":
    unittest.main()
