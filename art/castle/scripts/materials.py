# SPDX-License-Identifier: Apache-2.0
"""The materials of the castle: one table, made into Blender materials the glTF exporter
understands.

Radiance and panes are written into the finished file by export.py from the same table.
"""
import os
from dataclasses import dataclass

import bpy
import numpy as np


@dataclass
class Material:
    name: str
    colour: tuple = (0.8, 0.8, 0.8)    # linear, used where there is no picture
    metallic: float = 0.0
    roughness: float = 0.6
    picture: str = ''                  # name of a base colour picture
    normal: str = ''
    normal_scale: float = 1.0
    packed: str = ''                   # metallic (B) and roughness (G)
    emission: tuple = None             # radiance, linear
    glow: str = ''                     # picture that `emission` multiplies
    pane: float = 0.0                  # thin-walled and clear: the index of refraction
    double_sided: bool = False


def srgb(code):
    """Linear colour of a six-digit sRGB code."""
    values = np.array([int(code[i:i + 2], 16) / 255 for i in (0, 2, 4)])
    return tuple(np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4))


M = Material
TABLE = [
    # Building
    M('plaster', picture='plaster', normal='plaster_normal', normal_scale=0.35, roughness=0.92),
    M('ashlar', picture='ashlar', normal='ashlar_normal', normal_scale=0.7, roughness=0.85),
    M('stone', picture='smooth_stone', roughness=0.75),
    M('floor', picture='floor', packed='floor_packed'),
    M('floor border', colour=srgb('4a4f4b'), roughness=0.16),
    M('oak', picture='oak', normal='oak_normal', normal_scale=0.6, packed='oak_packed'),
    M('dark oak', picture='dark_oak', normal='oak_normal', normal_scale=0.5, packed='oak_packed'),
    M('lead', colour=(0.05, 0.052, 0.056), metallic=0.2, roughness=0.5),
    M('cobbles', picture='cobbles', normal='cobbles_normal', roughness=0.8),
    M('shingles', picture='shingles', normal='shingles_normal', roughness=0.85),
    M('roof tiles', picture='roof_tiles', roughness=0.85),
    M('lime wall', colour=srgb('cfc3aa'), roughness=0.95),
    M('leaves', colour=srgb('46602c'), roughness=0.7, double_sided=True),
    M('rose', colour=srgb('a8323c'), roughness=0.6, double_sided=True),
    M('soot', colour=(0.035, 0.03, 0.027), roughness=0.95),
    M('water', colour=(0.02, 0.035, 0.035), roughness=0.03),
    # Metals
    M('gold', colour=(1.0, 0.73, 0.32), metallic=1.0, roughness=0.20),
    M('gilt', picture='gilt', metallic=1.0, roughness=0.33),
    M('brass', colour=(0.80, 0.58, 0.28), metallic=1.0, roughness=0.30),
    M('silver', colour=(0.93, 0.92, 0.89), metallic=1.0, roughness=0.20),
    M('steel', colour=(0.58, 0.58, 0.585), metallic=1.0, roughness=0.26),
    M('dark steel', colour=(0.30, 0.30, 0.31), metallic=1.0, roughness=0.32),
    M('iron', colour=(0.055, 0.052, 0.05), metallic=0.6, roughness=0.5),
    M('bronze', picture='bronze', packed='bronze_packed'),
    # Cloth, leather and paper
    M('red velvet', colour=srgb('7d1220'), roughness=0.9),
    M('blue velvet', colour=srgb('1c2a58'), roughness=0.9),
    M('green velvet', colour=srgb('24402f'), roughness=0.9),
    M('leather', colour=srgb('4b2617'), roughness=0.5),
    M('book page', picture='book_page', roughness=0.9),
    M('paper', colour=srgb('dcd0b2'), roughness=0.9),
    M('rug', picture='rug', roughness=0.97),
    M('fringe', colour=srgb('cdbd96'), roughness=0.95),
    M('tapestry stag', picture='tapestry_stag', normal='weave_normal', normal_scale=0.5,
      roughness=0.97),
    M('tapestry eagle', picture='tapestry_eagle', normal='weave_normal', normal_scale=0.5,
      roughness=0.97),
    # Museum
    M('glass', colour=(1.0, 1.0, 1.0), roughness=0.0, pane=1.5, double_sided=True),
    M('plinth', colour=srgb('2b2a2c'), roughness=0.38),
    M('label', picture='label', roughness=0.7),
    M('marble', picture='white_marble', roughness=0.28),
    M('rope', colour=srgb('6e1420'), roughness=0.85),
    M('jug', picture='jug', roughness=0.12),
    M('fossil', picture='fossil', roughness=0.55),
    M('ruby', colour=(0.42, 0.006, 0.02), roughness=0.05),
    M('sapphire', colour=(0.01, 0.04, 0.36), roughness=0.05),
    M('emerald', colour=(0.006, 0.20, 0.07), roughness=0.05),
    M('pearl', colour=(0.85, 0.80, 0.74), roughness=0.2),
    # Light
    # A pane that glows and lets the sun through (refractive index 1: it mirrors nothing).
    M('sky', colour=(1.0, 1.0, 1.0), roughness=0.0, emission=(14.0, 14.0, 14.0), glow='sky',
      pane=1.0),
    M('far sky', picture='sky', roughness=1.0),
    M('bulb', colour=(0.0, 0.0, 0.0), roughness=1.0, emission=(10.0, 6.4, 3.2)),
    M('ember', colour=(0.02, 0.01, 0.01), roughness=1.0, emission=(2.4, 0.72, 0.15)),
]
PICTURES = ['castle', 'river', 'lady', 'nobleman', 'still_life', 'arms', 'moonlight', 'forest',
            'captain', 'winter']
