// SPDX-License-Identifier: Apache-2.0
// Lamps are switched and dimmed while an exhibit runs. Light adds up, so what costs seconds is made
// once with all of them full, lamp by lamp where it is light itself, and each state is a sum of
// that: milliseconds.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/sample/illumination_map.h"
#include "light/sample/lights.h"

namespace wellspring::light {

// Light of each lamp alone, averaged over cells of space and of a surface's main direction. Maps
// tell it at their own surfaces; cells tell it at any place that lies near some of them.

struct LampCells {
  float cell = 1;  // metres a side
  // place_key of each cell where find_place_slot() says, 0: free; and its number.
  std::vector<uint64_t> keys;
  std::vector<uint32_t> number_of;
  // Each cell has its key, the area of surface in it, and the light of what belongs to no lamp,
  // then of each lamp alone.
  std::vector<uint64_t> cells;
  std::vector<float> weight;
  std::vector<std::vector<vec3>> light;
};
inline constexpr uint32_t no_lamp_cell = 0xffffffffu;

// The light that `map` keeps of the world's still surfaces. Tenths of a second at most.
LampCells make_lamp_cells(const World& world, const IlluminationMap& map);
// The number of the cell of a surface there, or no_lamp_cell.
uint32_t find_lamp_cell(const LampCells& cells, vec3 place, vec3 normal);

// The lights of `world` as its lamps are now. `all`: of the same world, made and prepared for all
// techniques in use while all lamps were full. A technique of passes has to begin one before the
// next sample.
Lights relit(const Lights& all, const World& world);

// Where light changes by more than a tenth between two states of the lamps, and what becomes of it,
// as cells of each lamp's light know it; of places that these do not know it is guessed by the
// nearest. Without cells: everywhere, and nobody knows how. Made in milliseconds, asked in
// nanoseconds.
class LightChange {
 public:
  // `all`: as for relit(). `cells` may be null.
  LightChange(const Scene& scene, const Lights& all, std::shared_ptr<const LampCells> cells,
              std::span<const LampLevel> before, std::span<const LampLevel> after);
  // At a surface (scene coordinates): of the light that fell there `kept` is left, and `added` is
  // new, both of which stay as they are where nothing is known. Thread-safe.
  bool changes(vec3 place, vec3 normal, vec3& kept, vec3& added) const;

 private:
  struct Known {  // light that fell there before, what of it is left, what is new; each times its
                  // weight
    vec3 was{0}, left{0}, added{0};
    float weight = 0;
    bool changes = false;  // here, or of guessed ones where they were guessed from
  };
  void fill_cells(const Scene& scene, const Lights& all, std::span<const LampLevel> before,
                  std::span<const LampLevel> after);
  void guess_unknown();
  template <class IsFrom, class Visit>
  std::vector<int> steps_from(const IsFrom& is_from, const Visit& visit) const;
  size_t index_of(glm::ivec3 cell) const;
  size_t cell_at(vec3 place) const;  // in the box
  bool everywhere_ = false;
  std::shared_ptr<const LampCells> exact_;
  std::vector<Known> known_;  // of each of their cells
  Bounds box_;                // around all that changes; of coarser cells:
  float cell_ = 1;
  glm::ivec3 size_{0};
  std::vector<Known> cells_;
};

}  // namespace wellspring::light
