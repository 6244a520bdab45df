# SPDX-License-Identifier: Apache-2.0
"""Makes the castle museum:

    blender -b --factory-startup --python art/castle/make_scene.py -- OUT.glb

Everything is computed here: geometry, pictures, light. The same script gives the same castle.
Needs Blender 3.4 or newer with numpy in its Python (Debian: blender, python3-numpy); takes a few
minutes, most of them for painting the pictures.
"""
import os
import sys
import tempfile

import bpy

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from scripts import cameras, courtyard, export, furniture, hall, lights  # noqa: E402
from scripts import materials, pictures, statues, treasury  # noqa: E402

EXHIBIT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../content/castle')


def build(folder):
    images = {name: materials.store_picture(name, pixels, folder, data, quality)
              for name, pixels, data, quality in pictures.all_pictures()}
    for spec in materials.TABLE:
        materials.make_material(spec, images)
    hall.make_hall()
    courtyard.make_courtyard()
    courtyard.make_well()
    courtyard.make_backdrop()
    furniture.make_furniture()
    treasury.make_treasury()
    statues.make_horse()
    statues.make_bust(0.1, -3.8, 155)
    statues.make_armour(-7.35, 2.1, 90, 'Armour')
    lights.make_daylight()
    cameras.make_cameras(os.path.join(EXHIBIT, 'exhibit.json'))


def main():
    arguments = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    if len(arguments) != 1:
        sys.exit('usage: blender -b --factory-startup --python make_scene.py -- OUT.glb')
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module='io_scene_gltf2')
    with tempfile.TemporaryDirectory() as folder:
        build(folder)
        export.export(os.path.abspath(arguments[0]))


if __name__ == '__main__':
    main()
