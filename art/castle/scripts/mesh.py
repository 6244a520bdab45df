# SPDX-License-Identifier: Apache-2.0
"""Geometry builder: collects faces with materials and texture coordinates, then becomes a Blender
object.

Blender's axes: x along the hall, y towards the windows, z up; metres.
"""
import math

import bpy
import numpy as np
from mathutils import Matrix, Vector

from .noise import generator


def translation(x, y, z):
    return Matrix.Translation((x, y, z))


def turn_z(degrees):
    return Matrix.Rotation(math.radians(degrees), 4, 'Z')


def turn(degrees, axis):
    return Matrix.Rotation(math.radians(degrees), 4, axis)


class Mesh:
    """Faces in the making. `transform` applies to whatever is added next."""

    def __init__(self, name):
        self.name = name
        self.vertices, self.faces, self.uvs = [], [], []
        self.face_materials, self.face_smooth = [], []
        self.transform = Matrix.Identity(4)
        self.random = generator(name)

    # -- raw input -----------------------------------------------------------------------------
    def add(self, points, faces, material, uvs=None, smooth=False, scale=1.0, grain=None):
        """Adds faces over `points`. `uvs`: one list of (u, v) a face; None projects along the
        face's main axis, `scale` metres a texture, u along `grain` ('x', 'y' or 'z') if it can."""
        base = len(self.vertices)
        points = [Vector(p) for p in points]
        offset = self.random.random(2) if grain else (0.0, 0.0)
        for index, face in enumerate(faces):
            if uvs is not None:
                uv = uvs[index]
            else:
                uv = project_uv([points[i] for i in face], scale, grain, offset)
            self.faces.append([base + i for i in face])
            self.uvs.append(uv)
            self.face_materials.append(material)
            self.face_smooth.append(smooth)
        flip = self.transform.determinant() < 0
        if flip:
            for i in range(len(self.faces) - len(faces), len(self.faces)):
                self.faces[i] = self.faces[i][::-1]
                self.uvs[i] = list(self.uvs[i])[::-1]
        self.vertices.extend(self.transform @ p for p in points)

    def quad(self, a, b, c, d, material, uv=None, scale=1.0, grain=None):
        self.add([a, b, c, d], [(0, 1, 2, 3)], material, None if uv is None else [uv], False,
                 scale, grain)

    # -- solids --------------------------------------------------------------------------------
    def box(self, low, high, material, scale=1.0, grain=None):
        (x0, y0, z0), (x1, y1, z1) = low, high
        points = [(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0),
                  (x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)]
        faces = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (2, 3, 7, 6), (1, 2, 6, 5), (3, 0, 4, 7)]
        self.add(points, faces, material, scale=scale, grain=grain)

    def block(self, centre, size, material, scale=1.0, grain=None):
        c, s = Vector(centre), Vector(size) * 0.5
        self.box(c - s, c + s, material, scale, grain)

    def plank(self, size, material, scale=1.0):
        """A box about the transform's origin, grain along its longest side."""
        grain = 'xyz'[max(range(3), key=lambda i: size[i])]
        self.block((0, 0, 0), size, material, scale, grain)

    def prism(self, outline, low, high, material, scale=1.0, smooth=False, grain=None):
        """Extrudes a convex counter-clockwise (x, y) outline from z = low to z = high."""
        n = len(outline)
        points = [(x, y, low) for x, y in outline] + [(x, y, high) for x, y in outline]
        self.add(points, [tuple(range(n))[::-1], tuple(range(n, 2 * n))], material, scale=scale,
                 grain=grain)
        sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
        self.add(points, sides, material, smooth=smooth, scale=scale, grain=grain)

    def grid(self, points, material, wrap_u=False, wrap_v=False, repeat=(1.0, 1.0), smooth=True,
             offset=(0, 0)):
        """Quads over points[rows][columns]; u runs along columns, v along rows. The surface faces
        the side from which columns run right and rows run up."""
        points = np.asarray(points, float)
        rows, columns = points.shape[:2]
        last_row, last_column = rows - (not wrap_v), columns - (not wrap_u)
        faces, uvs = [], []
        for r in range(last_row):
            for c in range(last_column):
                r1, c1 = (r + 1) % rows, (c + 1) % columns
                faces.append((r * columns + c, r * columns + c1, r1 * columns + c1,
                              r1 * columns + c))
                u0, u1 = (offset[0] + repeat[0] * i / last_column for i in (c, c + 1))
                v0, v1 = (offset[1] + repeat[1] * i / last_row for i in (r, r + 1))
                uvs.append([(u0, v0), (u1, v0), (u1, v1), (u0, v1)])
        self.add(points.reshape(-1, 3), faces, material, uvs, smooth)

    def lathe(self, profile, segments, material, smooth=True, repeat=(1.0, 1.0), squash=1.0,
              phase=0.0):
        """Turns a profile [(radius, z), ...], listed upwards for an outward surface, about z."""
        angles = [2 * math.pi * (i + phase) / segments for i in range(segments)]
        rows = [[(max(r, 1e-5) * math.cos(a), max(r, 1e-5) * squash * math.sin(a),
                  z) for a in angles]
                for r, z in profile]
        self.grid(rows, material, wrap_u=True, repeat=repeat, smooth=smooth)

    def loft(self, rings, material, caps=True, smooth=True, repeat=(1.0, 1.0)):
        """Skin over rings of equally many points (counter-clockwise seen from the last ring's
        side)."""
        self.grid(rings, material, wrap_u=True, repeat=repeat, smooth=smooth)
        if caps:
            n = len(rings[0])
            self.add(rings[0], [tuple(range(n))[::-1]], material)
            self.add(rings[-1], [tuple(range(n))], material)

    def ellipsoid(self, centre, radii, material, segments=16, rings=8):
        profile = [(math.sin(math.pi * i / rings), -math.cos(math.pi * i / rings))
                   for i in range(rings + 1)]
        keep = self.transform
        self.transform = keep @ translation(*centre) @ Matrix.Diagonal((*radii, 1.0))
        self.lathe(profile, segments, material)
        self.transform = keep

    def tube(self, path, radius, material, segments=8, closed=False, caps=True, smooth=True,
             repeat=(1.0, 1.0)):
        """A round rod along a path; `radius` is a number or one a point."""
        radii = list(radius) if hasattr(radius, '__len__') else [radius] * len(path)
        rings = []
        for (point, side, up), r in zip(frames(path, closed), radii):
            rings.append([point + side * (r * math.cos(2 * math.pi * i / segments))
                          + up * (r * math.sin(2 * math.pi * i / segments))
                              for i in range(segments)])
        self.grid(rings, material, wrap_u=True, wrap_v=closed, smooth=smooth, repeat=repeat)
        if caps and not closed:
            n = segments
            self.add(rings[0], [tuple(range(n))[::-1]], material)
            self.add(rings[-1], [tuple(range(n))], material)

    def sweep(self, outline, path, material, ups, closed=False, closed_outline=True, scale=1.0,
              smooth=False):
        """Sweeps a (side, up) outline along a path with given up vectors; corners are mitred."""
        count = len(path)
        path = [Vector(p) for p in path]
        rings, length, lengths = [], 0.0, []
        for i, point in enumerate(path):
            before = (point - path[i - 1]).normalized() if (i > 0 or closed) else None
            after = (path[(i + 1) % count] - point).normalized() if (i < count - 1
                                                                     or closed) else None
            if before is None or after is None:
                tangent, stretch = (before or after), 1.0
            else:
                tangent = (before + after).normalized()
                stretch = 1.0 / max(0.3, tangent.dot(after))
            up = Vector(ups[i] if len(ups) > 1 else ups[0])
            up = (up - tangent * up.dot(tangent)).normalized()
            side = tangent.cross(up).normalized()
            bend = Vector((0, 0, 0))
            if before is not None and after is not None and (after - before).length > 1e-4:
                bend = (after - before).normalized()
            rings.append([point + lengthen(side * s + up * u, bend, stretch) for s, u in outline])
            if i:
                length += (point - path[i - 1]).length
            lengths.append(length / scale)
        around = np.cumsum([0.0] + [math.dist(outline[i], outline[(i + 1) % len(outline)])
                                    for i in range(len(outline))]) / scale
        n = len(outline)
        faces, uvs = [], []
        lengths.append(lengths[-1] + (path[0] - path[-1]).length / scale)
        for r in range(count if closed else count - 1):
            for c in range(n if closed_outline else n - 1):
                r1, c1 = (r + 1) % count, (c + 1) % n
                faces.append((r * n + c, r1 * n + c, r1 * n + c1, r * n + c1))
                u0, u1, v0, v1 = lengths[r], lengths[r + 1], around[c], around[c + 1]
                uvs.append([(u0, v0), (u1, v0), (u1, v1), (u0, v1)])
        self.add([p for ring in rings for p in ring], faces, material, uvs, smooth)

    def surface(self, vertices, faces, material, smooth=True, scale=1.0):
        """A ready triangle or quad mesh, projected texture coordinates."""
        self.add([tuple(v) for v in vertices], [tuple(f) for f in faces], material, smooth=smooth,
                 scale=scale)

    # -- output --------------------------------------------------------------------------------
    def finish(self, bevel=0.0, auto_smooth=38.0, decimate=None, location=None):
        """The Blender object. `bevel`: width of rounded edges in metres. `location` moves the pivot
        there without moving the geometry, so that the node's position means something."""
        pivot = Vector(location) if location else Vector((0, 0, 0))
        data = bpy.data.meshes.new(self.name)
        data.from_pydata([v - pivot for v in self.vertices], [], self.faces)
        names = sorted(set(self.face_materials))
        for name in names:
            data.materials.append(bpy.data.materials[name])
        slots = {name: i for i, name in enumerate(names)}
        data.polygons.foreach_set('material_index', [slots[m] for m in self.face_materials])
        data.polygons.foreach_set('use_smooth', self.face_smooth if not bevel else [True]
                                  * len(self.faces))
        layer = data.uv_layers.new(name='UVMap')
        layer.data.foreach_set('uv', [value for face in self.uvs for uv in face for value in uv])
        data.use_auto_smooth = True
        data.auto_smooth_angle = math.radians(auto_smooth)
        data.validate()
        data.update()
        thing = bpy.data.objects.new(self.name, data)
        thing.location = pivot
        bpy.context.scene.collection.objects.link(thing)
        if bevel:
            modifier = thing.modifiers.new('Bevel', 'BEVEL')
            modifier.width, modifier.segments = bevel, 1
            modifier.limit_method, modifier.angle_limit = 'ANGLE', math.radians(40)
            modifier.harden_normals = True
            modifier.use_clamp_overlap = True
        if decimate:
            modifier = thing.modifiers.new('Decimate', 'DECIMATE')
            modifier.ratio = decimate
        return thing


