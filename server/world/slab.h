// SPDX-License-Identifier: Apache-2.0
// Rays against boxes, slab by slab, in a form that compilers turn into vector code: std::fmin and
// std::fmax are calls.
#pragma once

namespace wellspring::world {

// Cuts [near, far] of a ray down to the slab [low, high] of one axis; `inverse`: 1 / direction. A
// ray in the slab's very plane (0 times infinity) is not cut: boxes are asked whether something may
// be met.
inline void cut_by_slab(float low, float high, float origin, float inverse, float& near,
                        float& far) {
  float a = (low - origin) * inverse, b = (high - origin) * inverse;
  float in = a < b ? a : b, out = a < b ? b : a;
  bool known = a + b == a + b;  // else within it all along
  in = known ? in : near;
  out = known ? out : far;
  near = in > near ? in : near;
  far = out < far ? out : far;
}

}  // namespace wellspring::world
