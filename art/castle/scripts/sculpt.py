# SPDX-License-Identifier: Apache-2.0
"""Sculpting with signed distances: rounded forms that melt into each other, then a smooth mesh.

Forms are (distance function, softness) pairs; the surface is found with naive surface nets (S.
Gibson, Constrained Elastic Surface Nets, 1998).
"""
import numpy as np


class Clay:
    """A lump of clay on a grid of `step` metres between two corners."""

    def __init__(self, low, high, step):
        self.low, self.step = np.asarray(low, float), step
        counts = np.ceil((np.asarray(high) - self.low) / step).astype(int) + 1
        axes = [self.low[i] + np.arange(counts[i]) * step for i in range(3)]
        self.x, self.y, self.z = np.meshgrid(*axes, indexing='ij')
        self.distance = np.full(self.x.shape, 1e3)

    # -- forms ---------------------------------------------------------------------------------
    def cone(self, a, b, ra, rb, soft=0.04, flat=1.0):
        """A rod with round ends from a to b whose radius runs from ra to rb; `flat` < 1 squeezes
        y."""
        a, b = np.asarray(a, float), np.asarray(b, float)
        d = b - a
        px, py, pz = self.x - a[0], self.y - a[1], self.z - a[2]
        t = np.clip((px * d[0] + py * d[1] + pz * d[2]) / (d @ d + 1e-12), 0, 1)
        distance = np.sqrt((px - t * d[0]) ** 2 + ((py - t * d[1]) / flat) ** 2
                           + (pz - t * d[2]) ** 2) - (ra + (rb - ra) * t)
        self.join(distance, soft)

    def limb(self, points, radii, soft=0.03, flat=1.0):
        for (a, b), (ra, rb) in zip(zip(points, points[1:]), zip(radii, radii[1:])):
            self.cone(a, b, ra, rb, soft, flat)

    def ball(self, centre, radii, soft=0.04, pitch=0.0):
        """An ellipsoid; `pitch` degrees about y."""
        c, s = np.cos(np.radians(pitch)), np.sin(np.radians(pitch))
        dx, dy, dz = self.x - centre[0], self.y - centre[1], self.z - centre[2]
        u, w = dx * c - dz * s, dx * s + dz * c
        k0 = np.sqrt((u / radii[0]) ** 2 + (dy / radii[1]) ** 2 + (w / radii[2]) ** 2)
        k1 = np.sqrt((u / radii[0] ** 2) ** 2 + (dy / radii[1] ** 2) ** 2
                     + (w / radii[2] ** 2) ** 2)
        self.join(k0 * (k0 - 1) / np.maximum(k1, 1e-9), soft)

    def join(self, other, soft):
        """Smooth union (polynomial minimum)."""
        if soft <= 0:
            self.distance = np.minimum(self.distance, other)
            return
        h = np.clip(0.5 + 0.5 * (self.distance - other) / soft, 0, 1)
        self.distance = self.distance * (1 - h) + other * h - soft * h * (1 - h)

    def carve(self, centre, radii, soft=0.02):
        """Takes an ellipsoid away."""
        dx, dy, dz = ((g - c) / r for g, c, r in zip((self.x, self.y, self.z), centre, radii))
        other = (np.sqrt(dx * dx + dy * dy + dz * dz) - 1) * min(radii)
        h = np.clip(0.5 - 0.5 * (self.distance + other) / soft, 0, 1)
        self.distance = self.distance * (1 - h) - other * h + soft * h * (1 - h)

    def cut_below(self, z):
        self.distance = np.maximum(self.distance, z - self.z)

    def groove(self, field):
        """Adds a height to the whole surface: chased lines, hair, folds."""
        self.distance = self.distance - field

    # -- surface -------------------------------------------------------------------------------
    def skin(self, relax=2):
        """Vertices and quads of the zero surface, facing outwards."""
        d = self.distance
        inside = d < 0
        corners = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
        n = np.array(d.shape) - 1
        part = lambda g, o: g[o[0]:o[0] + n[0], o[1]:o[1] + n[1], o[2]:o[2] + n[2]]
        total = sum(part(inside, o).astype(int) for o in corners)
        active = (total > 0) & (total < 8)
        position = np.zeros(tuple(n) + (3,))
        weight = np.zeros(tuple(n))
        for p in corners:
            for axis in range(3):
                if p[axis]:
                    continue
                q = tuple(c + (i == axis) for i, c in enumerate(p))
                a, b = part(d, p), part(d, q)
                crossing = (a < 0) != (b < 0)
                t = np.where(crossing, a / np.where(a == b, 1, a - b), 0)
                for i in range(3):
                    position[..., i] += crossing * (p[i] + (t if i == axis else 0))
                weight += crossing
        index = np.full(tuple(n), -1)
        cells = np.argwhere(active)
        index[active] = np.arange(len(cells))
        local = position[active] / weight[active][:, None]
        vertices = self.low + (cells + local) * self.step
        faces = []
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            head = [slice(1, -1)] * 3
            head[axis] = slice(0, -1)
            tail = list(head)
            tail[axis] = slice(1, None)
            a, b = inside[tuple(head)], inside[tuple(tail)]
            for flip, where in ((False, a & ~b), (True, ~a & b)):
                cell = np.argwhere(where)
                start = np.array([1, 1, 1])
                start[axis] = 0
                cell = cell + start
                quad = []
                for du, dv in ((-1, -1), (0, -1), (0, 0), (-1, 0)):
                    c = cell.copy()
                    c[:, u] += du
                    c[:, v] += dv
                    quad.append(index[c[:, 0], c[:, 1], c[:, 2]])
                quad = np.stack(quad, axis=1)
                faces.append(quad[:, ::-1] if flip else quad)
        faces = np.concatenate(faces)
        for _ in range(relax):
            vertices = smooth(vertices, faces)
        return vertices, faces


def smooth(vertices, faces, amount=0.5):
    total, count = np.zeros_like(vertices), np.zeros(len(vertices))
    for k in range(4):
        a, b = faces[:, k], faces[:, (k + 1) % 4]
        np.add.at(total, a, vertices[b])
        np.add.at(total, b, vertices[a])
        np.add.at(count, a, 1)
        np.add.at(count, b, 1)
    return vertices + (total / np.maximum(count, 1)[:, None] - vertices) * amount
