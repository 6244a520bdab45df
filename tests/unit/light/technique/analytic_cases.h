// SPDX-License-Identifier: Apache-2.0
// Scenes whose radiance is known by formula, with the kinds of light each one needs, and the table
// of which technique claims which kinds.
#pragma once
#include <string>
#include <vector>

#include "scenes/scenes.h"
#include "unit/light/statistics.h"

namespace wellspring::test {

enum LightKinds : unsigned {
  seen_lights = 1,  // emission and sky as the eye sees them
  area_light = 2,   // emitting surfaces light a rough one
  punctual_light = 4,
  sky_light = 8,
  panes = 16,            // straight through thin smooth glass
  chains = 32,           // perfect mirrors and solid glass, followed from the eye
  interreflection = 64,  // light between rough surfaces
  caustics = 128,        // light that reaches a rough surface by a mirror or through solid glass
  every_kind = 255,
};

struct Claim {
  const char* technique;
  unsigned kinds;      // LightKinds that it renders without bias
  const char* except;  // light that it leaves out, and why
};
const Claim* find_claim(const std::string& technique);

struct AnalyticCase {
  std::string name;
  Scene scene;
  Ray ray;
  double expected = 0;  // luminance
  unsigned needs = 0;   // LightKinds
  TransportSettings transport = {};
  int spp = 128;
  float tan_half_fov = 0;  // 0: the ray alone; else the mean over a square picture
  // The same scene at another place or strength: not for techniques that prepare themselves for a
  // scene or draw lights for each pass, which costs them more than all their samples.
  bool variant = false;
};

// Cases whose names agree up to the first comma or number are variants of the first of them.
void mark_variants(std::vector<AnalyticCase>& cases);

std::vector<AnalyticCase> direct_light_cases();  // lamps, sky, points, spots over planes
std::vector<AnalyticCase> glass_and_mirror_cases();
std::vector<AnalyticCase> nested_glass_cases();  // solids in, on and across each other
std::vector<AnalyticCase> interreflection_cases();

}  // namespace wellspring::test
