# SPDX-License-Identifier: MIT
"""The picture of README: one scene at equal time, and feature scenes."""

import numpy
from matplotlib import font_manager
from PIL import Image, ImageDraw, ImageFont

from rtrays.paths import ROOT, SCENES
from rtrays.programs import run

PROGRAMS = ROOT / "build/bin"
SCENE = SCENES / "floor_lamps/scene.json"
FEATURES = [
    "gold",
    "rough_glass_ggx",
    "car_paint",
    "julia",
    "environment_light",
    "texture_bilinear",
    "thin_lens",
    "ellipsoid",
]
WIDTH, GAP = 1536, 8
PANEL = (WIDTH - 2 * GAP) // 3
TILE = (WIDTH - (len(FEATURES) - 1) * GAP) // len(FEATURES)


def render(path, scene, size, *arguments):
    """Returns a display image of a scene, which is rendered unless the file exists."""
    if not path.exists():
        run([PROGRAMS / "rtrays-render", scene, "-o", path, "--size", f"{size}x{size}", *arguments])
    return Image.open(path).convert("RGB")


def reference(path, spp):
    """Returns the display image of the Embree reference, which is rendered unless the file
    exists."""
    if not path.exists():
        exr = path.with_suffix(".exr")
        program, size = PROGRAMS / "rtrays-reference", f"{PANEL}x{PANEL}"
        run([program, SCENE, "-o", exr, "--size", size, "--spp", spp, "--resume"])
        run([PROGRAMS / "rtrays-render", "develop", exr, "-o", path])
    return Image.open(path).convert("RGB")


def label(image, text):
    """Returns the image with a text on a dark band at the bottom."""
    font = ImageFont.truetype(font_manager.findfont("DejaVu Sans"), 24)
    height = 44
    pixels = numpy.array(image)
    pixels[-height:] = pixels[-height:] // 4
    image = Image.fromarray(pixels)
    ImageDraw.Draw(image).text((14, image.height - height + 8), text, font=font, fill="white")
    return image


def row(images):
    """Returns images side by side."""
    strip = Image.new("RGB", (WIDTH, images[0].height), "white")
    step = (WIDTH + GAP) // len(images)
    for index, image in enumerate(images):
        strip.paste(image, (index * step, 0))
    return strip


def panels(work, seconds, spp):
    """Returns the scene by path tracing, by truncated BDPT, and by the reference."""
    images = []
    for algorithm, name in (("path_tracing", "path tracing"), ("truncated_bdpt", "truncated BDPT")):
        arguments = ["--algorithm", algorithm]
        # The kernels are compiled before the time begins.
        render(work / f"{algorithm}.warm.png", SCENE, PANEL, *arguments, "--spp", 1)
        image = render(work / f"{algorithm}.png", SCENE, PANEL, *arguments, "--time", seconds)
        images.append(label(image, f"{name}, {seconds:g} s"))
    image = reference(work / "reference.png", spp)
    return [*images, label(image, f"Embree reference, {spp} spp")]


def write_hero(work, seconds, spp):
    """Writes the picture and returns its path; renders are kept in the folder `work`."""
    work.mkdir(parents=True, exist_ok=True)
    tiles = [
        render(work / f"{name}.png", SCENES / f"features/{name}.json", TILE, "--spp", 512)
        for name in FEATURES
    ]
    rows = [row(panels(work, seconds, spp)), row(tiles)]
    hero = Image.new("RGB", (WIDTH, sum(strip.height for strip in rows) + GAP), "white")
    hero.paste(rows[0], (0, 0))
    hero.paste(rows[1], (0, rows[0].height + GAP))
    path = ROOT / "docs/images/hero.jpg"
    hero.save(path, quality=88)
    return path
