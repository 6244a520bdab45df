# SPDX-License-Identifier: Apache-2.0
"""Writes the Blender scene as a GLB and settles in its JSON what the exporter leaves open."""
import json
import struct

import bpy

from .materials import BY_NAME


def export(path):
    bpy.ops.export_scene.gltf(
        filepath=path, export_format='GLB', export_apply=True, export_yup=True, export_lights=True,
        export_cameras=True, export_animations=False, export_skins=False, export_morph=False,
        export_colors=False, export_image_format='AUTO', convert_lighting_mode='COMPAT',
            export_extras=False)
    settle(path)


def settle(path):
    """Materials exactly as the table says: thin glass, radiance of emitters, sides."""
    with open(path, 'rb') as file:
        data = file.read()
    magic, version, _ = struct.unpack_from('<4sII', data, 0)
    assert magic == b'glTF' and version == 2
    length, kind = struct.unpack_from('<I4s', data, 12)
    assert kind == b'JSON'
    document, rest = json.loads(data[20:20 + length]), data[20 + length:]
    document['asset']['generator'] = 'art/castle/make_scene.py'
    document['asset']['copyright'] = 'The Wellspring authors, Apache License 2.0'
    used = {'KHR_lights_punctual'}
    for material in document['materials']:
        spec = BY_NAME[material['name']]
        extensions = {}
        if spec.emission:
            peak = max(1.0, max(spec.emission))
            material['emissiveFactor'] = [c / peak for c in spec.emission]
            extensions['KHR_materials_emissive_strength'] = {'emissiveStrength': peak}
        if spec.pane:
            extensions['KHR_materials_transmission'] = {'transmissionFactor': 1.0}
            extensions['KHR_materials_ior'] = {'ior': spec.pane}
        material.pop('extensions', None)
        if extensions:
            material['extensions'] = extensions
            used.update(extensions)
        material.pop('doubleSided', None)
        if spec.double_sided:
            material['doubleSided'] = True
    document['extensionsUsed'] = sorted(used)
    text = json.dumps(document, separators=(',', ':')).encode()
    text += b' ' * (-len(text) % 4)
    total = 12 + 8 + len(text) + len(rest)
    with open(path, 'wb') as file:
        file.write(struct.pack('<4sII', b'glTF', 2, total) + struct.pack('<I4s', len(text),
            b'JSON') + text + rest)
    describe(path, document, total)


def describe(path, document, size):
    accessors = document['accessors']
    emitters = {i for i, m in enumerate(document['materials']) if max(m.get('emissiveFactor',
        [0])) > 0}
    triangles = shining = 0
    for mesh in document['meshes']:
        for primitive in mesh['primitives']:
            count = accessors[primitive['indices']]['count'] // 3
            triangles += count
            shining += count if primitive.get('material') in emitters else 0
    print(f'{path}: {size / 1e6:.1f} MB, {triangles} triangles, {shining} of them emit, '
          f"{len(document['nodes'])} nodes, {len(document.get('images', []))} pictures")
