// SPDX-License-Identifier: Apache-2.0
// Reads JSON of VRM's extensions, which is in no schema table: types are checked on reading. Absent
// values are empty; values of another type are refused with their place.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>

#include "base/vec.h"
#include "gltf/file.h"

namespace wellspring::avatar::vrm_json {

using gltf::at;
using gltf::File;
using gltf::json;

const json& object_in(const File& file, const json& object, const char* key,
                      const std::string& where);
const json& list_in(const File& file, const json& object, const char* key,
                    const std::string& where);
std::string text_in(const json& object, const char* key);
// Returns a number, and `otherwise` for anything else.
float number_in(const json& object, const char* key, float otherwise);
// Returns a list of three numbers, or an object with x, y and z as version 0 has it; `otherwise`
// for all else.
vec3 vector_in(const json& object, const char* key, vec3 otherwise);
// Returns an index into the file's list `into`; -1 if the key is absent.
int index_in(const File& file, const json& object, const char* key, const char* into,
             const std::string& where);

}  // namespace wellspring::avatar::vrm_json

namespace wellspring::avatar {

// Decodes colours as version 0 of VRM keeps them, like Unity's materials.

// Decodes by IEC 61966-2-1 up to 1; beyond it, for colours that glow, by a power of 2.2. Below 0:
// 0.
inline vec3 linear_of_unity(vec3 color) {
  vec3 linear(0);
  for (int c = 0; c < 3; c++) {
    float v = std::min(color[c], 1e4f);
    if (!(v > 0)) continue;
    linear[c] = v <= 0.04045f ? v / 12.92f
                : v < 1       ? std::pow((v + 0.055f) / 1.055f, 2.4f)
                              : std::pow(v, 2.2f);
  }
  return linear;
}

}  // namespace wellspring::avatar
