// SPDX-License-Identifier: Apache-2.0
#include "light/instant/instant_radiosity.h"

#include <algorithm>

#include "base/rng.h"
#include "light/instant/discontinuity_buffer.h"
#include "light/instant/edge_samples.h"
#include "light/sample/light_tables.h"
#include "light/sample/transport.h"

namespace wellspring::light {
namespace {

constexpr int pixels_a_candidate = 2048;
// First passes of a picture whose irradiance is averaged over more than the paper's window; the
// mean of many passes has ever less of that blur.
constexpr uint32_t wide_passes = 4;

}  // namespace

void begin_instant(const World& world, const TransportSettings& settings, const View& view,
                   uint64_t seed, uint32_t index, Lights& lights) {
  // A small picture has no use for more photons than pixels, and choosing must cost less than it
  // saves.
  TransportSettings here = settings;
  int pixels = std::max(64, view.width * view.height);
  here.instant.photons = std::min(settings.instant.photons, pixels);
  here.instant.candidates =
      std::clamp(pixels / pixels_a_candidate, 1, std::max(1, settings.instant.candidates));
  if (here.instant.candidates == 1) here.instant.walks = std::max(1, settings.instant.walks / 4);
  auto pass = std::make_shared<InstantPass>(
      draw_instant_pass({world, *lights.tables}, here, view, seed, index));
  pass->settings = settings;
  pass->seed = seed;
  pass->index = index;
  lights.pass = std::move(pass);
}

void finish_instant(const World& world, const Lights& lights, const View& view,
                    std::span<Sample> samples) {
  if (!lights.pass) return;
  const InstantPass& pass = *lights.pass;
  DiscontinuitySettings settings;
  settings.columns = pass.columns;
  settings.rows = pass.rows;
  std::vector<uint8_t> edges;
  // Lists of lights interleave more coarsely than sets: the second window takes what is left of
  // their pattern.
  DiscontinuitySettings windows[2] = {settings, settings};
  windows[1].columns = windows[1].rows = windows[1].step = 3;
  bool both = pass.index < wide_passes && pass.sets() > 1;
  filter_windows(view, std::span(windows, both ? 2 : 1), samples, &edges);
  refine_edges(world, lights, pass.settings, view, settings, pass.settings.instant.edge_rays,
               mix64(pass.seed ^ 0x6564676573ull), pass.index, edges, samples);
}

}  // namespace wellspring::light
