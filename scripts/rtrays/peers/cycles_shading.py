# SPDX-License-Identifier: MIT
"""Builds Blender materials with their textures. Runs inside Blender."""

import math

import bpy

from rtrays.peers.cycles_nodes import Graph, Value


def _conductor(c, eta, k):
    """Exact Fresnel reflectance of a conductor in real arithmetic (Born and Wolf, section 13.4);
    s is the squared sine."""
    s = 1.0 - c * c
    difference = (eta * eta - k * k) - s
    ab = (difference * difference + 4 * eta * eta * k * k).sqrt()  # a^2 + b^2
    a = ((ab + difference) * 0.5).at_least(0.0).sqrt()
    sum_s, twice_ac = ab + c * c, a * c * 2.0
    perpendicular = (sum_s - twice_ac) / (sum_s + twice_ac)
    sum_p, twice_acs = c * c * ab + s * s, twice_ac * s
    return 0.5 * perpendicular * (1.0 + (sum_p - twice_acs) / (sum_p + twice_acs))


def _conductor_approximate(c, eta, k):
    """Approximate Fresnel reflectance of a conductor, thesis (3.28)."""
    both, cross, square = eta * eta + k * k, 2 * eta * c, c * c
    parallel = (both * square - cross + 1.0) / (both * square + cross + 1.0)
    perpendicular = (both - cross + square) / (both + cross + square)
    return 0.5 * (parallel + perpendicular)


def _schlick(c, at_normal, _):
    """Schlick's approximation of Fresnel reflectance."""
    m = 1.0 - c
    return at_normal + (1 - at_normal) * (m * m * m * m * m)


def _fresnel(graph, component, is_boundary):
    """Returns the Fresnel term per channel. If `is_boundary`, the relative index of refraction is
    1 / eta from behind."""
    kind = component["fresnel"]
    if kind == "ideal":
        return [1.0] * 3
    if kind == "dielectric":
        eta = component["eta"][0]
        if not is_boundary:  # cancels the node's inversion from behind
            eta = graph.backfacing() * (1 / eta - eta) + eta
        values = [Value(graph, graph.node("ShaderNodeFresnel", {"IOR": eta}).outputs[0])] * 3
    else:
        function = {
            "conductor": _conductor,
            "conductor_approximate": _conductor_approximate,
            "schlick": _schlick,
        }[kind]
        cosine = graph.cosine()
        values = [function(cosine, eta, k) for eta, k in zip(component["eta"], component["k"])]
    return [1.0 - value for value in values] if component["complement"] else values


def _texture(graph, texture, images):
    """Returns the channels of a texture at the texture coordinates."""
    coordinates = graph.separated(graph.node("ShaderNodeTexCoord").outputs["UV"])
    moved = [
        x * scale + offset
        for x, scale, offset in zip(coordinates, texture["uv_scale"], texture["uv_offset"])
    ]
    node = graph.node(
        "ShaderNodeTexImage",
        {"Vector": graph.vector(moved + [0.0])},
        image=images(texture["file"]),
        interpolation={"nearest": "Closest", "bilinear": "Linear"}[texture["filter"]],
        extension={"repeat": "REPEAT", "clamp": "EXTEND"}[texture["wrap"]],
    )
    return graph.separated(node.outputs["Color"])


def _luminance(graph, texture, images):
    """Returns the luminance (Rec. 709) of a texture."""
    red, green, blue = _texture(graph, texture, images)
    return red * 0.2126 + green * 0.7152 + blue * 0.0722


def _roughness(graph, component, scene, images):
    """Returns the roughness of a glossy closure, of which Cycles takes the square as alpha."""
    if "roughness_texture" not in component:
        return math.sqrt(component["alpha"])
    factor = _luminance(graph, scene["textures"][component["roughness_texture"]], images)
    if component["roughness_squared"]:
        factor = factor * factor
    return (factor * component["alpha"]).sqrt()


def _opacity(graph, opacity, scene, images):
    """Returns the share of light that the surface stops."""
    value = Value(graph, opacity["value"])
    if "texture" in opacity:
        texture = scene["textures"][opacity["texture"]]
        value = value * _luminance(graph, texture, images)
    if opacity["cutoff"] > 0:
        if isinstance(value.source, (int, float)):
            return Value(graph, float(value.source >= opacity["cutoff"]))
        return 1.0 - value.call("LESS_THAN", opacity["cutoff"])
    return value


def _closure(graph, component, is_boundary, scene, images):
    """Returns the closure of one BSDF component."""
    colour = [
        weight * value
        for weight, value in zip(component["weight"], _fresnel(graph, component, is_boundary))
    ]
    if "texture" in component:
        texels = _texture(graph, scene["textures"][component["texture"]], images)
        colour = [texel * value for texel, value in zip(texels, colour)]
    kind, eta = component["kind"], component["eta"][0]
    if kind == "ideal_refraction":
        # Cycles does not scale radiance at a change of the refractive index: (1 / eta)^2 on
        # entering, eta^2 on leaving.
        scale = graph.backfacing() * (eta * eta - 1 / (eta * eta)) + 1 / (eta * eta)
        colour = [scale * value for value in colour]
    inputs, properties = {"Color": graph.vector(colour), "Roughness": 0.0}, {}
    if kind == "lambert":
        shader = "ShaderNodeBsdfDiffuse"
    elif kind == "ideal_reflection":
        shader, properties = "ShaderNodeBsdfGlossy", {"distribution": "SHARP"}
    elif kind == "microfacet_reflection":
        shader, properties = "ShaderNodeBsdfGlossy", {
            "distribution": component["distribution"].upper()
        }
        inputs["Roughness"] = _roughness(graph, component, scene, images)
    elif kind == "ideal_refraction":
        shader, properties = "ShaderNodeBsdfRefraction", {"distribution": "SHARP"}
        inputs["IOR"] = eta
    else:
        raise ValueError(f"component '{kind}': Cycles has no such BSDF")
    return graph.node(shader, inputs, **properties).outputs[0]


def make_material(material, radiance, scene, images):
    """Builds a material of the scene description. `radiance` is the emission of its front side in
    W / (sr m^2), or None."""
    made = bpy.data.materials.new(material["name"])
    made.use_nodes = True
    graph = Graph(made.node_tree, "ShaderNodeOutputMaterial")
    components = [component for component in material["components"] if any(component["weight"])]
    is_boundary = any(
        component["kind"] == "ideal_refraction" for component in material["components"]
    )
    shader = None
    if components:
        shader = graph.sum(
            [_closure(graph, component, is_boundary, scene, images) for component in components]
        )
        if not material["two_sided"] and not is_boundary:
            shader = graph.node("ShaderNodeMixShader", [graph.backfacing(), shader, None]).outputs[
                0
            ]
    if radiance is not None:
        front = 1.0 - graph.backfacing()
        channels = [front * value for value in radiance]
        if "emission_texture" in material:
            texture = scene["textures"][material["emission_texture"]]
            texels = _texture(graph, texture, images)
            channels = [channel * texel for channel, texel in zip(channels, texels)]
        colour = graph.vector(channels)
        emission = graph.node("ShaderNodeEmission", {"Color": colour, "Strength": 1.0}).outputs[0]
        shader = emission if shader is None else graph.sum([shader, emission])
    if "opacity" in material:
        share = _opacity(graph, material["opacity"], scene, images)
        passing = graph.node("ShaderNodeBsdfTransparent").outputs[0]
        shader = graph.node("ShaderNodeMixShader", [share, passing, shader]).outputs[0]
    if shader is not None:
        graph.tree.links.new(shader, graph.output.inputs["Surface"])
    return made