def lengthen(offset, bend, stretch):
    """Mitre: stretches the part of `offset` that lies in the plane of the corner."""
    return offset + bend * (offset.dot(bend) * (stretch - 1.0))


def project_uv(points, scale, grain, offset):
    normal = Vector((0, 0, 0))
    for i in range(len(points)):
        a, b = points[i], points[(i + 1) % len(points)]
        normal += Vector(((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x),
                          (a.x - b.x) * (a.y + b.y)))
    axis = max(range(3), key=lambda i: abs(normal[i]))
    u_axis, v_axis = [(1, 2), (0, 2), (0, 1)][axis]
    if grain and 'xyz'.index(grain) == v_axis:
        u_axis, v_axis = v_axis, u_axis
    return [(p[u_axis] / scale + offset[0], p[v_axis] / scale + offset[1]) for p in points]


def frames(path, closed=False):
    """Rotation-minimising frames: (point, side, up) for each point of a path."""
    path = [Vector(p) for p in path]
    count = len(path)
    result, previous = [], None
    for i, point in enumerate(path):
        a = path[i - 1] if (i > 0 or closed) else point
        b = path[(i + 1) % count] if (i < count - 1 or closed) else point
        tangent = (b - a).normalized()
        if previous is None:
            reference = Vector((0, 0, 1)) if abs(tangent.z) < 0.9 else Vector((1, 0, 0))
            side = tangent.cross(reference).normalized()
        else:
            side = (previous - tangent * previous.dot(tangent)).normalized()
        previous = side
        result.append((point, side, tangent.cross(side).normalized()))
    return result


