// SPDX-License-Identifier: Apache-2.0
// Volumes that a function makes, to be drawn.
#pragma once
#include <cstring>
#include <functional>

#include "volume/draw/shown_volume.h"

namespace wellspring::test {

inline constexpr double millimetre = 0.001;

// Returns a volume of millimetres whose middle is the origin.
inline Volume made_volume(glm::ivec3 size, const std::function<float(glm::vec3)>& value) {
  Volume volume;
  volume.size = size, volume.kind = SampleKind::f32;
  const size_t count = volume.samples();
  const std::shared_ptr<std::byte[]> bytes(new std::byte[4 * count]);
  size_t i = 0;
  for (int z = 0; z < size.z; z++)
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++, i++) {
        const float sample = value(glm::vec3(x, y, z) - 0.5f * glm::vec3(size - 1));
        std::memcpy(&bytes[4 * i], &sample, 4);
      }
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  volume.to_metres = glm::dmat4(millimetre);
  volume.to_metres[3] = glm::dvec4(-0.5 * millimetre * glm::dvec3(size - 1), 1);
  return volume;
}

inline float ball_of(glm::vec3 at, float radius) {
  return std::clamp(radius + 0.5f - length(at), 0.0f, 1.0f);
}

}  // namespace wellspring::test
