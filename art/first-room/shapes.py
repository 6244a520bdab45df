# SPDX-License-Identifier: Apache-2.0
"""Materials and shapes for Blender: boxes, turned profiles, bars, lights, movements. Metres."""
import math
import os
import random

import bpy
import numpy as np
from mathutils import Matrix, Vector

dice = random.Random(7)
materials = {}


def material(name, colour=(0.8, 0.8, 0.8), roughness=0.7, metallic=0.0, picture=None, bumps=None,
             glow=0.0, is_pane=False):
    """`picture` and `bumps` (a normal map) are names of pictures; `glow` is radiance."""
    made = materials[name] = bpy.data.materials.new(name)
    made.use_nodes = True
    made.use_backface_culling = not is_pane
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes['Principled BSDF']
    sockets = {socket.name: socket for socket in shader.inputs}
    sockets['Base Color'].default_value = (*colour, 1)
    sockets['Roughness'].default_value = roughness
    sockets['Metallic'].default_value = metallic
    emission = sockets.get('Emission') or sockets['Emission Color']
    if picture:
        image = nodes.new('ShaderNodeTexImage')
        image.image = bpy.data.images[picture]
        links.new(image.outputs['Color'], emission if glow else sockets['Base Color'])
    if bumps:
        image, normal = nodes.new('ShaderNodeTexImage'), nodes.new('ShaderNodeNormalMap')
        image.image = bpy.data.images[bumps]
        links.new(image.outputs['Color'], normal.inputs['Color'])
        links.new(normal.outputs['Normal'], sockets['Normal'])
    if glow:
        sockets['Emission Strength'].default_value = glow
        if not picture:
            emission.default_value = (*colour, 1)
    if is_pane:
        (sockets.get('Transmission') or sockets['Transmission Weight']).default_value = 1
        sockets['IOR'].default_value = 1.5 if not glow else 1.0


def thing(name, points, faces, uvs, paint, at=(0, 0, 0), smooth=None, parent=None):
    """An object of points, faces and a place in the picture for each face's corner."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    mesh.uv_layers.new().data.foreach_set('uv', [c for uv in uvs for c in uv])
    mesh.materials.append(materials[paint])
    if smooth:
        mesh.polygons.foreach_set('use_smooth', [True] * len(faces))
        if hasattr(mesh, 'use_auto_smooth'):  # until Blender 4.0
            mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.radians(smooth)
        else:
            mesh.set_sharp_from_angle(angle=math.radians(smooth))
    made = bpy.data.objects.new(name, mesh)
    made.location, made.parent = at, parent
    bpy.context.scene.collection.objects.link(made)
    return made


def box(name, low, high, paint, tile=1.0, chamfer=0.004, at=(0, 0, 0), parent=None):
    """The picture's grain runs along the longest side; a tile of it is so many metres."""
    points = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    faces = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    size = [high[k] - low[k] for k in range(3)]
    order = sorted(range(3), key=lambda k: -size[k])
    shift, uvs = (dice.random(), dice.random()), []
    for f, face in enumerate(faces):
        u, v = [k for k in order if k != f // 2]
        uvs += [(points[i][u] / tile + shift[0], points[i][v] / tile + shift[1]) for i in face]
    made = thing(name, points, faces, uvs, paint, at, parent=parent)
    if chamfer:
        bevel = made.modifiers.new('bevel', 'BEVEL')
        bevel.width, bevel.segments = min(chamfer, min(size) / 3), 1
    return made


def sheet(name, corners, paint):
    """Four corners, counterclockwise from below left: the whole picture lies between them."""
    return thing(name, corners, [(0, 1, 2, 3)], [(0, 0), (1, 0), (1, 1), (0, 1)], paint)


def rounded(profile, steps=3):
    """A smooth line through the points (Catmull-Rom)."""
    ends = [profile[0], *profile, profile[-1]]
    line = []
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:]):
        for s in range(steps):
            t = s / steps
            line.append([0.5 * (2 * q + (r - p) * t + (2 * p - 5 * q + 4 * r - s_) * t * t
                                + (3 * q - p - 3 * r + s_) * t ** 3)
                         for p, q, r, s_ in zip(a, b, c, d)])
    return [*line, list(profile[-1])]


