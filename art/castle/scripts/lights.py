# SPDX-License-Identifier: Apache-2.0
"""Sun and museum lamps. glTF intensities: the sun in lux (W/m^2), spots in candela (W/sr), one to
one."""
import math

import bpy
from mathutils import Vector

# degrees; azimuth from straight into the windows, towards -x
SUN_ELEVATION, SUN_AZIMUTH = 40.0, 28.0
SUN_IRRADIANCE = (12.0, 10.8, 9.1)
FILL_IRRADIANCE = (1.5, 1.8, 2.1)
WARM = (1.0, 0.80, 0.56)


def sun_direction():
    """The way sunlight travels."""
    e, a = math.radians(SUN_ELEVATION), math.radians(SUN_AZIMUTH)
    return Vector((-math.sin(a) * math.cos(e), -math.cos(a) * math.cos(e), -math.sin(e)))


def place(name, data, position, direction):
    lamp = bpy.data.objects.new(name, data)
    lamp.location = position
    lamp.rotation_euler = Vector(direction).to_track_quat('-Z', 'Y').to_euler()
    bpy.context.scene.collection.objects.link(lamp)
    return lamp


def make_directional(name, irradiance, direction):
    data = bpy.data.lights.new(name, 'SUN')
    peak = max(irradiance)
    data.color = [c / peak for c in irradiance]
    data.energy = peak
    data.angle = 0.0
    place(name, data, (0, 12, 14), direction)


def make_daylight():
    """The sun, and a blue light from above the hall's roof for the courtyard's shadows."""
    make_directional('Sun', SUN_IRRADIANCE, sun_direction())
    make_directional('Sky Fill', FILL_IRRADIANCE, Vector((-0.5, 0.32, -0.8)))


def make_spot(name, position, target, candela, degrees=30.0, colour=WARM, soft=0.5):
    """`degrees`: half the cone's opening. Blender's watts are 4 pi times the candela of the
    export."""
    data = bpy.data.lights.new(name, 'SPOT')
    data.color = colour
    data.energy = candela * 4 * math.pi
    data.spot_size = 2 * math.radians(degrees)
    data.spot_blend = soft
    data.shadow_soft_size = 0.0
    place(name, data, position, Vector(target) - Vector(position))


def make_point(name, position, candela, colour=WARM):
    data = bpy.data.lights.new(name, 'POINT')
    data.color = colour
    data.energy = candela * 4 * math.pi
    data.shadow_soft_size = 0.0
    place(name, data, position, (0, 0, -1))
