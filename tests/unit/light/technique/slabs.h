// SPDX-License-Identifier: Apache-2.0
// Layers of clear and tinted matter seen square on: what a stack of them reflects and lets through,
// all reflections to and fro included, without interference (Stokes 1862).
#pragma once
#include <cmath>
#include <span>

#include "scenes/scenes.h"

namespace wellspring::test {

struct Layer {
  double index = 1, kept = 1;  // kept: share of light left after one way through it
};
// Holds shares of flux, the same from both sides if the layers are.
struct Slab {
  double reflects = 0, passes = 1;
};

// Puts `b` behind `a`, as light comes from a's side.
inline Slab stack(Slab a, Slab a_from_behind, Slab b) {
  double echo = 1 - a_from_behind.reflects * b.reflects;
  return {a.reflects + a.passes * a_from_behind.passes * b.reflects / echo,
          a.passes * b.passes / echo};
}

// Sees from inside `first` through all further layers, the last of them without end.
inline Slab see_through(double first, std::span<const Layer> layers) {
  if (layers.empty()) return {};
  double r = std::pow((first - layers[0].index) / (first + layers[0].index), 2);
  Slab face{r, 1 - r};
  Slab rest = see_through(layers[0].index, layers.subspan(1));
  double kept = layers[0].kept;
  return stack(face, face, {rest.reflects * kept * kept, rest.passes * kept});
}

inline Material tinted_glass(float index, double kept_per_metre) {
  Material m = scenes::glass(index, 0, 1);
  m.attenuation_color = vec3(float(kept_per_metre));
  m.attenuation_distance = 1;
  return m;
}

// Between two heights z; `width`: of its sides.
inline void add_slab(Scene& scene, int material, float low, float high, float width = 2) {
  scenes::add_mesh(scene, scenes::box_mesh(material, {width, width, high - low}), "slab",
                   scenes::at({0, 0, 0.5f * (low + high)}));
}

}  // namespace wellspring::test
