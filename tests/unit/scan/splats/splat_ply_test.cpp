// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "unit/scan/splats/splat_files.h"

namespace wellspring::test {
namespace {
using scan::load_splats;
using scan::SplatSet;

std::string splat_head(size_t count, size_t rest) {
  std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(count) + "\n";
  const auto add = [&head](const std::string& name) { head += "property float " + name + "\n"; };
  for (const char* name : {"x", "y", "z", "nx", "f_dc_0", "f_dc_1", "f_dc_2"}) add(name);
  for (size_t k = 0; k < rest; k++) add("f_rest_" + std::to_string(k));
  for (const char* name :
       {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    add(name);
  return head + "end_header\n";
}

std::string splat_bytes(size_t rest, std::initializer_list<float> turn, float x = 1) {
  ScanBytes to;
  for (const float value : {x, 2.0f, 3.0f, 0.0f, 1.0f, 0.0f, -1.0f}) to.put(value);
  for (size_t k = 0; k < rest; k++) to.put(float(k));
  for (const float value : {0.0f, -INFINITY, 0.0f, 7.0f}) to.put(value);
  for (const float value : turn) to.put(value);
  return to.bytes;
}

TEST(SplatPly, activates_every_degree) {
  const Folder folder;
  for (const auto& [rest, degree] : {std::pair{0, 0}, {9, 1}, {24, 2}, {45, 3}}) {
    const SplatSet set = load_splats(folder.write(
        "a.ply", splat_head(1, size_t(rest)) + splat_bytes(size_t(rest), {2, 0, 0, 0})));
    ASSERT_EQ(set.size(), 1u);
    EXPECT_EQ(set.degree, degree);
    EXPECT_EQ(set.place[0], vec3(1, 2, 3));
    EXPECT_EQ(set.opacity[0], 0.5f);
    EXPECT_EQ(set.scale[0].x, 0.0f);  // a scale of zero stays, as does one of kilometres
    EXPECT_NEAR(set.scale[0].z, std::exp(7.0f), 1e-2f);
    EXPECT_EQ(set.turn[0], quat(1, 0, 0, 0));
    EXPECT_NEAR(set.color[0].x, 0.5f + 0.2820948f, 1e-6f);
    ASSERT_EQ(set.harmonics.size(), size_t(rest) / 3);
    // A channel after the other.
    if (rest > 0) {
      EXPECT_EQ(set.harmonics[1], vec3(1, 1 + rest / 3, 1 + 2 * rest / 3));
    }
    EXPECT_TRUE(set.notices.empty());
  }
  EXPECT_NE(
      refusal_of_splats(folder.write("a.ply", splat_head(1, 10) + splat_bytes(10, {1, 0, 0, 0}))),
      "");
}

TEST(SplatPly, leaves_out_what_is_not_finite_and_turns_what_has_no_turn) {
  const Folder folder;
  const SplatSet set = load_splats(
      folder.write("a.ply", splat_head(4, 9) + splat_bytes(9, {1, 0, 0, 0}, NAN) +
                                splat_bytes(9, {0, 0, 0, 0}, 5) + splat_bytes(9, {NAN, 0, 0, 0}) +
                                splat_bytes(9, {0, 1e30f, 0, 0}, 6)));
  ASSERT_EQ(set.size(), 2u);
  EXPECT_EQ(set.notices.size(), 2u);
  EXPECT_EQ(set.place[0].x, 5);
  EXPECT_EQ(set.place[1].x, 6);
  EXPECT_EQ(set.turn[0], quat(1, 0, 0, 0));
  EXPECT_EQ(set.turn[1], quat(0, 1, 0, 0));
  EXPECT_EQ(set.harmonics.size(), 6u);
  EXPECT_EQ(set.harmonics[4], vec3(1, 4, 7));
}

TEST(SplatPly, survives_damage) {
  const Folder folder;
  const auto read = [](const std::string& path) { load_splats(path); };
  expect_no_harm(folder, "a.ply",
                 splat_head(2, 9) + splat_bytes(9, {1, 0, 0, 0}) + splat_bytes(9, {1, 0, 0, 0}),
                 read);
  EXPECT_NE(
      refusal_of_splats(folder.write("b.ply", splat_head(4'000'000'000, 45))).find("promises"),
      std::string::npos);
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const std::string packed =
      bytes_of_file(scans_folder() / "splats/train-1000/train-1000.compressed.ply");
  expect_no_harm(folder, "c.ply", packed, read, 60);
}

TEST(SplatPly, reads_the_guitar) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const SplatSet set = load_splats((scans_folder() / "splats/guitar.compressed.ply").string());
  EXPECT_EQ(set.size(), 90854u);
  EXPECT_EQ(set.degree, 0);
  EXPECT_TRUE(set.notices.empty());
  vec3 low(1e9f), high(-1e9f);
  for (const vec3 place : set.place) low = glm::min(low, place), high = glm::max(high, place);
  EXPECT_GT(high.y - low.y, 1.0f);  // it stands, and is of a human's size
  EXPECT_LT(glm::length(high - low), 10.0f);
}

// Finds each splat of `lossy` in `whole` by its place, and compares them.
void expect_same_within(const SplatSet& whole, const SplatSet& lossy, float place, float scale,
                        float turn, float color, float harmonic) {
  ASSERT_EQ(whole.size(), lossy.size());
  ASSERT_EQ(whole.degree, lossy.degree);
  std::vector<char> found(whole.size());
  size_t far = 0;
  for (size_t i = 0; i < lossy.size(); i++) {
    size_t best = 0;
    float distance = INFINITY;
    for (size_t k = 0; k < whole.size(); k++)
      if (const float d = glm::length(whole.place[k] - lossy.place[i]); d < distance)
        best = k, distance = d;
    found[best] = 1;
    EXPECT_LT(distance, place);
    const vec3 ratio = glm::abs(glm::log(whole.scale[best]) - glm::log(lossy.scale[i]));
    bool is_near = max_component(ratio) < scale &&
                   turn_distance(whole.turn[best], lossy.turn[i]) < turn &&
                   std::abs(whole.opacity[best] - lossy.opacity[i]) < 0.005f &&
                   max_component(glm::abs(whole.color[best] - lossy.color[i])) < color;
    const size_t all = size_t(scan::splat_harmonics[whole.degree]);
    for (size_t h = 0; h < all; h++)
      is_near = is_near && max_component(glm::abs(whole.harmonics[best * all + h] -
                                                  lossy.harmonics[i * all + h])) < harmonic;
    far += !is_near;
  }
  EXPECT_EQ(far, 0u);
  EXPECT_GE(std::count(found.begin(), found.end(), 1), std::ptrdiff_t(whole.size() - 2));
}

TEST(SplatPly, loses_little_by_compression) {
  WELLSPRING_SKIP_WITHOUT_SCANS();
  const std::string name = (scans_folder() / "splats/train-1000/train-1000").string();
  const SplatSet whole = load_splats(name + ".ply");
  EXPECT_EQ(whole.degree, 3);
  expect_same_within(whole, load_splats(name + ".compressed.ply"), 0.05f, 0.02f, 1e-4f, 0.01f,
                     0.04f);
  expect_same_within(whole, load_splats(name + ".spz"), 3e-4f, 0.04f, 1e-4f, 0.01f, 0.07f);
}

}  // namespace
}  // namespace wellspring::test
