# SPDX-License-Identifier: MIT
"""Renders a scene that `rtrays-render SCENE --export NAME.blender.json` wrote, with Cycles.

Expects Blender 3.4:

    blender --background --factory-startup --python-exit-code 1 --python scripts/cycles_driver.py \\
        -- NAME.blender.json OUT.exr [--spp N] [--seed S] [--max-depth D] [--runs K]
    blender --background --factory-startup --python-exit-code 1 --python scripts/cycles_driver.py \\
        -- NAME.blender.json --serve

With --runs K, renders the seeds S .. S + K - 1 to OUT.S.exr and so on; their spread estimates the
noise. Prints one line of JSON per image: file, seed, spp, mean of R, G and B, seconds. The seconds
are those of Blender's render call, including synchronisation.

With --serve, renders whenever a line "MAX_DEPTH SPP SEED" arrives on standard input. It renders
without Russian roulette and keeps no image. It answers with a line of JSON: seconds of the render
call and processor seconds of all its threads.

The world is scaled to an extent of 1. Cycles compares the edges of an emissive triangle with a
distance over an area (triangle_light_sample), so its choice depends on the unit of length. In large
units it samples lamps by solid angles that are accurate to 1e-4 sr only, and distant lamps come out
up to 2 % too dark. Emissive triangles are split for the same reason.

Units. Emission nodes give radiance in W / (sr m^2). The strength of a sun is the irradiance of a
plane that faces it, in W / m^2. A point light of E watts whose shader emits 1 has an intensity of
E / (4 pi) W / sr. scripts/peers compares all of them with closed forms.
"""

import argparse
import json
import math
import pathlib
import sys
import time

try:
    import bpy
    import mathutils
except ImportError:
    print("cycles_driver: not running inside Blender; scripts/install --peers installs Blender",
          file=sys.stderr)
    sys.exit(77)
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import cycles_geometry  # noqa: E402
import cycles_shading  # noqa: E402
from cycles_shading import Graph, Value  # noqa: E402

WATTS_OF_UNIT_INTENSITY = 4 * math.pi
MOST_BOUNCES = 1024  # limit of Cycles
LONGEST_BRIGHT_EDGE = 0.05  # relative to the extent


class Images:
    """Images with linear floating-point texels; loads each file once."""

    def __init__(self, folder):
        self.folder, self.loaded = folder, {}

    def __call__(self, file):
        if file not in self.loaded:
            self.loaded[file] = self.as_numbers(bpy.data.images.load(str(self.folder / file)))
        return self.loaded[file]

    @staticmethod
    def as_numbers(image):
        image.colorspace_settings.name = "Non-Color"
        image.alpha_mode = "NONE"
        image.use_half_precision = False  # Cycles would round the texels to 16 bits
        return image


def link(name, data, matrix=None):
    made = bpy.data.objects.new(name, data)
    if matrix is not None:
        made.matrix_world = mathutils.Matrix(matrix)
    bpy.context.scene.collection.objects.link(made)
    return made


def scaled(matrix, scale):
    return [[*row[:3], row[3] * scale] for row in matrix[:3]] + [matrix[3]]


def add_mesh(name, surface, material, scale):
    mesh = bpy.data.meshes.new(name)
    count = len(surface.triangles)
    mesh.vertices.add(len(surface.positions))
    mesh.vertices.foreach_set(
        "co", numpy.ascontiguousarray(surface.positions * scale, numpy.float32).reshape(-1))
    mesh.loops.add(3 * count)
    corners = numpy.ascontiguousarray(surface.triangles, numpy.int32).reshape(-1)
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.add(count)
    mesh.polygons.foreach_set("loop_start", numpy.arange(0, 3 * count, 3, dtype=numpy.int32))
    mesh.polygons.foreach_set("loop_total", numpy.full(count, 3, numpy.int32))
    mesh.polygons.foreach_set("use_smooth", numpy.full(count, surface.normals is not None))
    if surface.uv is not None:
        uv = mesh.uv_layers.new(name="uv")
        uv.data.foreach_set(
            "uv", numpy.ascontiguousarray(surface.uv[corners], numpy.float32).reshape(-1))
    mesh.update(calc_edges=True)
    if surface.normals is not None:
        mesh.use_auto_smooth = True
        mesh.normals_split_custom_set_from_vertices(
            numpy.asarray(surface.normals, numpy.float32).tolist())
    mesh.materials.append(material)
    made = link(name, mesh)
    # These offsets bend shadows where smooth normals deviate from the triangles. No other renderer
    # in the comparison does that.
    made.cycles.shadow_terminator_offset = 0.0
    made.cycles.shadow_terminator_geometry_offset = 0.0


