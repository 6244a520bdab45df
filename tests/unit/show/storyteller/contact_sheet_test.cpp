// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/story_clip.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

int inked(const Frame& frame) {
  int count = 0;
  for (vec3 c : frame.color) count += c == vec3(1);
  return count;
}

TEST(Sheet, TextIsDrawnToScaleAndCutAtTheEdges) {
  Frame frame{120, 40, std::vector<vec3>(120 * 40, vec3(0)), {}, {}, {}};
  Frame large = frame, outside = frame;
  draw_text(frame, "joy", 2, 2, 1, vec3(1));
  draw_text(large, "joy", 2, 2, 2, vec3(1));
  EXPECT_GT(inked(frame), 20);
  EXPECT_EQ(inked(large), 4 * inked(frame));
  EXPECT_EQ(text_width("joy", 2), 2 * text_width("joy", 1));
  draw_text(outside, std::string(300, 'W'), 100, 35, 3, vec3(1));
  draw_text(outside, "above", -500, -500, 3, vec3(1));
  EXPECT_GT(inked(outside), 0);
  draw_text(outside, "\xc3\xa9\n", 0, 0, 1, vec3(1));
}

TEST(Sheet, CellsStandInRowsWithTheirLabels) {
  Character character;
  character.joints.push_back({});
  character.positions = {{-0.5f, 0, 0}, {0.5f, 0, 0}, {0, 1, 0}};
  character.normals.assign(3, vec3(0, 0, 1));
  character.first_weight = {0, 1, 2, 3};
  character.weights.assign(3, {0, 1});
  character.appearances.push_back({});
  character.parts.push_back({"flag", 0, {{0, 1, 2}}});
  std::vector<SheetCell> cells(3, {"one", make_rest_pose(character)});
  PortraitShot shot{.width = 32, .height = 32, .spp = 1};
  std::vector<std::string> warnings;
  Frame sheet = render_sheet(character, cells, shot, 2, warnings);
  EXPECT_EQ(sheet.width, 2 * 36 + 4);
  EXPECT_EQ(sheet.height, 2 * (32 + 12 + 4) + 4);
  ASSERT_EQ(sheet.color.size(), size_t(sheet.width) * size_t(sheet.height));
  auto at = [&](int x, int y) { return sheet.color[size_t(y) * size_t(sheet.width) + size_t(x)]; };
  EXPECT_EQ(at(0, 0), vec3(0.02f));
  EXPECT_NE(at(20, 20), vec3(0.02f));
  EXPECT_EQ(at(36 + 4 + 16, 48 + 20), vec3(0.02f)) << "there is no fourth cell";
  EXPECT_EQ(render_sheet(character, {}, shot, 0, warnings).width, 0);
}

}  // namespace
}  // namespace wellspring::test
