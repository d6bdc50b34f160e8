# SPDX-License-Identifier: MIT
"""Images, and the lights that surround a scene, in Blender. Runs inside Blender."""

import math

import bpy
import numpy

from rtrays.peers.cycles_nodes import Graph


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


def wrapped(image):
    """Returns the image with its last column repeated before the first, and the first after the
    last. Cycles either interpolates without wrapping u or also wraps v across the poles."""
    width, height = image.size
    texels = numpy.empty(width * height * 4, numpy.float32)
    image.pixels.foreach_get(texels)
    texels = texels.reshape(height, width, 4)
    wide = bpy.data.images.new(
        image.name + " wrapped", width + 2, height, float_buffer=True, is_data=True
    )
    Images.as_numbers(wide)
    wide.pixels.foreach_set(
        numpy.concatenate([texels[:, -1:], texels, texels[:, :1]], 1).reshape(-1)
    )
    wide.pack()
    return wide


def environment(graph, light, images):
    """Builds the radiance of an environment light as a function of direction, with the convention
    of renderer/scene/stores.h. Returns the three channels."""
    image = images(light["file"])
    direction = graph.node("ShaderNodeTexCoord").outputs["Generated"]
    x, y, z = (
        graph.dot(direction, [row[i] for row in light["world_from_light"][:3]]) for i in range(3)
    )
    u = (x.call("ARCTAN2", 0.0 - z) / (2 * math.pi)).call("FRACT")
    v = 1.0 - y.at_most(1.0).at_least(-1.0).call("ARCCOSINE") / math.pi
    width = image.size[0]
    coordinates = graph.vector([(u * float(width) + 1.0) / float(width + 2), v, 0.0])
    node = graph.node(
        "ShaderNodeTexImage",
        {"Vector": coordinates},
        image=wrapped(image),
        interpolation="Linear",
        extension="EXTEND",
    )
    return [
        texel * factor
        for texel, factor in zip(graph.separated(node.outputs["Color"]), light["radiance"])
    ]


def add_surroundings(lights, images, film):
    """Adds the dome and environment lights as the world of the scene."""
    world = bpy.data.worlds.new("surroundings")
    film.world = world
    world.use_nodes = True
    graph = Graph(world.node_tree, "ShaderNodeOutputWorld")
    shaders = []
    for light in lights:
        colour = (
            environment(graph, light, images)
            if light["kind"] == "environment"
            else light["radiance"]
        )
        inputs = {"Color": graph.vector(colour), "Strength": 1.0}
        shaders.append(graph.node("ShaderNodeBackground", inputs).outputs[0])
        if light["kind"] == "environment":
            world.cycles.sampling_method = "MANUAL"
            world.cycles.sample_map_resolution = min(
                4096, max(512, 2 * images(light["file"]).size[0])
            )
    if shaders:
        graph.tree.links.new(graph.sum(shaders), graph.output.inputs["Surface"])


def means_of(file):
    """Returns the means of R, G and B of an image file."""
    image = Images.as_numbers(bpy.data.images.load(str(file)))
    texels = numpy.empty(4 * image.size[0] * image.size[1], numpy.float32)
    image.pixels.foreach_get(texels)
    bpy.data.images.remove(image)
    return texels.reshape(-1, 4).mean(0, numpy.float64)[:3].tolist()