def add_geometry(scene, folder, images, scale):
    materials = {}

    def material_of(surface):
        key = (surface["material"], tuple(surface.get("radiance", ())))
        if key not in materials:
            entry = scene["materials"][surface["material"]]
            materials[key] = cycles_shading.make_material(
                entry, surface.get("radiance"), scene, images)
        return materials[key]

    for mesh in scene["meshes"]:
        surface = cycles_geometry.read_ply(folder / mesh["file"], mesh)
        if "radiance" in mesh:
            surface = cycles_geometry.split(surface, LONGEST_BRIGHT_EDGE / scale)
        add_mesh(mesh["name"], surface, material_of(mesh), scale)


def add_camera(scene, film, scale):
    wanted = scene["camera"]
    camera = bpy.data.cameras.new(wanted["name"])
    along_x = wanted["fov_axis"] == "x"
    camera.sensor_fit = "HORIZONTAL" if along_x else "VERTICAL"
    tangent = math.tan(wanted["fov"] / 2)
    # Lens and sensor are in millimetres, and only their ratio matters. An aperture larger than zero
    # determines the lens (f-number 1).
    aperture = wanted["aperture_radius"] * scale
    lens = 2000 * aperture if aperture > 0 else 50.0
    stop = 1.0
    while min(lens, 2 * lens * tangent) < 2:
        lens, stop = 2 * lens, 2 * stop
    camera.lens = lens
    setattr(camera, "sensor_width" if along_x else "sensor_height", 2 * lens * tangent)
    if aperture > 0:
        camera.dof.use_dof = True
        camera.dof.aperture_fstop = stop
        camera.dof.aperture_blades = 0
        camera.dof.aperture_ratio = 1.0
        camera.dof.focus_distance = wanted["focus_distance"] * scale
    camera.clip_start, camera.clip_end = 1e-5, 1e3  # wide enough to clip nothing
    film.camera = link(wanted["name"], camera, scaled(wanted["world_from_camera"], scale))


def add_light(light, scale):
    kind = light["kind"]
    lamp = bpy.data.lights.new(light["name"], "SUN" if kind == "directional" else "POINT")
    lamp.color = (1, 1, 1)
    lamp.use_nodes = True
    graph = Graph(lamp.node_tree, "ShaderNodeOutputLight")
    strength = Value(graph, 1.0)
    if kind == "directional":
        lamp.angle = 0.0
        lamp.energy = 1.0
    else:
        lamp.shadow_soft_size = 0.0
        lamp.energy = WATTS_OF_UNIT_INTENSITY * scale * scale  # distances are scaled, too
    if kind == "spot":
        # The falloff of RTRays is linear in the angle from the axis, -z. Blender's spot light has
        # another falloff, so a point light gets a shader.
        axis = [-row[2] for row in light["world_from_light"][:3]]
        # "Incoming" points from the shaded point, here the light, to the origin of the ray.
        cosine = graph.dot(graph.geometry("Incoming"), axis).at_most(1.0).at_least(-1.0)
        angle = cosine.call("ARCCOSINE")
        inner, outer = light["inner_angle"], light["outer_angle"]
        strength = ((outer - angle) / (outer - inner)).at_least(0.0).at_most(1.0)
    emission = graph.node("ShaderNodeEmission", {"Color": graph.vector(light["radiance"]),
                                                 "Strength": strength})
    graph.tree.links.new(emission.outputs[0], graph.output.inputs["Surface"])
    link(light["name"], lamp, scaled(light["world_from_light"], scale))


