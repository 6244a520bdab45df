// SPDX-License-Identifier: Apache-2.0
// What a curator sees wrong at once when looking, found by rays: somebody stands in a wall, there
// is nothing to see, the scene is tiny or huge, lamps are far too bright.
#pragma once
#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "world/world.h"

namespace wellspring::show {

// Files in centimetres or miles, found out by their size.

// The scale that makes metres of a scene `largest` units across: 1 unless a visitor whose eye is
// `eye_height` metres high would take it for a toy (a tenth of that) or a country (250 times); a
// power of ten, for countries at most 0.01.
inline double propose_scale(double largest, double eye_height) {
  constexpr double toy = 0.1, country = 250, whole_toy = 0.3, whole_country = 30;
  double scale = 1;
  if (largest > country * eye_height)
    for (scale = 0.01; largest * scale > whole_country * eye_height;) scale /= 10;
  else if (largest > 0 && largest < toy * eye_height)
    while (largest * scale < whole_toy * eye_height) scale *= 10;
  return scale;
}

// Returns whether `place` (relative to Scene::origin) lies in something solid: rays to nearly all
// sides first meet the backs of surfaces that are no glass. Moving things do not count. `inside`
// becomes the name of the nearest thing that these belong to.
bool is_in_solid(const World& world, vec3 place, std::string& inside);

// Whether what stands still is in view. Eyes look through the backs of single-sided faces, so from
// some sides nothing may be there.
bool sees_something(const World& world, const Viewpoint& viewpoint);

// Notes about places, views and size. Milliseconds.
void check_places(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems);

// Notes lawns that have no ground. Takes tenths of a second for 100,000 blades.
void check_lawns(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems);

// Notes what visitors see from behind though its material has one side: bakes keep light of fronts
// (light/kept/charts.h). Takes milliseconds.
void check_sides(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems);

// A note where the light that the package carries (light.maps) is of another scene, or damaged.
void check_shipped_light(const Exhibit& exhibit, std::vector<Problem>& problems);

// Notes about lamps and exposure; draws coarse pictures, as exhibit_lights.h has it. `world` is of
// exhibit.scene alone.
void check_light(const Exhibit& exhibit, World& world, std::vector<Problem>& problems);

}  // namespace wellspring::show
