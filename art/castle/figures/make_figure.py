# SPDX-License-Identifier: Apache-2.0
"""Makes one of the storytellers:
    blender -b --python make_figure.py -- PERSON [FOLDER] [--paint NAMES]

PERSON is a module of people/. The X3D file and its textures are written into FOLDER (here, if none
is named). `--paint skin,hair` paints only these textures and takes the others as they lie there,
`--paint none` paints none: for trying out forms. Same script, same Blender: same bytes.
"""
import argparse
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

import person


def main():
    parser = argparse.ArgumentParser(prog="make_figure.py")
    parser.add_argument("person")
    parser.add_argument("folder", nargs="?", default=HERE)
    parser.add_argument("--paint")
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
    who = person.choose(arguments.person)  # before the modules that read its numbers

    import assemble
    import export_x3d
    import expressions
    import rig
    import textures
    path = os.path.join(os.path.abspath(arguments.folder), who.FILE + ".x3d")
    figure = assemble.make_person(who)
    expressions.add_displacers(figure)
    wanted = arguments.paint.split(",") if arguments.paint else None
    textures.make_textures(figure, who, os.path.dirname(path), wanted)
    skeleton, sites = rig.make_joints(), rig.make_sites()
    export_x3d.write_figure(figure, skeleton, sites, path, who.FILE, person.WHO)
    vertices = sum(len(p.positions) for p in figure.patches)
    triangles = sum(len(p.triangles) for p in figure.patches)
    print("%s: %d vertices, %d triangles, %d joints, %d displacers, %.1f MB" % (
        path, vertices, triangles, len(skeleton), len(figure.displacers),
        os.path.getsize(path) / 1e6))


main()