def wrapped(image):
    """Returns the image with its last column repeated before the first, and the first after the
    last. Cycles either interpolates without wrapping u or also wraps v across the poles."""
    width, height = image.size
    texels = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(texels)
    texels = texels.reshape(height, width, 4)
    wide = bpy.data.images.new(image.name + " wrapped", width + 2, height, float_buffer=True,
                               is_data=True)
    Images.as_numbers(wide)
    wide.pixels.foreach_set(
        numpy.concatenate([texels[:, -1:], texels, texels[:, :1]], 1).reshape(-1))
    wide.pack()
    return wide


def environment(graph, light, images):
    """Builds the radiance of an environment light as a function of direction, with the convention
    of renderer/scene/stores.h. Returns the three channels."""
    image = images(light["file"])
    direction = graph.node("ShaderNodeTexCoord").outputs["Generated"]
    x, y, z = (graph.dot(direction, [row[i] for row in light["world_from_light"][:3]])
               for i in range(3))
    u = (x.call("ARCTAN2", 0.0 - z) / (2 * math.pi)).call("FRACT")
    v = 1.0 - y.at_most(1.0).at_least(-1.0).call("ARCCOSINE") / math.pi
    width = image.size[0]
    coordinates = graph.vector([(u * float(width) + 1.0) / float(width + 2), v, 0.0])
    node = graph.node(
        "ShaderNodeTexImage", {"Vector": coordinates}, image=wrapped(image), interpolation="Linear",
        extension="EXTEND"
    )
    return [texel * factor for texel, factor in zip(
        graph.separated(node.outputs["Color"]), light["radiance"])]


def add_surroundings(lights, images, film):
    world = bpy.data.worlds.new("surroundings")
    film.world = world
    world.use_nodes = True
    graph = Graph(world.node_tree, "ShaderNodeOutputWorld")
    shaders = []
    for light in lights:
        colour = (environment(graph, light, images) if light["kind"] == "environment"
                  else light["radiance"])
        inputs = {"Color": graph.vector(colour), "Strength": 1.0}
        shaders.append(graph.node("ShaderNodeBackground", inputs).outputs[0])
        if light["kind"] == "environment":
            world.cycles.sampling_method = "MANUAL"
            world.cycles.sample_map_resolution = min(
                4096, max(512, 2 * images(light["file"]).size[0]))
    if shaders:
        graph.tree.links.new(graph.sum(shaders), graph.output.inputs["Surface"])


def set_up(scene, film, spp, max_depth):
    film.render.engine = "CYCLES"
    film.render.resolution_x, film.render.resolution_y = (
        scene["film"]["width"], scene["film"]["height"])
    film.render.resolution_percentage = 100
    film.render.use_compositing = film.render.use_sequencer = False
    film.render.film_transparent = False
    film.render.dither_intensity = 0.0
    film.view_settings.view_transform = "Raw"
    output = film.render.image_settings
    for stamp in [name for name in dir(film.render) if name.startswith("use_stamp")]:
        setattr(film.render, stamp, False)  # else the image contains dates and file names
    output.file_format, output.color_mode, output.color_depth, output.exr_codec = (
        "OPEN_EXR", "RGB", "32", "ZIP")
    cycles = film.cycles
    cycles.device = "CPU"
    cycles.samples = spp
    # The default of Blender 3.4, progressive multi-jittered points, is biased where many triangles
    # emit. With three lamps of 16,000 triangles each and 256 samples, one lamp came out 2.6 % too
    # dark for every seed.
    cycles.sampling_pattern = "SOBOL"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.time_limit = 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.film_exposure = 1.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_fast_gi = False
    cycles.min_transparent_bounces = 0
    set_depth(cycles, max_depth, roulette=True)
    cycles.volume_bounces = 0
    cycles.transparent_max_bounces = MOST_BOUNCES


