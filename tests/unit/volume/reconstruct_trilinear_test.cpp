// SPDX-License-Identifier: Apache-2.0
#include "volume/reconstruct/trilinear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace wellspring::test {
namespace {

template <class Sample>
class Trilinear : public ::testing::Test {};
using TrilinearSamples = ::testing::Types<uint8_t, uint16_t, float>;
TYPED_TEST_SUITE(Trilinear, TrilinearSamples);

template <class Sample>
std::vector<Sample> trilinear_noise(size_t count) {
  std::mt19937 random(21);
  std::vector<Sample> samples(count);
  for (Sample& sample : samples)
    sample =
        std::is_same_v<Sample, float> ? Sample(float(random()) / 4294967296.0f) : Sample(random());
  return samples;
}

Lanes3 trilinear_places(std::mt19937& random, glm::ivec3 size) {
  Lanes3 places;
  for (int l = 0; l < lane_count; l++) {
    vec3 at;
    for (int axis = 0; axis < 3; axis++)
      at[axis] = float(random() % 4096) / 4096 * float(size[axis] + 1) - 1;
    places.set(l, at);
  }
  return places;
}

TYPED_TEST(Trilinear, PlanesAreExact) {
  const glm::ivec3 size(7, 6, 5);
  std::vector<TypeParam> samples;
  for (int z = 0; z < size.z; z++)
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++) samples.push_back(TypeParam(2 * x + 3 * y + 8 * z + 1));
  SampleBox<TypeParam> box = whole_box(samples.data(), size);
  box.scale = 0.5f, box.offset = -10;
  for (vec3 at : {vec3(0), vec3(6, 5, 4), vec3(0.5f, 4.25f, 3.75f), vec3(5.5f, 5, 0.25f)}) {
    const float wanted = (2 * at.x + 3 * at.y + 8 * at.z + 1) / 2 - 10;
    EXPECT_EQ(linear_value(box, at), wanted);
    EXPECT_EQ(linear_value(box, all_lanes(at))[5], wanted);
  }
}

TYPED_TEST(Trilinear, EightPlacesAtATimeAreAsOne) {
  std::mt19937 random(4);
  for (glm::ivec3 size :
       {glm::ivec3(9, 8, 7), glm::ivec3(2, 1, 1), glm::ivec3(1, 1, 4000), glm::ivec3(1, 1, 1),
        glm::ivec3(4, 1, 1), glm::ivec3(2, 2, 1), glm::ivec3(1, 9, 3), glm::ivec3(3, 1, 5)}) {
    const auto samples =
        trilinear_noise<TypeParam>(size_t(size.x) * size_t(size.y) * size_t(size.z));
    const SampleBox<TypeParam> box = whole_box(samples.data(), size);
    const float unit = std::is_same_v<TypeParam, float> ? 1 : std::numeric_limits<TypeParam>::max();
    for (int i = 0; i < 100; i++) {
      const Lanes3 places = trilinear_places(random, size);
      const Lanes found = linear_value(box, places);
      for (int l = 0; l < lane_count; l++)
        EXPECT_NEAR(found[l], linear_value(box, places.at(l)), 5e-7f * unit);
    }
  }
}

TYPED_TEST(Trilinear, LanesCanBeInDifferentBricksOfAPool) {
  const glm::ivec3 size(4, 3, 2);
  const int each = 24;
  const auto pool = trilinear_noise<TypeParam>(each * 8);
  SampleBox<TypeParam> box = whole_box(pool.data(), size);
  box.count = each * 8;
  std::mt19937 random(8);
  const Lanes3 places = trilinear_places(random, size);
  const LaneMask first = LaneMask{7, 6, 5, 4, 3, 2, 1, 0} * each;
  const Lanes found = linear_value(box, places, first);
  for (int l = 0; l < lane_count; l++) {
    const SampleBox<TypeParam> own = whole_box(pool.data() + first[l], size);
    EXPECT_NEAR(found[l], linear_value(own, places.at(l)), 5e-7f * std::abs(found[l]));
  }
}

