# SPDX-License-Identifier: Apache-2.0
"""The exhibit's viewpoints as cameras of the scene, so that the file can be looked at by itself."""
import json
import math

import bpy


def make_cameras(exhibit_path):
    with open(exhibit_path, encoding='utf-8') as file:
        viewpoints = json.load(file)['viewpoints']
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 1280, 720
    for view in viewpoints:
        data = bpy.data.cameras.new(view['name'])
        data.sensor_fit = 'VERTICAL'
        data.angle = math.radians(view['fov_deg'])
        data.clip_start, data.clip_end = 0.02, 200.0
        camera = bpy.data.objects.new(view['name'], data)
        x, y, z = view['position']
        camera.location = (x, -z, y)
        camera.rotation_euler = (math.radians(90 + view['pitch_deg']), 0,
                                 math.radians(view['yaw_deg']))
        scene.collection.objects.link(camera)
