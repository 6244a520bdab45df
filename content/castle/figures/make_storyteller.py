# SPDX-License-Identifier: Apache-2.0
"""Makes the storyteller:  blender -b --python make_storyteller.py -- storyteller.x3d

Textures are written beside the X3D file. Same script, same Blender: same bytes.
"""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import export_x3d
import expressions
import rig
import storyteller
import textures


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if len(arguments) != 1:
        sys.exit("usage: blender -b --python make_storyteller.py -- OUT.x3d")
    path = os.path.abspath(arguments[0])
    figure = storyteller.make_storyteller()
    expressions.add_displacers(figure)
    textures.make_textures(figure, os.path.dirname(path))
    skeleton = rig.make_joints()
    export_x3d.write_figure(figure, skeleton, rig.make_sites(), path, os.path.basename(path),
                            "The storyteller of the castle: a chatelaine of about 1530, with face controls and visemes")
    vertices = sum(len(p.positions) for p in figure.patches)
    triangles = sum(len(p.triangles) for p in figure.patches)
    print("%s: %d vertices, %d triangles, %d joints, %d displacers, %.1f MB" % (
        path, vertices, triangles, len(skeleton), len(figure.displacers), os.path.getsize(path) / 1e6))


main()
