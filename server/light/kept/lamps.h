// SPDX-License-Identifier: Apache-2.0
// Follows lamps that are switched and dimmed while an exhibit runs. Light adds up, so what costs
// seconds is made once with all lamps full, lamp by lamp if it is light itself, and each state is a
// sum of that, made in milliseconds.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/sample/illumination_map.h"
#include "light/sample/lights.h"

namespace wellspring::light {

// Averages the light of each lamp alone over cells of space and of a surface's main direction. Maps
// have that light at their own surfaces only; cells have it at any place that lies near some of
// them.

struct LampCells {
  float cell = 1;  // side of a cell, metres
  // place_key of each cell at the slot that find_place_slot() returns, 0: free; and its number.
  std::vector<uint64_t> keys;
  std::vector<uint32_t> number_of;
  // Each cell has its key, the area of surface in it, and the light of each of the map's layers.
  std::vector<uint64_t> cells;
  std::vector<float> weight;
  std::vector<std::vector<vec3>> light;
};
inline constexpr uint32_t no_lamp_cell = 0xffffffffu;

// Averages the light that `map` keeps of the world's still surfaces. Takes tenths of a second at
// most.
LampCells make_lamp_cells(const World& world, const IlluminationMap& map);
// Returns the number of the cell of a surface there, or no_lamp_cell.
uint32_t find_lamp_cell(const LampCells& cells, vec3 place, vec3 normal);

// Returns the lights of `world` as its lamps are now. `all`: lights of the same world, made and
// prepared for all techniques in use while all lamps were full. A technique of passes has to begin
// one before the next sample.
Lights relit(const Lights& all, const World& world);

// Tells where light changes by more than a tenth between two states of the lamps, and how, from
// cells of each lamp's light; places outside these cells take the light of the nearest one. Without
// cells light may change everywhere, in an unknown way. It is made in milliseconds and asked in
// nanoseconds.
class LightChange {
 public:
  // `all`: as for relit(). `cells` may be null.
  LightChange(const Scene& scene, const Lights& all, std::shared_ptr<const LampCells> cells,
              std::span<const LampLevel> before, std::span<const LampLevel> after);
  // Returns whether light changes at a surface (scene coordinates): of the light that fell there
  // `kept` is left, and `added` is new; both stay as they are if the cells do not tell.
  // Thread-safe.
  bool changes(vec3 place, vec3 normal, vec3& kept, vec3& added) const;

 private:
  // Light that fell there before, its part that is left, new light; in `cells_` each times the
  // weight
  struct Known {
    vec3 was{0}, left{0}, added{0};
    float weight = 0;
    bool changes = false;  // light changes here; guessed cells: by distance to such a cell
  };
  void fill_cells(const Scene& scene, const Lights& all, std::span<const LampLevel> before,
                  std::span<const LampLevel> after);
  void guess_unknown();
  template <class IsFrom, class Visit>
  std::vector<int> steps_from(const IsFrom& is_from, const Visit& visit) const;
  size_t index_of(glm::ivec3 cell) const;
  size_t cell_at(vec3 place) const;  // place in the box
  bool everywhere_ = false;
  std::shared_ptr<const LampCells> exact_;
  std::vector<Known> known_;  // one for each cell of exact_
  Bounds box_;                // bounds of all that changes; the next fields are coarser cells in it
  float cell_ = 1;
  glm::ivec3 size_{0};
  std::vector<Known> cells_;
};

}  // namespace wellspring::light
