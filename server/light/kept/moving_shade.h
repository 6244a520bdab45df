// SPDX-License-Identifier: Apache-2.0
// Finds how much of the light on a scan is kept away by what moves. Samples find that of meshes
// (light/walk/known_light.h); points of a scan have none, only the light of what stands still.
//
// Soft light is kept away by elements of the moving surfaces (Bunnell 2005, "Dynamic Ambient
// Occlusion and Indirect Lighting", GPU Gems 2, section 14.2), gathered in cells; light of punctual
// lights by shadow rays.
#pragma once
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "light/kept/stand_in_light.h"
#include "light/sample/light_tables.h"
#include "world/world.h"

namespace wellspring::light {

class MovingShade {
 public:
  MovingShade() = default;
  // Reads all that moves and is visible, as it is now. Takes about a millisecond for a figure.
  explicit MovingShade(const World& world);

  bool any() const { return !groups_.empty(); }
  // Returns the box around all places that may have less soft light, scene coordinates.
  const Bounds& bounds() const { return bounds_; }
  bool reaches(vec3 place) const {
    return glm::all(glm::lessThan(bounds_.low, place)) &&
           glm::all(glm::lessThan(place, bounds_.high));
  }
  // Returns the share that is left of the diffuse light on a place that faces along `normal`.
  // `slope`: as StandInLit has it; 0: light comes evenly from all around.
  float eval_open(vec3 place, vec3 normal, vec3 slope) const;
  // Returns the share that is left of light that comes along `way`, unit, from so many metres away.
  float eval_lamp(const World& world, vec3 place, vec3 way, float distance) const;
  // Returns what is left of the light that is known there. Hits on the stand-in, an instance of
  // `world`, nearer than `near` metres are the place itself, which is `width` metres wide.
  vec3 shade(const World& world, const LightTables& tables, vec3 place, vec3 normal,
             const StandInLit& lit, uint32_t stand_in, float near, float width) const;

 private:
  // Holds eight cells, without area where there are fewer.
  struct Cells {
    Lanes3 place;
    Lanes3 front, back;  // areas that face along each axis, and against it
  };
  // Holds what moves close together.
  struct Group {
    Bounds box;
    float reach = 0;  // metres around the box
    std::vector<Cells> cells;
  };
  void add_group(const World& world, const std::vector<uint32_t>& instances, const Bounds& box);
  bool crosses(const Ray& ray) const;

  std::vector<Group> groups_;
  Bounds bounds_;
};

}  // namespace wellspring::light