TYPED_TEST(Trilinear, PlacesOutsideAreMovedToTheBorder) {
  const glm::ivec3 size(3, 3, 3);
  const auto samples = trilinear_noise<TypeParam>(27);
  const SampleBox<TypeParam> box = whole_box(samples.data(), size);
  const float far = std::numeric_limits<float>::infinity();
  const Lanes found = linear_value(
      box, Lanes3{{-far, far, NAN, 0, 1e9f}, {0, 9, -NAN, -1, -1e9f}, {0, 2, NAN, 2.5f, far}});
  EXPECT_EQ(found[0], float(samples[0]));
  EXPECT_EQ(found[1], float(samples[26]));
  EXPECT_EQ(found[2], float(samples[0]));
  EXPECT_EQ(found[3], float(samples[18]));
  EXPECT_EQ(found[4], float(samples[20]));
}

TEST(TrilinearFloats, AConstantAndHugeValuesStay) {
  const std::vector<float> constant(27, 0.1f), huge{1e30f, -1e30f, 1e30f, -1e30f};
  const Lanes3 place = all_lanes(vec3(0.3f, 0.7f, 1.9f));
  EXPECT_EQ(linear_value(whole_box(constant.data(), glm::ivec3(3)), place)[0], 0.1f);
  EXPECT_NEAR(linear_value(whole_box(huge.data(), {2, 2, 1}), place)[0], 4e29f, 1e24f);
}

TEST(NormalGrid, PackedNormalsAreWithinATenthOfADegree) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; i++) {
    glm::dvec3 direction;
    for (int axis = 0; axis < 3; axis++) direction[axis] = double(random()) / 2147483648.0 - 1;
    const LaneBits word =
        LaneBits{} + pack_normal(direction * std::pow(10.0, int(random() % 60) - 30));
    const glm::dvec3 found = unpack_normals(word).at(3);
    EXPECT_LT(
        glm::length(glm::cross(found, direction)) / glm::length(found) / glm::length(direction),
        0.1 * double(pi) / 180);
    EXPECT_GT(glm::dot(found, direction), 0);
  }
  EXPECT_EQ(pack_normal({0, 0, 0}), 0u);
}

TEST(NormalGrid, NormalsPointOutOfWhatIsDenseAtBordersToo) {
  Grid grid({4, 5, 6});
  for (float scale : {1e-30f, 1.0f, 1e30f}) {
    for (int i = 0; i < 120; i++)
      grid.values[size_t(i)] = scale * float(2 * (i % 4) - 1 * (i / 4 % 5) + 2 * (i / 20));
    const NormalGrid normals = make_normals(grid);
    for (uint32_t word : normals.words) EXPECT_EQ(word, pack_normal({-2.0 / 3, 1.0 / 3, -2.0 / 3}));
  }
  for (glm::ivec3 flat : {glm::ivec3(1, 1, 1), glm::ivec3(3, 1, 2)})
    for (uint32_t word : make_normals(Grid(flat)).words) EXPECT_EQ(word, 0u);
}

TEST(NormalGrid, NormalsAreMixedAsSamplesAre) {
  std::mt19937 random(6);
  for (glm::ivec3 size : {glm::ivec3(5, 4, 3), glm::ivec3(1, 4, 3), glm::ivec3(2, 1, 1)}) {
    const size_t count = size_t(size.x) * size_t(size.y) * size_t(size.z);
    const std::vector<float> samples = trilinear_noise<float>(count);
    std::vector<uint32_t> words;
    Grid parts[3] = {Grid(size), Grid(size), Grid(size)};
    for (size_t i = 0; i < count; i++) {
      words.push_back(random() & 0x3fffffffu);
      const vec3 normal = unpack_normals(LaneBits{} + words[i]).at(0) / 511.0f;
      for (int axis = 0; axis < 3; axis++) parts[axis].values[i] = normal[axis];
    }
    const SampleBox<float> box = whole_box(samples.data(), size);
    const Lanes3 places = trilinear_places(random, size);
    const LanesLit found = linear_value_and_normal(box, words.data(), places);
    for (int l = 0; l < lane_count; l++) {
      EXPECT_NEAR(found.value[l], linear_value(box, places.at(l)), 5e-7f);
      for (int axis = 0; axis < 3; axis++)
        EXPECT_NEAR(found.normal.at(l)[axis],
                    linear_value(whole_box(parts[axis].values.data(), size), places.at(l)), 1e-6f);
    }
  }
}

}  // namespace
}  // namespace wellspring::test