def circle(radius, count, centre=(0, 0), phase=0.0):
    return [(centre[0] + radius * math.cos(2 * math.pi * (i + phase) / count),
             centre[1] + radius * math.sin(2 * math.pi * (i + phase) / count))
                 for i in range(count)]


def pointed_arch(half_width, rise, count):
    """Points (x, z) of a pointed arch from (-half_width, 0) over (0, rise) to (half_width, 0)."""
    offset = (rise * rise - half_width * half_width) / (2 * half_width)
    radius = half_width + offset
    top = math.acos(max(-1.0, min(1.0, offset / radius)))
    left = [(offset - radius * math.cos(top * i / count), radius * math.sin(top * i / count))
            for i in range(count + 1)]
    return left + [(-x, z) for x, z in left[-2::-1]]


def bezier(points, count):
    """Samples a Bezier curve of any degree, `count` + 1 points."""
    control = np.asarray(points, float)
    result = []
    for i in range(count + 1):
        t, level = i / count, control
        while len(level) > 1:
            level = level[:-1] * (1 - t) + level[1:] * t
        result.append(tuple(level[0]))
    return result


def catmull_rom(points, count):
    """A smooth curve through all points, `count` steps between neighbours."""
    p = [np.asarray(q, float) for q in points]
    p = [2 * p[0] - p[1]] + p + [2 * p[-1] - p[-2]]
    result = []
    for i in range(1, len(p) - 2):
        for k in range(count):
            t = k / count
            result.append(tuple(0.5 * (2 * p[i] + (p[i + 1] - p[i - 1]) * t
                          + (2 * p[i - 1] - 5 * p[i] + 4 * p[i + 1] - p[i + 2]) * t * t
                          + (3 * p[i] - p[i - 1] - 3 * p[i + 1] + p[i + 2]) * t ** 3)))
    result.append(tuple(p[-2]))
    return result