def set_depth(cycles, max_depth, roulette):
    bounces = MOST_BOUNCES if max_depth == 0 else min(max_depth - 1, MOST_BOUNCES)
    for kind in ("max", "diffuse", "glossy", "transmission"):
        setattr(cycles, kind + "_bounces", bounces)
    cycles.min_light_bounces = 0 if roulette else bounces


def mean_of(file):
    """Returns the means of R, G and B."""
    image = Images.as_numbers(bpy.data.images.load(str(file)))
    texels = numpy.empty(4 * image.size[0] * image.size[1], numpy.float32)
    image.pixels.foreach_get(texels)
    bpy.data.images.remove(image)
    return texels.reshape(-1, 4).mean(0, numpy.float64)[:3].tolist()


def serve(film):
    film.render.use_persistent_data = True
    print(json.dumps({"engine": "Cycles of Blender " + bpy.app.version_string}), flush=True)
    for line in sys.stdin:
        depth, film.cycles.samples, film.cycles.seed = map(int, line.split())
        set_depth(film.cycles, depth, roulette=False)
        film.update_tag()  # else persistent data keep the first render's settings
        start, processor = time.perf_counter(), time.process_time()
        bpy.ops.render.render()
        print(json.dumps({"seconds": time.perf_counter() - start,
                          "processor_seconds": time.process_time() - processor}), flush=True)


def main(arguments):
    parser = argparse.ArgumentParser(prog="cycles_driver", description=__doc__.split("\n\n")[0])
    parser.add_argument("description", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path, nargs="?")
    parser.add_argument("--serve", action="store_true")
    parser.add_argument("--spp", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--max-depth", type=int)
    parser.add_argument("--runs", type=int)
    options = parser.parse_args(arguments)
    if not options.serve and options.output is None:
        parser.error("expected OUT.exr or --serve")
    scene = json.loads(options.description.read_text())
    if scene.get("format") != "rtrays scene for Blender" or scene.get("version") != 1:
        raise ValueError(f"{options.description}: not a scene for this driver; write one with "
                         "`rtrays-render --export`")

    bpy.ops.wm.read_factory_settings(use_empty=True)
    film = bpy.context.scene
    spp = options.spp or scene["samples_per_pixel"]
    set_up(scene, film, spp, scene["max_depth"] if options.max_depth is None else options.max_depth)
    images = Images(options.description.resolve().parent)
    scale = 1 / scene["camera"]["extent"]
    add_geometry(scene, options.description.resolve().parent, images, scale)
    add_camera(scene, film, scale)
    around = [light for light in scene["lights"] if light["kind"] in ("dome", "environment")]
    add_surroundings(around, images, film)
    for light in scene["lights"]:
        if light not in around:
            add_light(light, scale)

    if options.serve:
        serve(film)
        return
    film.render.use_persistent_data = True  # avoids a rebuild of the scene for further runs
    for run in range(options.runs or 1):
        seed = options.seed + run
        film.cycles.seed = seed
        film.update_tag()  # else persistent data keep the first render's settings
        output = options.output.resolve()
        if options.runs is not None:
            output = output.with_suffix(f".{seed}.exr")
        part = output.with_name(output.name + ".part")  # renamed when complete
        film.render.filepath = str(part)
        film.render.use_file_extension = False
        start = time.perf_counter()
        bpy.ops.render.render(write_still=True)
        part.replace(output)
        record = {"file": str(output), "seed": seed, "spp": spp,
                  "seconds": time.perf_counter() - start}
        record["mean"] = mean_of(output)
        print(json.dumps({**record, "engine": "Cycles of Blender " + bpy.app.version_string}),
              flush=True)


if __name__ == "__main__":
    try:
        main(sys.argv[sys.argv.index("--") + 1:])
    except (OSError, ValueError) as error:
        print(f"cycles_driver: {error}", file=sys.stderr)
        sys.exit(2)
