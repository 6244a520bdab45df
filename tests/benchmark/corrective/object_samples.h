// SPDX-License-Identifier: Apache-2.0
// Samples that correct the picture of objects whose light depends on the view, kept for later views
// as long as they hold (Haber, Myszkowski, Yamauchi, Seidel 2001, section 4.5). Each object has its
// own lists of samples, one for each level of the hierarchy of places (sqrt5_grid.h).
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sqrt5_grid.h"
#include "world/view.h"

namespace wellspring::test {

// Holds what a sample shows towards the view that asked, in the caller's words, which are kept as
// they are.
using SampleWords = std::array<uint32_t, 4>;

// A traced place.
struct CorrectiveSample {
  uint32_t object = 0;  // as Frame::object; 0, where nothing is, has no samples
  int level = 1;        // level of the place, see level_of_pixel()
  vec3 position{0};     // relative to Scene::origin, as View::position
  vec3 normal{0};       // any length but 0
  SampleWords words{};
};

// Samples of one object and level, in the order they came in; 44 bytes each.
struct LevelSamples {
  std::vector<float> x, y, z;
  std::vector<uint32_t> normal;  // pack_fine_normal
  std::vector<float> facing;     // cosine between normal and direction to the eye, when traced
  std::vector<float> width;      // metres that a pixel was wide there, when traced
  std::vector<uint32_t> age;     // the camera's, when traced
  std::vector<SampleWords> words;
  int count() const { return int(age.size()); }
};

struct ObjectSamples {
  uint32_t object = 0;
  float delta = 0.1f;
  std::vector<LevelSamples> levels;  // one for each of the grid's
  int count() const;
};

// If there are more samples than a bound allows, the oldest are dropped first, until a sixteenth of
// the bound is free; among samples of one age the finest levels go first.
struct SampleLimits {
  int most_of_object = 1 << 16;
  int most = 1 << 18;
};

struct SampleStore {
  Sqrt5Grid grid = make_sqrt5_grid(4);
  SampleLimits limits;
  std::vector<ObjectSamples> objects;  // by their ids, ascending
  int count() const;
};

// Enters what was traced through pixel centres of `view`. `age`: the camera's, which counts up with
// each change of the camera. Returns how many came in: samples with a number that is not finite, of
// object 0, of an unknown level or not before the eye are refused.
int add_samples(SampleStore& store, const View& view, uint32_t age,
                std::span<const CorrectiveSample> samples);

// Returns how far the cosine may change until a sample is invalid: 0.05 for a mirror up to 0.2 for
// a wholly rough surface, in proportion to the perceptual roughness (glTF 2.0). The range is the
// paper's.
float delta_of(float roughness);
// Sets the delta of an object, also of one that has no samples yet.
void set_delta(SampleStore& store, uint32_t object, float delta);

struct AgeingSettings {
  uint32_t max_age = 300;  // changes of the camera; at most 65535
  int least_samples = 10;  // samples needed to say whether an age is valid: the paper's N_min
};
struct AgeingStats {
  int checked = 0, invalid = 0;  // samples of the levels that were looked at
  int dropped = 0;
};
// Ageing (section 4.5), once for each change of the camera. For each object the first level with at
// least `least_samples` is looked at; if no level has as many, all are. If more than half of the
// samples of an age are invalid there, all samples of that age and object are dropped. `eye`:
// View::position now; `age`: the camera's now. Many threads; the result does not depend on them.
AgeingStats age_samples(SampleStore& store, vec3 eye, uint32_t age,
                        const AgeingSettings& settings = {});

}  // namespace wellspring::test
