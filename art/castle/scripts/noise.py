# SPDX-License-Identifier: Apache-2.0
"""Tileable noise and picture arithmetic with numpy.

Pictures are float arrays, height x width x 3, display-referred sRGB values in 0..1, top row first.
Everything is a pure function of its arguments; randomness comes from a numpy Generator passed in.
"""
import numpy as np


def generator(name):
    """A random generator that depends on `name` alone."""
    return np.random.default_rng(list(name.encode()))


def spectral(shape, rng, slope=2.0, low=1.0, high=1e9, stretch=(1.0, 1.0)):
    """Tileable noise in 0..1 with power falling as frequency^-slope between two cut-offs.

    Frequencies are in cycles a picture; `stretch` = (vertical, horizontal) makes features longer
    along an axis.
    """
    height, width = shape
    fy = np.fft.fftfreq(height)[:, None] * height * stretch[0]
    fx = np.fft.rfftfreq(width)[None, :] * width * stretch[1]
    frequency = np.sqrt(fy * fy + fx * fx)
    amplitude = np.where((frequency >= low) & (frequency <= high),
                         np.maximum(frequency, 1e-9) ** (-slope / 2), 0.0)
    phase = rng.random(amplitude.shape) * 2 * np.pi
    field = np.fft.irfft2(amplitude * np.exp(1j * phase), s=shape)
    field = (field - field.mean()) / (field.std() + 1e-12)
    return np.clip(field / 5.0 + 0.5, 0.0, 1.0)


def smoothstep(a, b, x):
    t = np.clip((x - a) / (b - a), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def mix(a, b, t):
    """Blends two pictures or colours by a mask or number."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    t = np.asarray(t, float)
    if t.ndim == 2:
        t = t[..., None]
    return a + (b - a) * t


def solid(shape, colour):
    return np.ones(shape + (3,)) * np.asarray(colour, float)


def blur(field, radius):
    """Gaussian blur that wraps around; `radius` is the standard deviation in pixels."""
    if radius <= 0:
        return field
    height, width = field.shape[:2]
    fy = np.fft.fftfreq(height)[:, None]
    fx = np.fft.rfftfreq(width)[None, :]
    kernel = np.exp(-2 * (np.pi * radius) ** 2 * (fy * fy + fx * fx))
    if field.ndim == 3:
        return np.stack([np.fft.irfft2(np.fft.rfft2(field[..., c]) * kernel, s=(height, width))
                         for c in range(field.shape[2])], axis=-1)
    return np.fft.irfft2(np.fft.rfft2(field) * kernel, s=(height, width))


def normal_map(height_field, strength):
    """Tangent-space normals (green up) of a tileable height field; `strength` in texels of
    height."""
    dx = (np.roll(height_field, -1, 1) - np.roll(height_field, 1, 1)) * 0.5 * strength
    dy = (np.roll(height_field, -1, 0) - np.roll(height_field, 1, 0)) * 0.5 * strength
    normal = np.stack([-dx, dy, np.ones_like(dx)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    return normal * 0.5 + 0.5


def warp(field, dy, dx):
    """Reads `field` at wrapped, whole-texel offsets."""
    height, width = field.shape[:2]
    y, x = np.mgrid[0:height, 0:width]
    return field[(y + np.rint(dy).astype(int)) % height, (x + np.rint(dx).astype(int)) % width]
