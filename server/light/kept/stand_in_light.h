// SPDX-License-Identifier: Apache-2.0
// Finds the light that falls on points of a scan: illumination maps have that of the squares which
// stand in for coarser points (Mesh::stands_in), and around each place some of these are averaged.
#pragma once
#include <cstdint>
#include <vector>

#include "light/sample/illumination_map.h"
#include "world/world.h"

namespace wellspring::light {

// Holds diffuse light as IlluminationMap has it, on a surface that faces along some normal.
struct StandInLit {
  vec3 light{0};
  vec3 slope{0};  // as light/material/light_slope.h has it, relative to that normal
  bool known = false;
};

class StandInLight {
 public:
  // Reads the light of all squares of the stand-in, an instance of the world. Takes some tens of
  // milliseconds.
  StandInLight(const World& world, uint32_t instance, const IlluminationMap& map);
  // Returns the light on a place (scene coordinates) that faces along `normal`, unit. Not known: no
  // square is near that faces so.
  StandInLit find(vec3 place, vec3 normal) const;
  float reach() const { return reach_; }  // metres to the farthest square that counts
  size_t memory_bytes() const;

 private:
  struct Side {
    vec3 light{0}, slope{0};
  };
  struct Square {
    vec3 place{0}, normal{0};
    Side front, back;
  };
  void sort_into_cells(std::vector<Square> squares);
  void add(const Square& square, vec3 place, vec3 normal, float& weights, StandInLit& sum) const;

  float reach_ = 0;
  // Squares cell by cell, where each cell begins, and cells by find_place_slot().
  std::vector<Square> squares_;
  std::vector<uint64_t> keys_;
  std::vector<uint32_t> begin_, end_;
};

}  // namespace wellspring::light
