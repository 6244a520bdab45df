// SPDX-License-Identifier: Apache-2.0
// The light of lights that move or change, for one picture: computed at its resolution or half of
// it and read back per pixel, never across edges.
#pragma once
#include <span>

#include "light/dynamic/direct_light.h"
#include "light/dynamic/dynamic_light.h"
#include "light/splat/splatter.h"
#include "light/transport_settings.h"
#include "light/visible/surface_buffer.h"

namespace wellspring {

struct DynamicImage {
  SurfaceBuffer surfaces;  // where it was computed
  LightPlanes light;       // of each of its pixels
  std::vector<SplatSource> sources;
  SplatLights virtual_lights;
  SplatPicture indirect;
};
size_t memory_bytes(const DynamicImage& image);

// Pixels of a picture above which the light has half of its resolution.
inline constexpr size_t fine_dynamic_pixels = 320 * 1024;

// The view in which light for pictures of `view` is computed.
View dynamic_light_view(const View& view);

// As the lights that move are wanted in pictures of the show: few virtual lights, the same random
// numbers in every picture, so that light changes as smoothly as what it comes from.
SplatSettings dynamic_splat_settings();

// Overwrites `image` by the light of `from` in pictures of `view`, straight and scattered once,
// reusing memory. All cores; call after World::commit(), while nothing moves.
void compute_dynamic_light(const World& world, const Lights& lights,
                           const VisibilityPass& visibility, const View& view,
                           std::span<const DynamicLight> from, const SplatSettings& settings,
                           DynamicImage& image);

// Radiance of white diffuse surfaces at pixels [x, x + count) of row y of a picture of `view`,
// which compute_dynamic_light() was called for. `run`: that show these, with normals.
struct DynamicRun {
  int x = 0, y = 0, count = 0;
  const float* depth = nullptr;
  const uint32_t* object = nullptr;
  const RunSurface* surface = nullptr;
};
void read_dynamic_light(const DynamicImage& image, const View& view, const DynamicRun& run,
                        RunKnown& to);

}  // namespace wellspring
