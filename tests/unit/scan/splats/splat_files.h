// SPDX-License-Identifier: Apache-2.0
// Helps tests of splats' files.
#pragma once
#include <zlib.h>

#include <string>

#include "scan/splats/splat_file.h"
#include "unit/scan/format/scan_files.h"

namespace wellspring::test {

inline std::string refusal_of_splats(const std::string& path) {
  return refusal_of([&] { scan::load_splats(path); });
}

inline std::string gzipped(const std::string& bytes) {
  z_stream state{};
  deflateInit2(&state, 6, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&state, bytes.size()) + 64, '\0');
  state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  state.avail_in = uInt(bytes.size());
  state.next_out = reinterpret_cast<Bytef*>(packed.data());
  state.avail_out = uInt(packed.size());
  deflate(&state, Z_FINISH);
  packed.resize(size_t(state.total_out));
  deflateEnd(&state);
  return packed;
}

// How far two turns are apart, up to the sign, which means nothing.
inline float turn_distance(quat a, quat b) { return 1 - std::abs(glm::dot(a, b)); }

// The colour of a splat's harmonics in a direction, by the reference's formula (eval_sh).
inline vec3 harmonics_towards(const scan::SplatSet& set, size_t i, vec3 d) {
  const float x = d.x, y = d.y, z = d.z;
  const float basis[15] = {-0.48860251f * y,
                           0.48860251f * z,
                           -0.48860251f * x,
                           1.09254843f * x * y,
                           -1.09254843f * y * z,
                           0.31539157f * (2 * z * z - x * x - y * y),
                           -1.09254843f * x * z,
                           0.54627421f * (x * x - y * y),
                           -0.59004359f * y * (3 * x * x - y * y),
                           2.89061144f * x * y * z,
                           -0.45704580f * y * (4 * z * z - x * x - y * y),
                           0.37317633f * z * (2 * z * z - 3 * x * x - 3 * y * y),
                           -0.45704580f * x * (4 * z * z - x * x - y * y),
                           1.44530572f * z * (x * x - y * y),
                           -0.59004359f * x * (x * x - 3 * y * y)};
  const int all = scan::splat_harmonics[set.degree];
  vec3 sum(0);
  for (int h = 0; h < all; h++) sum += basis[h] * set.harmonics[i * size_t(all) + size_t(h)];
  return sum;
}

}  // namespace wellspring::test
