# SPDX-License-Identifier: MIT
"""Builds the meshes, the camera and the lights of a scene in Blender. Runs inside Blender."""

import math

import bpy
import mathutils
import numpy

from rtrays.peers import cycles_geometry, cycles_shading
from rtrays.peers.cycles_nodes import Graph, Value

WATTS_OF_UNIT_INTENSITY = 4 * math.pi
LONGEST_BRIGHT_EDGE = 0.05  # relative to the extent


def link(name, data, matrix=None):
    """Adds an object to the scene of Blender; returns it."""
    made = bpy.data.objects.new(name, data)
    if matrix is not None:
        made.matrix_world = mathutils.Matrix(matrix)
    bpy.context.scene.collection.objects.link(made)
    return made


def scaled(matrix, scale):
    """Returns a transform with its translation scaled."""
    return [[*row[:3], row[3] * scale] for row in matrix[:3]] + [matrix[3]]


def add_mesh(name, surface, material, scale):
    """Adds a triangle mesh with its normals and texture coordinates."""
    mesh = bpy.data.meshes.new(name)
    count = len(surface.triangles)
    mesh.vertices.add(len(surface.positions))
    mesh.vertices.foreach_set(
        "co", numpy.ascontiguousarray(surface.positions * scale, numpy.float32).reshape(-1)
    )
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
            "uv", numpy.ascontiguousarray(surface.uv[corners], numpy.float32).reshape(-1)
        )
    mesh.update(calc_edges=True)
    if surface.normals is not None:
        mesh.use_auto_smooth = True
        mesh.normals_split_custom_set_from_vertices(
            numpy.asarray(surface.normals, numpy.float32).tolist()
        )
    mesh.materials.append(material)
    made = link(name, mesh)
    # These offsets bend shadows where smooth normals deviate from the triangles. No other renderer
    # in the comparison does that.
    made.cycles.shadow_terminator_offset = 0.0
    made.cycles.shadow_terminator_geometry_offset = 0.0


def add_geometry(scene, folder, images, scale):
    """Adds all meshes of a scene description, with their materials."""
    materials = {}

    def material_of(surface):
        key = (surface["material"], tuple(surface.get("radiance", ())))
        if key not in materials:
            entry = scene["materials"][surface["material"]]
            materials[key] = cycles_shading.make_material(
                entry, surface.get("radiance"), scene, images
            )
        return materials[key]

    for mesh in scene["meshes"]:
        surface = cycles_geometry.read_ply(folder / mesh["file"], mesh)
        if "radiance" in mesh:
            surface = cycles_geometry.split(surface, LONGEST_BRIGHT_EDGE / scale)
        add_mesh(mesh["name"], surface, material_of(mesh), scale)


def add_camera(scene, film, scale):
    """Adds the camera."""
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
    """Adds a point, spot or directional light."""
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
    emission = graph.node(
        "ShaderNodeEmission", {"Color": graph.vector(light["radiance"]), "Strength": strength}
    )
    graph.tree.links.new(emission.outputs[0], graph.output.inputs["Surface"])
    link(light["name"], lamp, scaled(light["world_from_light"], scale))
