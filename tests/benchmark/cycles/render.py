# SPDX-License-Identifier: Apache-2.0
"""Renders a glTF file with Blender's Cycles as exactly as Cycles can do what Wellspring does.

    blender -b --factory-startup -P render.py -- JOB.json

Runs inside Blender 3.4 (its glTF importer needs python3-numpy). The job names the file, camera,
size, threads, bounces and renders; each render is one sample count and one seed into one EXR. What
is set by hand after the import, because the importer leaves it to taste:
  lights      no radius; intensity one to one (1 cd is 1 W/sr, 1 lux is 1 W/m2); spots fall off as
              KHR_lights_punctual says, by nodes, instead of Blender's smooth step
  materials   Lambert's law by a Diffuse BSDF, emission from fronts alone where they are
              single-sided; thin glass as Fresnel's share of a mirror image over a transparent rest;
              bare metal by a Glossy BSDF (GGX, several meetings) of Schlick's colour, at the cosine
              of the surface instead of each facet
  pixels      box filter one pixel wide, no denoiser, no clamping, no adaptive sampling
Times are wall seconds and processor seconds of a render with what was built before it (BVH,
textures) kept, without the file's writing; the file JOB.json + ".times" receives a pair for each,
in order.
"""
import json
import math
import sys
import time

import bpy
import numpy
from mathutils import Matrix, Vector

if not hasattr(numpy, "bool"):  # the importer of 3.4 still asks for a name that numpy dropped
    numpy.bool = bool

POINT_WATTS = 4 * math.pi * math.pi  # of a Blender point light, for each W/sr that it sends out


def to_blender(v):
    """glTF is +Y up, Blender +Z up."""
    return Vector((v[0], -v[2], v[1]))


def gltf_of(path):
    data = open(path, "rb").read()
    if data[:4] == b"glTF":
        length = int.from_bytes(data[12:16], "little")
        return json.loads(data[20:20 + length])
    return json.loads(data)


class Nodes:
    """A node tree written line by line."""

    def __init__(self, owner):
        owner.use_nodes = True
        self.tree = owner.node_tree

    def add(self, kind, inputs=None, **settings):
        node = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[name])
            else:
                node.inputs[name].default_value = value
        return node

    def math(self, operation, a, b=0.0):
        return self.add("ShaderNodeMath", {0: a, 1: b}, operation=operation).outputs[0]


def source_of(tree, socket):
    """What feeds a socket: a link's other end, or its own value."""
    return socket.links[0].from_socket if socket.is_linked else socket.default_value


def metal_color(nodes, color):
    """Schlick's approximation: white towards grazing."""
    place = nodes.add("ShaderNodeNewGeometry").outputs
    product = nodes.add("ShaderNodeVectorMath", operation="DOT_PRODUCT")
    nodes.tree.links.new(place["Normal"], product.inputs[0])
    nodes.tree.links.new(place["Incoming"], product.inputs[1])
    cosine = nodes.math("MINIMUM", nodes.math("ABSOLUTE", product.outputs["Value"]), 1.0)
    share = nodes.math("POWER", nodes.math("SUBTRACT", 1.0, cosine), 5.0)
    return nodes.add("ShaderNodeMixRGB",
                     {"Fac": share, "Color1": color, "Color2": (1, 1, 1, 1)}).outputs[0]


