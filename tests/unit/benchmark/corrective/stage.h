// SPDX-License-Identifier: Apache-2.0
// Balls before an eye, each an object, for tests of corrective splatting: what every pixel sees is
// known by a formula.
#pragma once
#include <span>
#include <vector>

#include "benchmark/corrective/warp_and_splat.h"
#include "world/view.h"

namespace wellspring::test {

// Pixels of a footprint of this side around `center`: those before it are as many as those behind
// it, or one fewer.
inline int footprint_begin(int center, int side) { return center - (side - 1) / 2; }

struct Ball {
  uint32_t object = 1;
  vec3 center{0};
  float radius = 1;
};

struct Stage {
  std::vector<Ball> balls;
  // The first ball that the ray through the centre of a pixel meets; object 0: none. The words
  // are a function of object and pixel.
  CorrectiveSample trace(const View& view, ivec2 pixel) const;
  std::vector<uint32_t> objects(const View& view) const;  // each pixel's object
  // A sample for each pixel of the level that shows something, or of all levels.
  std::vector<CorrectiveSample> trace_level(const View& view, const Sqrt5Grid& grid,
                                            int level) const;
  std::vector<CorrectiveSample> trace_all(const View& view, const Sqrt5Grid& grid) const;
};

// A ball as wide as a good part of the picture, and a smaller one that hides some of it; `unit` is
// a metre of theirs in metres.
Stage two_balls(float unit = 1);
// Views the balls from `distance` units before them, turned by `angle` round the first.
View view_of_balls(int width, int height, float angle = 0, float distance = 4, float unit = 1);

// A number for each pixel, bit by bit.
SampleWords number_words(float number);

struct Picture {
  std::vector<SampleWords> color;
  std::vector<uint8_t> level;
  SplatStats stats;
};
// Words are number_words(-1) where no sample is shown.
Picture splat(const SampleStore& store, const View& view, std::span<const uint32_t> object);

// Pixels that differ in a bit from what is traced there, or show something where nothing is.
int count_wrong(const Picture& picture, const Stage& stage, const View& view);

}  // namespace wellspring::test
