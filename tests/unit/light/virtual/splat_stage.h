// SPDX-License-Identifier: Apache-2.0
// A world seen from somewhere, for tests of light/virtual: its pixels by rays, and their light
// summed one by one.
#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "light/sample/light_tables.h"
#include "light/virtual/splatter.h"
#include "light/visible/guides.h"
#include "scenes/scenes.h"

namespace wellspring::test {

struct SplatStage {
  Scene scene;
  World world;
  Lights lights;
  View view;
  std::vector<float> depth, nx, ny, nz;
  SplatLights drawn;
  SplatPicture picture;

  SplatStage(Scene made, const View& from)
      : scene(std::move(made)), world(scene), lights(make_lights(world)), view(from) {
    std::vector<Ray> rays;
    for (int y = 0; y < view.height; y++)
      for (int x = 0; x < view.width; x++)
        rays.push_back(view_ray(view, float(x) + 0.5f, float(y) + 0.5f));
    std::vector<PrimaryHit> seen(rays.size());
    see(world, lights, rays, seen);
    for (size_t i = 0; i < rays.size(); i++) {
      bool lit = seen[i].scatters && std::isfinite(seen[i].distance);
      depth.push_back(lit ? seen[i].distance * dot(rays[i].direction, view.forward)
                          : std::numeric_limits<float>::infinity());
      nx.push_back(seen[i].normal.x), ny.push_back(seen[i].normal.y);
      nz.push_back(seen[i].normal.z);
    }
  }
  Transport transport() const { return {world, *lights.tables}; }
  SplatPixels pixels() const {
    SplatPixels pixels;
    pixels.view = view;
    pixels.depth = depth.data();
    pixels.nx = nx.data(), pixels.ny = ny.data(), pixels.nz = nz.data();
    return pixels;
  }
  void draw(const SplatSettings& settings, SplatSeed seed = {}) {
    std::vector<LitProbe> probes;
    find_splat_probes(pixels(), 32, probes);
    draw_virtual_lights(transport(), make_all_splat_sources(transport()), settings, seed, probes,
                        drawn);
  }
  void splat(const SplatSettings& settings, SplatSeed seed = {}) {
    splat_picture(transport(), drawn, pixels(), settings, seed, picture);
  }
  vec3 place(int x, int y) const {
    return view.position + place_from_eye(pixels(), make_pixel_grid(pixels()), x, y);
  }
  vec3 normal(int x, int y) const {
    size_t i = size_t(y * view.width + x);
    return {nx[i], ny[i], nz[i]};
  }
  bool lit(int x, int y) const { return is_lit(pixels(), size_t(y * view.width + x)); }
};

// The sum over all virtual lights in double precision, with nothing in between.
inline dvec3 brute_force(const VirtualLights& lights, dvec3 place, dvec3 normal) {
  dvec3 sum(0);
  for (size_t i = 0; i < size_t(lights.count); i++) {
    dvec3 way = dvec3(lights.position(i)) - place;
    double d2 = dot(way, way), here = dot(way, normal), there = -dot(way, dvec3(lights.normal(i)));
    if (!(here > 0) || !(there > 0)) continue;
    sum += dvec3(lights.intensity(i)) * (here * there / (d2 * (d2 + double(lights.radius2(i)))));
  }
  return sum;
}

// Root mean square over the lit pixels of what differs from the brute-force sum, over the sum's
// own.
inline double relative_error(const SplatStage& stage) {
  double squares = 0, own = 0;
  for (int y = 0; y < stage.view.height; y++)
    for (int x = 0; x < stage.view.width; x++) {
      if (!stage.lit(x, y)) continue;
      dvec3 right = brute_force(stage.drawn.lights, stage.place(x, y), stage.normal(x, y));
      dvec3 differs = dvec3(stage.picture.irradiance[size_t(y * stage.view.width + x)]) - right;
      squares += dot(differs, differs), own += dot(right, right);
    }
  return std::sqrt(squares / own);
}

}  // namespace wellspring::test