def make_shared(material, source):
    """Replaces the importer's Principled BSDF."""
    nodes = Nodes(material)
    tree = nodes.tree
    principled = next((n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"), None)
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    if principled is None:
        return
    color = source_of(tree, principled.inputs["Base Color"])
    emission = source_of(tree, principled.inputs["Emission"])
    strength = source_of(tree, principled.inputs["Emission Strength"])
    extensions = source.get("extensions", {})
    transmission = extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0)
    index = extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
    metallic = source.get("pbrMetallicRoughness", {}).get("metallicFactor", 1)
    roughness = source.get("pbrMetallicRoughness", {}).get("roughnessFactor", 1)
    back = nodes.add("ShaderNodeNewGeometry").outputs["Backfacing"]
    if transmission > 0:
        through = nodes.add("ShaderNodeBsdfTransparent", {"Color": color}).outputs[0]
        mirror = nodes.add("ShaderNodeBsdfGlossy", {"Color": (1, 1, 1, 1), "Roughness": 0.0})
        # The node takes a back for the inside of a solid.
        beyond = nodes.math("ADD", index, nodes.math("MULTIPLY", back, 1 / index - index))
        share = nodes.add("ShaderNodeFresnel", {"IOR": beyond}).outputs[0]
        surface = nodes.add("ShaderNodeMixShader",
                            {0: share, 1: through, 2: mirror.outputs[0]}).outputs[0]
        if index == 1:
            surface = through
    elif metallic == 1:
        surface = nodes.add("ShaderNodeBsdfGlossy",
                            {"Color": metal_color(nodes, color), "Roughness": roughness},
                            distribution="MULTI_GGX")
        surface = surface.outputs[0]
    else:
        surface = nodes.add("ShaderNodeBsdfDiffuse", {"Color": color}).outputs[0]
    if any(source.get("emissiveFactor", [0])):
        if not source.get("doubleSided", False):
            strength = nodes.math("MULTIPLY", strength, nodes.math("SUBTRACT", 1.0, back))
        glow = nodes.add("ShaderNodeEmission", {"Color": emission, "Strength": strength}).outputs[0]
        surface = nodes.add("ShaderNodeAddShader", {0: surface, 1: glow}).outputs[0]
    tree.links.new(surface, output.inputs["Surface"])
    tree.nodes.remove(principled)


def make_light(light, source):
    """KHR_lights_punctual, as the specification has it."""
    intensity, kind = source.get("intensity", 1), source["type"]
    light.color = source.get("color", [1, 1, 1])
    if kind == "directional":
        light.energy = intensity
        light.angle = 0
        return
    light.type = "POINT"
    light = bpy.data.lights[light.name]
    light.shadow_soft_size = 0
    light.energy = intensity * POINT_WATTS / math.pi
    if kind != "spot":
        return
    cone = source.get("spot", {})
    inner = math.cos(cone.get("innerConeAngle", 0))
    outer = math.cos(cone.get("outerConeAngle", math.pi / 4))
    nodes = Nodes(light)
    nodes.tree.nodes.clear()
    # Where the light goes, in its own frame; it points along -Z.
    direction = nodes.add("ShaderNodeTexCoord").outputs["Normal"]
    z = nodes.add("ShaderNodeSeparateXYZ", {0: direction}).outputs["Z"]
    cosine = nodes.math("MULTIPLY", z, -1.0)
    share = nodes.math("MULTIPLY", nodes.math("SUBTRACT", cosine, outer),
                       1 / max(0.001, inner - outer))
    share = nodes.math("MINIMUM", nodes.math("MAXIMUM", share, 0.0), 1.0)
    glow = nodes.add("ShaderNodeEmission", {"Strength": nodes.math("MULTIPLY", share, share)})
    output = nodes.add("ShaderNodeOutputLight")
    nodes.tree.links.new(glow.outputs[0], output.inputs[0])


def load(job):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.import_scene.gltf(filepath=job["file"], import_shading="NORMALS")
    for thing in bpy.data.objects:  # normals between vertices as they are
        thing.cycles.shadow_terminator_offset = 0
        thing.cycles.shadow_terminator_geometry_offset = 0
    gltf = gltf_of(job["file"])
    by_name = {m.get("name"): m for m in gltf.get("materials", [])}
    for material in bpy.data.materials:
        if material.use_nodes:
            make_shared(material, by_name.get(material.name, {}))
    lights = gltf.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])
    by_name = {light.get("name"): light for light in lights}
    for light in list(bpy.data.lights):
        if light.name in by_name:
            make_light(light, by_name[light.name])


def set_camera(scene, camera, size):
    data = bpy.data.cameras.new("camera")
    thing = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(thing)
    scene.camera = thing
    forward, up = to_blender(camera["forward"]), to_blender(camera["up"])
    right = forward.cross(up)
    axes = Matrix((right, up, -forward)).transposed().to_4x4()
    thing.matrix_world = Matrix.Translation(to_blender(camera["position"])) @ axes
    data.sensor_fit = "VERTICAL"
    data.angle_y = camera["fov"]
    data.clip_start, data.clip_end = 1e-4, 1e4
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.pixel_aspect_x = scene.render.pixel_aspect_y = 1


def set_rules(scene, job):
    scene.render.engine = "CYCLES"
    scene.render.threads_mode = "FIXED"
    scene.render.threads = job["threads"]
    scene.render.use_persistent_data = True
    scene.render.dither_intensity = 0
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.film_transparent = False
    cycles = scene.cycles
    cycles.device = "CPU"
    bounces = job["max_depth"] - 2  # Cycles counts reflections, Wellspring edges from the eye
    for name in ("max_bounces", "diffuse_bounces", "glossy_bounces", "transmission_bounces"):
        setattr(cycles, name, bounces)
    cycles.transparent_max_bounces = 64
    cycles.min_light_bounces = cycles.min_transparent_bounces = 0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 0
    cycles.pixel_filter_type = "BOX"
    cycles.film_exposure = 1
    cycles.use_auto_tile = False
    world = bpy.data.worlds.new("dark")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
    scene.world = world


def main():
    path = sys.argv[sys.argv.index("--") + 1]
    job = json.load(open(path))
    scene = bpy.context.scene
    load(job)
    set_camera(scene, job["camera"], job["size"])
    set_rules(scene, job)
    times = []
    scene.cycles.samples, scene.cycles.seed = 1, 0
    bpy.ops.render.render()  # builds what the others keep
    for render in job["renders"]:
        scene.cycles.samples, scene.cycles.seed = render["samples"], render["seed"]
        scene.update_tag()
        bpy.context.view_layer.update()
        began, began_processor = time.time(), time.process_time()
        bpy.ops.render.render()
        times.append([time.time() - began, time.process_time() - began_processor])
        bpy.data.images["Render Result"].save_render(render["out"], scene=scene)
    with open(path + ".times", "w") as out:
        json.dump(times, out)


main()
