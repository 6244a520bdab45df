// SPDX-License-Identifier: Apache-2.0
// Implements the discontinuity buffer (Wald et al. 2002, section 4.3): irradiance is averaged over
// neighbouring pixels as long as the surface goes on, so that a pixel profits from its neighbours'
// sets of point lights; reflectance is not touched, so textures stay sharp. Beyond the paper,
// neighbours belong to one object, and distance is measured from the tangent plane, so that a floor
// seen at a grazing angle always goes on.
#pragma once
#include <span>
#include <vector>

#include "light/sample.h"
#include "light/sample/lights.h"
#include "light/transport_settings.h"
#include "world/view.h"

namespace wellspring::light {

struct DiscontinuitySettings {
  int columns = 3, rows = 3;  // pixels of the window; odd
  int step = 1;               // pixels from one that the window reads to the next; at most 3
  float normal = 0.9f;        // least cosine between normals
  float distance = 1;         // greatest distance from each other's tangent plane, in pixels there
};

// Returns whether the surface goes on between two pixels. `pixel`: angle of a pixel. Symmetric.
bool is_continuous(const Sample& a, const Sample& b, const DiscontinuitySettings& settings,
                   float pixel);

// Returns whether two neighbouring pixels need more than one ray each, because a surface, or its
// colour, ends between them. Symmetric.
bool is_edge(const Sample& a, const Sample& b, const DiscontinuitySettings& settings, float pixel);

// Makes samples[y * width + x].smooth a weighted mean over the window's continuous neighbours. If n
// pixels are continuous with one and m with the other, each counts 1 / max(n, m) for the other and
// the rest for itself: in the middle of a surface this is the plain mean, and nowhere is light won
// or lost, so that a picture's mean stays what it was. Windows are up to 7 x 7. `edges`, if wanted,
// is not 0 for each pixel with is_edge between it and one of the eight around it. Uses all cores.
// Several windows are applied one after the other; edges are those of the first one.
void filter_windows(const View& view, std::span<const DiscontinuitySettings> windows,
                    std::span<Sample> samples, std::vector<uint8_t>* edges = nullptr);

// Sends more rays from the eye to edges: light is smooth and costs most, surfaces and colours that
// reflect it end sharply and cost little. After the discontinuity buffer, pixels whose neighbours
// show another surface or another colour get more rays; each finds a surface and takes the light of
// the nearest pixel that shows the same one. If no pixel does, the ray's place is lit by itself.
// (The paper of instant_radiosity.h antialiases by accumulating pictures alone, section 4.)

// Makes samples[y * width + x], filtered, means over `rays` more samples a pixel at `edges`, which
// are filter_windows()'s. `lights.pass` is the pass they were traced in.
void refine_edges(const World& world, const Lights& lights, const TransportSettings& settings,
                  const View& view, const DiscontinuitySettings& continuity, int rays,
                  uint64_t seed, uint32_t index, std::span<const uint8_t> edges,
                  std::span<Sample> samples);

}  // namespace wellspring::light
