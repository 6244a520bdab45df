// SPDX-License-Identifier: Apache-2.0
#include "cache/soften_edges.h"

#include <gtest/gtest.h>

using namespace wellspring;

TEST(SoftenEdges, MixesLightNotCodes) {
  Image8 image{3, 1, {0, 0, 0, 255, 255, 255, 10, 20, 30}};
  std::vector<std::vector<EdgeShare>> edges{{{0, 1, 0.25f}}, {{1, 0, 0.5f}}};
  soften_edges(edges, image);
  // A quarter and a half of white's light: the first does not see the second's new colour.
  EXPECT_EQ(image.rgb, (std::vector<uint8_t>{128, 128, 128, 180, 180, 180, 10, 20, 30}));
}

TEST(SoftenEdges, SeveralEdgesNeverTakeMoreThanThereIs) {
  std::vector<vec3> color{vec3(1), vec3(100), vec3(3)};
  std::vector<std::vector<EdgeShare>> edges{{{1, 2, 0.5f}, {1, 0, 0.25f}}};
  soften_edges(edges, color);
  EXPECT_EQ(color[1], vec3(0.75f * (0.5f * 100 + 0.5f * 3) + 0.25f * 1));
  EXPECT_EQ(color[0], vec3(1));
  color = {vec3(1), vec3(100), vec3(3)};
  edges = {{{1, 2, 0.5f}, {1, 0, 0.5f}, {1, 2, 0.5f}, {1, 0, 0.5f}}};
  soften_edges(edges, color);  // of a thing narrower than the pixel
  EXPECT_GT(color[1].x, 1);
  EXPECT_LT(color[1].x, 10);
}
