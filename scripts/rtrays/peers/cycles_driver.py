# SPDX-License-Identifier: MIT
"""Renders a scene that `rtrays-render SCENE --export NAME.blender.json` wrote, with Cycles.

Expects Blender 3.4:

    blender --background --factory-startup --python-exit-code 1 \\
        --python scripts/rtrays/peers/cycles_driver.py \\
        -- NAME.blender.json [OUT.exr] [--spp N] [--seed S] [--max-depth D] [--runs K] [--serve]

driver.py explains --runs and --serve. The seconds are those of Blender's render call, including
synchronisation.

The world is scaled to an extent of 1. Cycles compares the edges of an emissive triangle with a
distance over an area (triangle_light_sample), so its choice depends on the unit of length. In large
units it samples lamps by solid angles that are accurate to 1e-4 sr only, and distant lamps come out
up to 2 % too dark. Emissive triangles are split for the same reason.

Units. Emission nodes give radiance in W / (sr m^2). The strength of a sun is the irradiance of a
plane that faces it, in W / m^2. A point light of E watts whose shader emits 1 has an intensity of
E / (4 pi) W / sr. scripts/peers compares all of them with closed forms.
"""

import json
import pathlib
import sys

try:
    import bpy
except ImportError:
    print(
        "cycles_driver: not running inside Blender; scripts/install --peers installs Blender",
        file=sys.stderr,
    )
    sys.exit(77)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from rtrays.peers.cycles_scene import add_camera, add_geometry, add_light  # noqa: E402
from rtrays.peers.cycles_settings import set_depth, set_up  # noqa: E402
from rtrays.peers.cycles_surroundings import Images, add_surroundings, means_of  # noqa: E402
from rtrays.peers.driver import parser_of, render_runs, serve, timed  # noqa: E402


def build(scene, folder):
    """Builds the meshes, the camera and the lights of a scene description."""
    film, images = bpy.context.scene, Images(folder)
    scale = 1 / scene["camera"]["extent"]
    add_geometry(scene, folder, images, scale)
    add_camera(scene, film, scale)
    around = [light for light in scene["lights"] if light["kind"] in ("dome", "environment")]
    add_surroundings(around, images, film)
    for light in scene["lights"]:
        if light not in around:
            add_light(light, scale)


def render_request(depth, spp, seed, roulette):
    """Renders without writing the image; Cycles knows no first event of roulette."""
    film = bpy.context.scene
    film.cycles.samples, film.cycles.seed = spp, seed
    set_depth(film.cycles, depth, roulette=roulette > 0)
    film.update_tag()  # else persistent data keep the first render's settings
    bpy.ops.render.render()


def write(output):
    """Writes the image that was rendered last."""
    bpy.data.images["Render Result"].save_render(str(output))


def render_image(seed, output):
    """Renders an image into a file; returns its seconds and the means of R, G and B."""
    film = bpy.context.scene
    film.cycles.seed = seed
    film.update_tag()  # else persistent data keep the first render's settings
    part = output.with_name(output.name + ".part")  # renamed when complete
    film.render.filepath = str(part)
    film.render.use_file_extension = False
    seconds, _ = timed(lambda: bpy.ops.render.render(write_still=True))
    part.replace(output)
    return seconds, means_of(output)


def main(arguments):
    parser = parser_of("cycles_driver", __doc__.split("\n\n")[0])
    options = parser.parse_args(arguments)
    if not options.serve and options.output is None:
        parser.error("expected OUT.exr or --serve")
    scene = json.loads(options.scene.read_text())
    if scene.get("format") != "rtrays scene for Blender" or scene.get("version") != 1:
        raise ValueError(
            f"{options.scene}: not a scene for this driver; write one with"
            " `rtrays-render --export`"
        )
    bpy.ops.wm.read_factory_settings(use_empty=True)
    film, spp = bpy.context.scene, options.spp or scene["samples_per_pixel"]
    depth = scene["max_depth"] if options.max_depth is None else options.max_depth
    set_up(scene, film, spp, depth)
    build(scene, options.scene.resolve().parent)
    film.render.use_persistent_data = True  # avoids a rebuild of the scene for further runs
    engine = "Cycles of Blender " + bpy.app.version_string
    if options.serve:
        serve(engine, render_request, write)
    else:
        render_runs(options, spp, engine, render_image)


if __name__ == "__main__":
    try:
        main(sys.argv[sys.argv.index("--") + 1 :])
    except (OSError, ValueError) as error:
        print(f"cycles_driver: {error}", file=sys.stderr)
        sys.exit(2)
