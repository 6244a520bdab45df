// SPDX-License-Identifier: Apache-2.0
// Common steps of readers of splats.
#pragma once
#include <cmath>

#include "scan/splats/splat_set.h"

namespace wellspring::scan {

inline constexpr float constant_harmonic = 0.28209479177387814f;

inline float sigmoid(float x) { return 1 / (1 + std::exp(-x)); }
inline vec3 color_of_harmonic(vec3 constant) { return 0.5f + constant_harmonic * constant; }

// Makes all columns so long, for a reader that fills them.
void resize_splats(SplatSet& set, size_t count);

// The last step: leaves splats out that have a value that is not finite, makes turns unit, opacity
// 0 to 1 and scales positive, and says what it changed.
void finish_splats(SplatSet& set);

// Moves all splats: places by `turn * size * place + shift`. The turn may mirror; size is positive.
void move_splats(SplatSet& set, const mat3& turn, float size, vec3 shift);

}  // namespace wellspring::scan
