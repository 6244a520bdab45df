// SPDX-License-Identifier: Apache-2.0
#include "unit/benchmark/corrective/stage.h"

#include <bit>
#include <cmath>

#include "base/rng.h"

namespace wellspring::test {

CorrectiveSample Stage::trace(const View& view, ivec2 pixel) const {
  CorrectiveSample sample;
  Ray ray = view_ray(view, float(pixel.x) + 0.5f, float(pixel.y) + 0.5f);
  float nearest = std::numeric_limits<float>::infinity();
  for (const Ball& ball : balls) {
    vec3 out = ray.origin - ball.center;
    float half = dot(out, ray.direction),
          root = half * half - dot(out, out) + ball.radius * ball.radius;
    if (root < 0) continue;
    float t = -half - std::sqrt(root);
    if (t <= 0 || t >= nearest) continue;
    nearest = t;
    sample.object = ball.object;
    sample.position = ray.origin + ray.direction * t;
    sample.normal = normalize(sample.position - ball.center);
  }
  uint64_t bits =
      mix64(uint64_t(sample.object) << 40 | uint64_t(pixel.y) << 20 | uint64_t(pixel.x));
  sample.words = {uint32_t(bits), uint32_t(bits >> 20), uint32_t(bits >> 32), ~uint32_t(bits)};
  return sample;
}

std::vector<uint32_t> Stage::objects(const View& view) const {
  std::vector<uint32_t> object;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) object.push_back(trace(view, {x, y}).object);
  return object;
}

std::vector<CorrectiveSample> Stage::trace_level(const View& view, const Sqrt5Grid& grid,
                                                 int level) const {
  std::vector<ivec2> places;
  PixelBox all{0, 0, view.width, view.height};
  list_places(grid, level, all, 0, Sqrt5Places(grid, level, all).count(), places);
  std::vector<CorrectiveSample> samples;
  for (ivec2 place : places) {
    CorrectiveSample sample = trace(view, place);
    sample.level = level;
    if (sample.object != 0) samples.push_back(sample);
  }
  return samples;
}

std::vector<CorrectiveSample> Stage::trace_all(const View& view, const Sqrt5Grid& grid) const {
  std::vector<CorrectiveSample> samples;
  for (int level = 1; level <= grid.levels; level++)
    for (const CorrectiveSample& sample : trace_level(view, grid, level)) samples.push_back(sample);
  return samples;
}

Stage two_balls(float unit) {
  return {{{1, vec3(0), unit}, {2, vec3(0.5f, 0.2f, 1.6f) * unit, 0.4f * unit}}};
}

View view_of_balls(int width, int height, float angle, float distance, float unit) {
  View view{.position = vec3(std::sin(angle), 0, std::cos(angle)) * (distance * unit),
            .right = vec3(std::cos(angle), 0, -std::sin(angle)),
            .forward = vec3(-std::sin(angle), 0, -std::cos(angle)),
            .width = width,
            .height = height};
  return view;
}

SampleWords number_words(float number) { return {std::bit_cast<uint32_t>(number), 1, 2, 3}; }

Picture splat(const SampleStore& store, const View& view, std::span<const uint32_t> object) {
  Picture picture;
  picture.color.assign(object.size(), number_words(-1));
  picture.level.assign(object.size(), 77);
  SplatScratch scratch;
  picture.stats = warp_and_splat(store, view, object, scratch, picture.color, picture.level);
  return picture;
}

int count_wrong(const Picture& picture, const Stage& stage, const View& view) {
  int wrong = 0;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      CorrectiveSample truth = stage.trace(view, {x, y});
      size_t i = size_t(y) * size_t(view.width) + size_t(x);
      SampleWords expected = truth.object ? truth.words : number_words(-1);
      bool right = picture.color[i] == expected && (picture.level[i] != 0) == (truth.object != 0);
      wrong += !right;
    }
  return wrong;
}

}  // namespace wellspring::test
