// SPDX-License-Identifier: Apache-2.0
#include "picture/still/still_guides.h"

#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "base/spread.h"
#include "light/visible/describe_run.h"

namespace wellspring::picture {
namespace {

struct GuidePass {
  const World& world;
  const Lights& lights;
  const View& view;
  vec2 place;
  bool first;  // of the passes
  GuidePlanes& planes;
  std::vector<uint8_t>& followed;

  void add(size_t pixel, const Guide& guide) const {
    constexpr float share = 1 / float(guide_places);
    planes.albedo[pixel] += guide.albedo * share;
    planes.normal[pixel] += guide.normal * share;
  }
  void take(const VisibleRun& run) const;
  void follow(const VisibleRun& run, uint64_t polished, size_t begin) const;
};

// Rays at what the run shows of polished surfaces.
void GuidePass::follow(const VisibleRun& run, uint64_t polished, size_t begin) const {
  Ray rays[RasterRun::most];
  Guide guides[RasterRun::most];
  int pixel[RasterRun::most], count = 0;
  for (; polished != 0; polished &= polished - 1) {
    int i = pixel[count] = std::countr_zero(polished);
    rays[count++] = view_ray(view, float(run.x + i) + place.x, float(run.y) + place.y);
  }
  eval_guides(world, lights, std::span(rays, size_t(count)), std::span(guides, size_t(count)));
  for (int k = 0; k < count; k++) {
    const size_t at = begin + size_t(pixel[k]);
    planes.albedo[at] = guides[k].albedo, planes.normal[at] = guides[k].normal;
    followed[at] = 1;
  }
}

void GuidePass::take(const VisibleRun& run) const {
  RunPixels p;
  const RunGlow emitting = describe_run(run, p);
  const uint64_t polished = first ? run.polished() : 0;
  const size_t begin = size_t(run.y) * size_t(view.width) + size_t(run.x);
  for (int i = 0; i < run.count; i++) {
    const uint64_t bit = uint64_t(1) << i;
    if ((polished & bit) || followed[begin + size_t(i)]) continue;
    Guide guide;
    if (!(emitting.only & bit))
      guide.albedo = vec3(p.surface.red[i], p.surface.green[i], p.surface.blue[i]);
    if (emitting.some & bit) guide.albedo += vec3(p.glow_red[i], p.glow_green[i], p.glow_blue[i]);
    guide.albedo = clamp(guide.albedo, vec3(0), vec3(1));
    if (std::isfinite(run.depth[i])) {
      vec3 n(p.surface.nx[i], p.surface.ny[i], p.surface.nz[i]);
      float length2 = dot(n, n);
      if (length2 > 1e-12f) guide.normal = n / std::sqrt(length2);
    }
    add(begin + size_t(i), guide);
  }
  if (polished) follow(run, polished, begin);
}

}  // namespace

void add_still_guides(const World& world, const Lights& lights, const VisibilityPass& visibility,
                      const View& view, RasterShows shows, int place, GuidePlanes& planes,
                      std::vector<uint8_t>& followed) {
  const size_t pixels = size_t(view.width) * size_t(view.height);
  if (place == 0) {
    planes.albedo.assign(pixels, vec3(0)), planes.normal.assign(pixels, vec3(0));
    followed.assign(pixels, uint8_t(0));
  }
  GuidePass pass{world, lights, view, spread_in_pixel(place), place == 0, planes, followed};
  visibility.see(
      view, pass.place, [&](const VisibleRun& run) { pass.take(run); }, shows);
}

}  // namespace wellspring::picture
