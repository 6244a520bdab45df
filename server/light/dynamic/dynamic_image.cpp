// SPDX-License-Identifier: Apache-2.0
#include "light/dynamic/dynamic_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/memory.h"
#include "base/parallel.h"
#include "light/visible/light_view.h"
#include "light/visible/pixel_grid.h"

namespace wellspring {
namespace {

constexpr float plane_share = 0.02f;  // of the depth: farther off the plane is another surface
constexpr float least_weight = 1e-4f;

// What a pixel of the picture is compared by.
struct Seen {
  vec3 place, normal;  // relative to the eye; unit
  float depth;
  uint32_t object;
};

// How much a pixel of the light image shows of the same surface, 0 to 1.
float likeness(const DynamicImage& image, const PixelGrid& grid, int x, int y, const Seen& seen) {
  const SurfaceBuffer& s = image.surfaces;
  const size_t at = size_t(y) * size_t(s.view.width) + size_t(x);
  const float depth = s.depth[at];
  if (!(depth < std::numeric_limits<float>::infinity())) return 0;
  const vec3 normal(s.nx[at], s.ny[at], s.nz[at]);
  float facing = std::max(dot(normal, seen.normal), 0.0f);
  facing *= facing, facing *= facing;
  const vec3 to = depth * grid.at(float(x), float(y)) - seen.place;
  const float off = dot(to, seen.normal) / (plane_share * seen.depth);
  const float same = s.object[at] == seen.object ? 1.0f : 0.01f;
  return same * facing / (1 + off * off);
}

void add_irradiance(const RawVector<vec3>& irradiance, LightPlanes& to) {
  parallel_ranges(int(irradiance.size()), 8192, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      to.red[i] += irradiance[i].x * (1 / pi);
      to.green[i] += irradiance[i].y * (1 / pi);
      to.blue[i] += irradiance[i].z * (1 / pi);
    }
  });
}

vec3 light_at(const DynamicImage& image, int x, int y) {
  const size_t at = size_t(y) * size_t(image.surfaces.view.width) + size_t(x);
  return {image.light.red[at], image.light.green[at], image.light.blue[at]};
}

// The mean of the four pixels around (x, y), as far as they show the same surface; of none: the
// most alike in a wider circle.
vec3 interpolate(const DynamicImage& image, const PixelGrid& grid, float x, float y,
                 const Seen& seen) {
  const View& view = image.surfaces.view;
  const float left = std::floor(x), top = std::floor(y);
  const float fx = x - left, fy = y - top;
  auto column = [&](int k) { return std::clamp(int(left) + k, 0, view.width - 1); };
  auto row = [&](int k) { return std::clamp(int(top) + k, 0, view.height - 1); };
  vec3 sum(0);
  float weights = 0;
  for (int k = 0; k < 4; k++) {
    const int cx = column(k & 1), cy = row(k >> 1);
    const float weight =
        ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy) * likeness(image, grid, cx, cy, seen);
    sum += weight * light_at(image, cx, cy), weights += weight;
  }
  if (weights > least_weight) return sum / weights;
  float best = 0;
  for (int dy = -1; dy <= 2; dy++)
    for (int dx = -1; dx <= 2; dx++) {
      const int cx = column(dx), cy = row(dy);
      const float like = likeness(image, grid, cx, cy, seen);
      if (like > best) best = like, sum = light_at(image, cx, cy);
    }
  return best > 0 ? sum : vec3(0);
}

}  // namespace

size_t memory_bytes(const DynamicImage& image) {
  const ReflectiveShadowMap& map = image.virtual_lights.map;
  const VirtualLights& lights = image.virtual_lights.lights;
  const SplatPicture& indirect = image.indirect;
  size_t sum = bytes_of(map.texels, map.maps, map.cells, map.aims, map.shares) +
               bytes_of(lights.x, lights.y, lights.z, lights.nx, lights.ny, lights.nz, lights.red,
                        lights.green, lights.blue, lights.radius2, lights.target, lights.weights) +
               bytes_of(indirect.irradiance, indirect.pyramid.cells, indirect.subsplats.list,
                        indirect.subsplats.first, indirect.room.joined);
  for (const IlluminationLevel& level : indirect.illumination.levels) sum += bytes_of(level.texels);
  return sum + memory_bytes(image.surfaces) + memory_bytes(image.light) + bytes_of(image.sources);
}

SplatSettings dynamic_splat_settings() {
  SplatSettings settings;
  settings.virtual_lights = 128;
  settings.texels = 2048;
  return settings;
}

View dynamic_light_view(const View& view) {
  if (size_t(view.width) * size_t(view.height) <= fine_dynamic_pixels) return view;
  return light_view(view);
}

void compute_dynamic_light(const World& world, const Lights& lights,
                           const VisibilityPass& visibility, const View& view,
                           std::span<const DynamicLight> from, const SplatSettings& settings,
                           DynamicImage& image) {
  const SurfaceBuffer& surfaces = image.surfaces;
  see_surfaces(visibility, dynamic_light_view(view), image.surfaces);
  clear_planes(surfaces.pixels(), image.light);
  add_direct_light(world, lights, from, surfaces, image.light);
  if (settings.virtual_lights == 0) return;
  const Transport transport{world, *lights.tables};
  image.sources.clear();
  for (const DynamicLight& one : from) {
    image.sources.push_back(make_splat_source(one.light, one.id));
    image.sources.back().radius = one.radius;
  }
  draw_virtual_lights(transport, image.sources, settings, {}, {}, image.virtual_lights);
  SplatPixels pixels;
  pixels.view = surfaces.view;
  pixels.depth = surfaces.depth.data();
  pixels.nx = surfaces.nx.data(), pixels.ny = surfaces.ny.data(), pixels.nz = surfaces.nz.data();
  splat_picture(transport, image.virtual_lights, pixels, settings, {}, image.indirect);
  add_irradiance(image.indirect.irradiance, image.light);
}

void read_dynamic_light(const DynamicImage& image, const View& view, const DynamicRun& run,
                        RunKnown& to) {
  const View& lit = image.surfaces.view;
  if (lit == view) {
    const size_t at = size_t(run.y) * size_t(view.width) + size_t(run.x);
    const size_t bytes = size_t(run.count) * sizeof(float);
    std::memcpy(to.red, &image.light.red[at], bytes);
    std::memcpy(to.green, &image.light.green[at], bytes);
    std::memcpy(to.blue, &image.light.blue[at], bytes);
    return;
  }
  const PixelGrid grid(lit), own(view);
  const RunSurface& surface = *run.surface;
  for (int i = 0; i < run.count; i++) {
    vec3 light(0);
    if (run.depth[i] < std::numeric_limits<float>::infinity()) {
      Seen seen;
      seen.depth = run.depth[i];
      seen.object = run.object[i];
      seen.place = seen.depth * own.at(float(run.x + i), float(run.y));
      seen.normal = vec3(surface.nx[i], surface.ny[i], surface.nz[i]);
      const float length2 = dot(seen.normal, seen.normal);
      if (length2 > 0) seen.normal /= std::sqrt(length2);
      const float x = (float(run.x + i) + 0.5f) / light_scale - 0.5f,
                  y = (float(run.y) + 0.5f) / light_scale - 0.5f;
      light = interpolate(image, grid, x, y, seen);
    }
    to.red[i] = light.x, to.green[i] = light.y, to.blue[i] = light.z;
  }
}

}  // namespace wellspring
