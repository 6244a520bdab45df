// SPDX-License-Identifier: Apache-2.0
// Makes daylight: the sky's picture and the sun's disc for a place of the sun and a haziness,
// computed from the air that sunlight passes. Rayleigh scattering, aerosols and ozone around a
// round Earth: single scattering as in Nishita et al. 1993 ("Display of the Earth Taking into
// Account Atmospheric Scattering"), coefficients of Bruneton and Neyret 2008, all further
// scattering taken as isotropic and summed as a geometric series (Hillaire 2020, "A Scalable and
// Production Ready Sky and Atmosphere Rendering Technique", section 5.5). The three channels stand
// for 680, 550 and 440 nm, white is sunlight outside the air.
//
// Units: an irradiance of 1 is 10,000 lux, a radiance of 1 is 10,000 cd/m^2. Outside the air the
// sun gives 128,000 lux, so a clear noon comes to about 10, and to 1 or 2 in the shade.
#pragma once
#include <span>
#include <vector>

#include "world/scene.h"

namespace wellspring::world {

struct SkySettings {
  double elevation = 40;   // degrees of the sun's centre over the horizon, -18 to 90
  double azimuth = 135;    // degrees clockwise from -Z (north) seen from above; 90 is +X (east)
  double turbidity = 2.5;  // optical depth of the air over that of pure air: 1 pure .. 10 hazy
  double strength = 1;     // factor on all of it, 0 to 1e6
};

// Returns what is wrong with the settings, a phrase; nullptr: nothing.
const char* sky_problem(const SkySettings& settings);

// Replaces the scene's environment; appends one image. The ground below the horizon is a grey that
// reflects 0.2. About a tenth of a second. Settings without a problem only.
void add_sky(const SkySettings& settings, Scene& scene);

// Gives a scene without light of any kind a radiance of 1 from everywhere; returns whether it did.
bool add_missing_light(Scene& scene);

// Holds irradiances: of the sun on a surface that faces it, of the sky on the ground.
struct Daylight {
  vec3 sun{0}, sky{0};
};
// Returns daylight with the sun at each of these elevations (degrees) instead of the settings'.
// Milliseconds each.
std::vector<Daylight> eval_daylight(const SkySettings& settings,
                                    std::span<const double> elevations);

}  // namespace wellspring::world
