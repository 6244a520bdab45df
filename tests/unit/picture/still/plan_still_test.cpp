// SPDX-License-Identifier: Apache-2.0
// Pixels sampled at rest: all alike, whenever one stops.
#include "picture/still/reconstruct_still.h"

#include <gtest/gtest.h>

#include <map>

#include "scenes/scenes.h"

namespace wellspring::test {
namespace {

using namespace scenes;

View view_of(int width, int height) {
  Scene scene = empty_scene();
  return make_view_towards(scene, {0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 1.0f, width, height);
}

std::map<uint32_t, int> counts_of(const std::vector<Request>& requests) {
  std::map<uint32_t, int> counts;
  for (const Request& request : requests) counts[request.pixel]++;
  return counts;
}

TEST(PlanStill, AQuarterOfASampleIsOneInEverySquare) {
  View view = view_of(64, 36);
  std::vector<Request> requests;
  plan_still(view, 0, 32 * 18, 1, requests);
  ASSERT_EQ(requests.size(), 32u * 18u);
  std::map<uint32_t, int> squares;
  for (const Request& request : requests) {
    uint32_t x = request.pixel % 64, y = request.pixel / 64;
    squares[y / 2 * 32 + x / 2]++;
  }
  EXPECT_EQ(squares.size(), 32u * 18u);
}

TEST(PlanStill, FourRoundsAreEveryPixelOnce) {
  for (ivec2 size : {ivec2(64, 36), ivec2(33, 17), ivec2(1, 1), ivec2(2, 5)}) {
    View view = view_of(size.x, size.y);
    int squares = (size.x + 1) / 2 * ((size.y + 1) / 2);
    std::vector<Request> requests;
    plan_still(view, 0, 4 * squares, 1, requests);
    auto counts = counts_of(requests);
    EXPECT_EQ(counts.size(), size_t(size.x * size.y));
    for (auto [pixel, count] : counts) EXPECT_EQ(count, 1) << pixel;
    for (const Request& request : requests) EXPECT_EQ(request.index, 0u);
    plan_still(view, uint64_t(4 * squares), 4 * squares, 1, requests);
    for (auto [pixel, count] : counts_of(requests)) EXPECT_EQ(count, 2) << pixel;
    EXPECT_EQ(requests.back().index, 1u);
  }
}

TEST(PlanStill, PiecesAreTheSameAsTheWhole) {
  View view = view_of(64, 36);
  std::vector<Request> whole, pieces;
  plan_still(view, 0, 700, 5, whole);
  plan_still(view, 0, 333, 5, pieces);
  plan_still(view, 333, 367, 5, pieces);
  ASSERT_EQ(whole.size(), pieces.size());
  for (size_t i = 0; i < whole.size(); i++) {
    EXPECT_EQ(whole[i].pixel, pieces[i].pixel);
    EXPECT_EQ(whole[i].ray.direction, pieces[i].ray.direction);
    EXPECT_EQ(whole[i].seed, pieces[i].seed);
  }
}

TEST(PlanStill, AnyPartIsSpreadOverThePicture) {
  View view = view_of(128, 72);
  for (uint64_t first : {0u, 1000u, 2304u}) {
    std::vector<Request> requests;
    plan_still(view, first, 64 * 8, 3, requests);  // eight rows of squares
    int parts[4] = {};
    for (const Request& request : requests) parts[request.pixel / 128 / 18]++;
    for (int count : parts) EXPECT_NEAR(count, 128, 70) << first;
  }
}

// A third of the picture counts four times, a third as it is, a third a quarter. As many samples
// are kept as were asked for.
TEST(PlanStill, CellsHaveAsManySamplesAsTheyCount) {
  View view = view_of(96, 36);
  PointImage image;
  resize_image(image, 96, 36);
  for (int cell = 0; cell < 24 * 9; cell++)
    image.weight.push_back(uint8_t(cell % 24 < 8    ? 4 * weight_one
                                   : cell % 24 < 16 ? weight_one
                                                    : weight_one / 4));
  StillSamples kept;
  resize_samples(kept, 96 * 36);
  std::map<std::pair<uint32_t, uint32_t>, int> samples;  // by pixel and the sample's number
  double thirds[3] = {};
  uint64_t next = 0;
  for (int piece = 0; piece < 40; piece++) {
    std::vector<Request> requests;
    next = plan_still(view, next, 900, 3, image, kept, requests);
    EXPECT_EQ(requests.size(), 900u);
    for (const Request& request : requests) {
      EXPECT_EQ(samples[std::pair(request.pixel, request.index)]++, 0);
      kept.count[request.pixel]++;
      thirds[request.pixel % 96 / 32]++;
    }
  }
  EXPECT_NEAR(thirds[0] / thirds[1], 4, 0.2);
  EXPECT_NEAR(thirds[2] / thirds[1], 0.25, 0.05);
  // A pixel that has all samples that are kept asks for no more.
  std::fill(kept.count.begin(), kept.count.end(), uint8_t(most_still_samples));
  std::vector<Request> requests;
  EXPECT_EQ(plan_still(view, 7, 900, 3, image, kept, requests), 7u + 96 * 36);
  EXPECT_TRUE(requests.empty());
}

}  // namespace
}  // namespace wellspring::test
