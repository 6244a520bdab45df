// SPDX-License-Identifier: Apache-2.0
#include "picture/soften_edges.h"

#include <gtest/gtest.h>

#include "frame/tonemap.h"

namespace wellspring::test {
namespace {

// Through the tone curve as compose_drawn() does, softened, and what the curve says of light that
// was mixed.
void expect_mixed_before_the_curve(std::vector<vec3> light,
                                   const std::vector<std::vector<EdgeShare>>& edges, int codes) {
  Frame frame{.width = int(light.size()), .height = 1, .color = light};
  Image8 image, expected;
  tonemap(frame, {}, image);
  std::vector<uint8_t> peaks;
  for (vec3 c : light) peaks.push_back(uint8_t(eval_peak_codes(all_lanes(max_component(c)))[0]));
  soften_edges(edges, image, peaks);
  soften_edges(edges, frame.color);
  tonemap(frame, {}, expected);
  for (size_t i = 0; i < image.rgb.size(); i++)
    EXPECT_NEAR(image.rgb[i], expected.rgb[i], codes) << "byte " << i;
}

TEST(SoftenEdges, MixesLightNotCodes) {
  std::vector<std::vector<EdgeShare>> edges{{{0, 1, 0.25f}}, {{1, 0, 0.5f}}};
  // A quarter and a half of the light: the first does not see the second's new colour.
  expect_mixed_before_the_curve({vec3(0), vec3(0.7f), vec3(0.01f, 0.02f, 0.03f)}, edges, 1);
}

// Half of a sky that is eight times as bright as white is white, and so is a fifth.
TEST(SoftenEdges, MixesWhatIsBrighterThanWhite) {
  std::vector<std::vector<EdgeShare>> edges{{{0, 1, 0.2f}, {0, 2, 0.1f}}, {{1, 0, 0.5f}}};
  for (float sky : {0.9f, 1.5f, 4.0f, 10.0f, 300.0f})
    expect_mixed_before_the_curve({vec3(0.02f), sky * vec3(0.9f, 0.95f, 1), vec3(0.4f, 0.3f, 0.2f)},
                                  edges, 3);
}

TEST(SoftenEdges, SeveralEdgesNeverTakeMoreThanThereIs) {
  std::vector<vec3> color{vec3(1), vec3(100), vec3(3)};
  std::vector<std::vector<EdgeShare>> edges{{{1, 2, 0.5f}, {1, 0, 0.25f}}};
  soften_edges(edges, color);
  EXPECT_EQ(color[1], vec3(0.25f * 100 + 0.5f * 3 + 0.25f * 1));
  EXPECT_EQ(color[0], vec3(1));
  color = {vec3(1), vec3(100), vec3(3)};
  edges = {{{1, 2, 0.5f}, {1, 0, 0.5f}, {1, 2, 0.5f}, {1, 0, 0.5f}}};
  soften_edges(edges, color);  // the thing is narrower than the pixel
  EXPECT_GE(color[1].x, 1);
  EXPECT_LT(color[1].x, 10);
}

}  // namespace
}  // namespace wellspring::test