def turned(name, profile, paint, at=(0, 0, 0), sides=44, parent=None, smooth=40, rings=1):
    """What a wheel makes of a line of (radius, height), from the foot upwards; the picture comes
    `rings` times on its way round."""
    ways = [0.0]
    for (r, z), (s, y) in zip(profile, profile[1:]):
        ways.append(ways[-1] + math.hypot(s - r, y - z))
    points = [(r * math.cos(2 * math.pi * i / sides), r * math.sin(2 * math.pi * i / sides), z)
              for r, z in profile for i in range(sides)]
    faces, uvs = [], []
    for j in range(len(profile) - 1):
        for i in range(sides):
            k = (i + 1) % sides
            faces.append((j * sides + i, j * sides + k, (j + 1) * sides + k, (j + 1) * sides + i))
            uvs += [(rings * a / sides, ways[b] / ways[-1])
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
    return thing(name, points, faces, uvs, paint, at, smooth, parent)


def pot(name, outline, paint, at, wall=0.006, size=1.0, steps=3, **how):
    """A vessel: its outline from the foot to the lip, and back inside. The picture's lower three
    quarters are outside."""
    line = rounded([(r * size, z * size) for r, z in outline], steps)
    inside = [(max(r - wall, 0.0), z) for r, z in reversed(line) if z > wall + 0.004]
    lip = (line[-1][0] - wall / 2, line[-1][1] + wall / 2)
    return turned(name, [(0.001, 0.003), (line[0][0] * 0.9, 0.003), (line[0][0] * 0.94, 0), *line,
                         lip, *inside, (0.0005, wall + 0.004)], paint, at, **how)


def tube(name, path, radius, paint, at=(0, 0, 0), sides=12, parent=None, flat=1.0):
    """A round bar along a path: handles, rods, hooks."""
    points, faces, uvs = [], [], []
    path = [Vector(p) for p in path]
    for n, p in enumerate(path):
        way = (path[min(n + 1, len(path) - 1)] - path[max(n - 1, 0)]).normalized()
        one = way.cross(Vector((0, 1, 0)) if abs(way.y) < 0.9 else Vector((1, 0, 0))).normalized()
        two = way.cross(one)
        for i in range(sides):
            turn = 2 * math.pi * i / sides
            points.append(p + radius * (math.cos(turn) * one + flat * math.sin(turn) * two))
    for n in range(len(path) - 1):
        for i in range(sides):
            k = (i + 1) % sides
            faces.append((n * sides + i, n * sides + k, (n + 1) * sides + k, (n + 1) * sides + i))
            uvs += [(0.1, 0.5), (0.2, 0.5), (0.2, 0.55), (0.1, 0.55)]
    faces += [tuple(range(sides))[::-1], tuple(range(len(points) - sides, len(points)))]
    uvs += [(0.1, 0.5)] * (2 * sides)
    return thing(name, points, faces, uvs, paint, at, 50, parent)


def lay(made, at, axis, degrees):
    """Turns what was made upright, then puts it there."""
    made.matrix_world = Matrix.Translation(at) @ Matrix.Rotation(math.radians(degrees), 4, axis)


def empty(name, at, parent=None):
    made = bpy.data.objects.new(name, None)
    made.location, made.parent = at, parent
    bpy.context.scene.collection.objects.link(made)
    return made


def joined(name, make):
    """One object of all that `make` makes, in the place of the first."""
    before = set(bpy.data.objects)
    make()
    bpy.context.view_layer.update()
    parts = [o for o in bpy.data.objects if o not in before]
    whole = bpy.context.evaluated_depsgraph_get()
    for part in parts:
        part.data = bpy.data.meshes.new_from_object(part.evaluated_get(whole),
                                                    depsgraph=whole)
        part.modifiers.clear()
    with bpy.context.temp_override(active_object=parts[0], object=parts[0],
                                   selected_editable_objects=parts, selected_objects=parts):
        bpy.ops.object.join()
    parts[0].name = parts[0].data.name = name
    return parts[0]


def animate(what, name, axis, frames, angle):
    """`angle` of 0 to 1; 24 frames are a second, and each has a key."""
    what.animation_data_create().action = bpy.data.actions.new(name)
    for frame in range(frames + 1):
        what.rotation_euler['xyz'.index(axis)] = angle(frame / frames)
        what.keyframe_insert('rotation_euler', frame=frame)
    what.rotation_euler['xyz'.index(axis)] = 0


def light(name, kind, at, strength, degrees=0.0, tone=(1.0, 0.80, 0.56), way=(0, 0, -1)):
    """Candela, or lux of a sun. Blender's watts are 4 pi times the candela of the file."""
    data = bpy.data.lights.new(name, kind)
    data.color = tone
    data.energy = strength if kind == 'SUN' else strength * 4 * math.pi
    if kind == 'SPOT':
        data.spot_size, data.spot_blend = 2 * math.radians(degrees), 0.5
    made = bpy.data.objects.new(name, data)
    made.location = at
    made.rotation_euler = Vector(way).to_track_quat('-Z', 'Y').to_euler()
    bpy.context.scene.collection.objects.link(made)


def store(name, pixels, is_data, folder):
    """A picture as a JPEG file, which goes into the GLB as it is."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height)
    flat = np.ones((height, width, 4), np.float32)
    flat[..., :3] = np.clip(pixels[::-1], 0, 1)
    image.pixels.foreach_set(flat.ravel())
    image.filepath_raw, image.file_format = os.path.join(folder, name + '.jpg'), 'JPEG'
    bpy.context.scene.render.image_settings.quality = 88
    image.save()
    bpy.data.images.remove(image)
    image = bpy.data.images.load(os.path.join(folder, name + '.jpg'))
    image.name = name
    if is_data:
        image.colorspace_settings.name = 'Non-Color'
