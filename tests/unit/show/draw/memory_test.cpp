// SPDX-License-Identifier: Apache-2.0
// What a visitor's pictures take of memory is bounded, and told.
#include <gtest/gtest.h>

#include "show/http/answer.h"
#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

// Walking and turning, for which pictures are made wider, and at rest. Large pictures are drawn in
// between, in memory that all share.
TEST(Memory, PicturesOf1280x720KeepBoundedMemoryAVisitor) {
  ShowStage stage{.tick_seconds = 0.05};
  stage.begin(make_tiny_exhibit(), settings_for("direct"));
  stage.join(1280, 720), stage.join(1920, 1080);
  size_t most[2] = {}, walking = 0;
  bool still[2] = {};  // for some pictures in fine light
  int pictures[2] = {};
  uint64_t last[2] = {};
  int widest = 0;  // picture that was drawn for warps
  for (int i = 0; i < 24 || (i < 4000 && !(still[0] && still[1])); i++) {
    bool walks = i < 8;
    if (i % 4 == 0)
      for (size_t visitor : {0, 1}) stage.turn(walks ? 0.4 : 0, walks ? 0.3 : 0, visitor);
    // Keyframes of full resolution, however slow the machine is.
    if (walks)
      for (Visitor& visitor : stage.show->visits.visitors) visitor.times = {};
    stage.step();
    for (Browser& browser : stage.browsers) browser.pictures.clear();  // else they pile up
    size_t k = 0;
    for (Visitor& visitor : stage.show->visits.visitors) {
      const VisitorPicture& picture = *visitor.picture;
      most[k] = std::max(most[k], picture.memory_bytes);
      if (k == 0 && !is_still(picture.job)) walking = std::max(walking, picture.memory_bytes);
      if (k == 0) widest = std::max(widest, picture.keyframe.view.width);
      still[k] = pictures[k] >= 8;
      if (is_still(picture.job) && picture.job.tick != last[k]) pictures[k]++;
      last[k] = picture.job.tick;
      k++;
    }
  }
  EXPECT_TRUE(still[0] && still[1]);
  EXPECT_GT(widest, 1280);  // how much depends on the pace of the machine
  EXPECT_LE(walking, 64'000'000u);
  EXPECT_LE(most[0], size_t(64) << 20);  // samples at rest are kept by themselves, too
  EXPECT_GE(most[0], 50'000'000u);       // all of it is counted
  EXPECT_LE(most[1], (size_t(64) << 20) * 9 / 4);
  EXPECT_GE(double(most[1]), 2.0 * double(most[0]));
  EXPECT_GT(stage.show->drawing->renderer.work_bytes, size_t(40) << 20);

  std::string told = write_metrics(make_report(*stage.show));
  EXPECT_NE(told.find("wellspring_visitor_memory_bytes{visitor=\"1\""), std::string::npos);
  EXPECT_NE(told.find("wellspring_drawing_bytes "), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