TABLE += [M('picture ' + name, picture='picture_' + name, roughness=0.42) for name in PICTURES]
BY_NAME = {material.name: material for material in TABLE}


def store_picture(name, pixels, folder, data=False, quality=88):
    """Writes a JPEG and opens it as a Blender image. `data`: not a colour."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=False)
    rgba = np.ones((height, width, 4), np.float32)
    rgba[..., :3] = np.clip(pixels[::-1], 0, 1)
    image.pixels.foreach_set(rgba.ravel())
    path = os.path.join(folder, name + '.jpg')
    settings = bpy.context.scene.render.image_settings
    settings.file_format, settings.quality, settings.color_mode = 'JPEG', quality, 'RGB'
    bpy.context.scene.view_settings.view_transform = 'Standard'
    image.save_render(path)
    bpy.data.images.remove(image)
    image = bpy.data.images.load(path)
    image.name = name
    image.colorspace_settings.name = 'Non-Color' if data else 'sRGB'
    return image


def make_material(spec, images):
    material = bpy.data.materials.new(spec.name)
    material.use_nodes = True
    material.use_backface_culling = not spec.double_sided
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes['Principled BSDF']
    values = shader.inputs
    values['Base Color'].default_value = (*spec.colour, 1.0)
    values['Metallic'].default_value = spec.metallic
    values['Roughness'].default_value = spec.roughness

    def picture(name):
        node = nodes.new('ShaderNodeTexImage')
        node.image = images[name]
        return node

    if spec.picture:
        links.new(picture(spec.picture).outputs['Color'], values['Base Color'])
    if spec.normal:
        node = nodes.new('ShaderNodeNormalMap')
        node.inputs['Strength'].default_value = spec.normal_scale
        links.new(picture(spec.normal).outputs['Color'], node.inputs['Color'])
        links.new(node.outputs['Normal'], values['Normal'])
    if spec.packed:
        node = nodes.new('ShaderNodeSeparateColor')
        links.new(picture(spec.packed).outputs['Color'], node.inputs['Color'])
        links.new(node.outputs['Green'], values['Roughness'])
        links.new(node.outputs['Blue'], values['Metallic'])
    if spec.emission:
        peak = max(spec.emission)
        values['Emission'].default_value = (*(c / peak for c in spec.emission), 1.0)
        values['Emission Strength'].default_value = peak
        if spec.glow:
            links.new(picture(spec.glow).outputs['Color'], values['Emission'])
    if spec.pane:
        values['Transmission'].default_value = 1.0
        values['IOR'].default_value = spec.pane
    return material
