// SPDX-License-Identifier: Apache-2.0
// Volumes and their files of bricks, for tests.
#pragma once
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <string>

#include "unit/folder.h"
#include "volume/bricks/write_bricks.h"
#include "volume/draw/shown_volume.h"

namespace wellspring::test {

// Returns a volume of millimetres whose middle is the origin; `value` is given samples.
inline Volume volume_of(glm::ivec3 size, const std::function<uint16_t(glm::ivec3)>& value) {
  Volume volume;
  volume.size = size, volume.kind = SampleKind::u16;
  const size_t count = volume.samples();
  const std::shared_ptr<std::byte[]> bytes(new std::byte[2 * count]);
  size_t i = 0;
  for (int z = 0; z < size.z; z++)
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++, i++) {
        const uint16_t sample = value({x, y, z});
        std::memcpy(&bytes[2 * i], &sample, 2);
      }
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  volume.to_metres = glm::dmat4(0.001);
  volume.to_metres[3] = glm::dvec4(-0.0005 * glm::dvec3(size - 1), 1);
  return volume;
}

// No two neighbours are alike, and all codes occur: a brick that is misplaced shows.
inline uint16_t rough(glm::ivec3 at) {
  return uint16_t((at.x * 7919 + at.y * 104729 + at.z * 1299709) % 65536);
}

// A ball of 3000 with a shell of 1000, in air of 0.
inline Volume shelled_ball(int side) {
  return volume_of(glm::ivec3(side), [&](glm::ivec3 at) {
    const float from = glm::length(glm::vec3(at) - 0.5f * float(side - 1)) / float(side);
    return uint16_t(from < 0.2f ? 3000 : from < 0.4f ? 1000 + 20 * (at.x % 7) : 0);
  });
}

// Writes a volume as bricks, and opens it in a pool of so many slots that no thread fills.
struct Bricked {
  Folder folder;
  double now = 0;  // seconds of the pool's clock
  std::shared_ptr<BrickPool> pool;
  ShownVolume shown;

  Bricked(const Volume& volume, size_t slots, int threads = 0)
      : pool(std::make_shared<BrickPool>(slots * record_bytes, threads, [this] { return now; })) {
    write_bricks(volume, file());
    shown = open_shown_volume(file(), pool);
  }
  std::string file() const { return folder.file("made.bricks"); }
  // Loads what is wished until nothing more can be.
  int load_all() const {
    int times = 0;
    while (pool->load_some()) times++;
    return times;
  }
};

}  // namespace wellspring::test
