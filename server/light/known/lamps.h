// SPDX-License-Identifier: Apache-2.0
// Lamps are switched and dimmed while an exhibit runs. Light adds up, so what costs seconds is made
// once with all of them full, lamp by lamp where it is light itself, and each state is a sum of
// that: milliseconds.
#pragma once
#include <span>
#include <vector>

#include "light/sample/lights.h"

namespace wellspring {

// The lights of `world` as its lamps are now. `all`: of the same world, made and prepared for all
// techniques in use while all lamps were full. A technique of passes has to begin one before the
// next sample.
Lights relit(const Lights& all, const World& world);

// Where light changes by more than a tenth between two states of the lamps, and what becomes of it,
// as cached radiance knows it; of places that it does not know it is guessed by the nearest.
// Without cached radiance: everywhere, and nobody knows how. Made in milliseconds, asked in
// nanoseconds.
class LightChange {
 public:
  // `all`: as for relit().
  LightChange(const Scene& scene, const Lights& all, std::span<const LampLevel> before,
              std::span<const LampLevel> after);
  // At a surface (scene coordinates): of the light that fell there `kept` is left, and `added` is
  // new, both of which stay as they are where nothing is known. Thread-safe.
  bool changes(vec3 place, vec3 normal, vec3& kept, vec3& added) const;

 private:
  struct Known {  // light scattered before, what of it is left, what is new; and reflectance; each
                  // times its weight
    vec3 was{0}, left{0}, added{0}, albedo{0};
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
  std::shared_ptr<const RadianceGrid> grid_;
  std::vector<uint32_t> known_of_;  // of the grid's slots; 0: too little is known
  std::vector<Known> known_;
  Bounds box_;  // around all that changes; of coarser cells:
  float cell_ = 1;
  glm::ivec3 size_{0};
  std::vector<Known> cells_;
};

}  // namespace wellspring
