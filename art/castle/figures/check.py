# SPDX-License-Identifier: Apache-2.0
"""Checks an H-Anim figure:  python3 check.py storyteller.x3d

Indices in range, weights of every vertex sum to one, displacers move something, names are unique,
normals have length one, every triangle has an area, textures exist. Prints what it found; exit code
1 when something is wrong.
"""
import os
import sys
import xml.etree.ElementTree as xml


def floats(text, size=1):
    values = [float(x) for x in (text or "").split()]
    return values if size == 1 else [tuple(values[i:i + size]) for i in range(0, len(values), size)]


def check(path):
    faults = []

    def expect(condition, text):
        if not condition:
            faults.append(text)

    humanoid = xml.parse(path).getroot().find("Scene/HAnimHumanoid")
    points = floats(humanoid.find("Coordinate").get("point"), 3)
    normals = floats(humanoid.find("Normal").get("vector"), 3)
    count = len(points)
    expect(len(normals) == count, "as many normals as points")
    expect(all(abs(sum(x * x for x in n) - 1) < 0.01 for n in normals), "normals of length one")
    sums = [0.0] * count
    names, displacers = set(), {}
    for joint in humanoid.iter("HAnimJoint"):
        if joint.get("USE"):
            continue
        name = joint.get("name")
        expect(name not in names, "joint twice: " + name)
        names.add(name)
        index, weight = floats(joint.get("skinCoordIndex")), floats(joint.get("skinCoordWeight"))
        expect(len(index) == len(weight), "weights of " + name)
        for i, w in zip(index, weight):
            expect(0 <= i < count and 0 <= w <= 1, "weight out of range in " + name)
            sums[int(i)] += w
        for d in joint.findall("HAnimDisplacer"):
            index, moves = floats(d.get("coordIndex")), floats(d.get("displacements"), 3)
            expect(index and len(index) == len(moves), "displacer " + d.get("name"))
            expect(all(0 <= i < count for i in index), "index out of range in " + d.get("name"))
            expect(d.get("name") not in displacers, "displacer twice: " + d.get("name"))
            displacers[d.get("name")] = (max(sum(x * x for x in m) ** 0.5 for m in moves) if moves
                                         else 0.0)
    uneven = sum(abs(s - 1) >= 0.002 for s in sums)
    expect(uneven == 0, "vertices whose weights do not sum to one: %d" % uneven)
    idle = [name for name, farthest in displacers.items() if farthest < 3e-4]
    expect(not idle, "displacers that hardly move: %s" % idle)
    used, triangles, flat = set(), 0, 0
    for shape in humanoid.findall("Shape"):
        index = [int(i) for i in shape.find("IndexedTriangleSet").get("index").split()]
        expect(len(index) % 3 == 0 and all(0 <= i < count for i in index),
               "triangles of " + shape.get("DEF"))
        used.update(index)
        triangles += len(index) // 3
        for k in range(0, len(index), 3):
            a, b, c = (points[i] for i in index[k:k + 3])
            u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            flat += sum(x * x for x in n) < 1e-18
    expect(len(used) == count, "vertices no triangle uses: %d" % (count - len(used)))
    expect(flat < 0.002 * triangles, "triangles without area: %d" % flat)
    for texture in humanoid.iter("ImageTexture"):
        for url in texture.get("url").replace('"', "").split():
            expect(os.path.exists(os.path.join(os.path.dirname(path), url)),
                   "texture missing: " + url)
    print("%d vertices, %d triangles, %d joints, %d displacers, %.2f MB" % (
        count, triangles, len(names), len(displacers), os.path.getsize(path) / 1e6))
    print("farthest move in mm: "
          + ", ".join("%s %.1f" % (n, 1000 * m) for n, m in displacers.items()))
    for fault in faults[:40]:
        print("FAULT: " + fault)
    return not faults


if __name__ == "__main__":
    sys.exit(0 if check(sys.argv[1]) else 1)
