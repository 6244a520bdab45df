// SPDX-License-Identifier: Apache-2.0
// What a visitor's pictures take of memory is bounded, and told.
#include <gtest/gtest.h>

#include "show/answer/answer.h"
#include "show/state/make_show.h"
#include "show/state/show.h"
#include "show/tick.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring {
namespace {

// Walking and turning, for which pictures are made wider, and at rest. Large pictures are drawn in
// between, in memory that all share.
TEST(Memory, PicturesOf1280x720KeepBoundedMemoryAVisitor) {
  ShowSettings settings;
  settings.technique = settings.still_technique = "direct";
  auto show = make_show(make_tiny_exhibit(), settings);
  Arrivals arrivals;
  std::vector<std::shared_ptr<Link>> links;
  const char* sizes[] = {R"("width":1280,"height":720)", R"("width":1920,"height":1080)"};
  for (size_t i = 0; i < 2; i++) {
    links.push_back(std::make_shared<Link>(i + 1, LinkKind::visit, "test"));
    arrivals.put(links.back());
    links.back()->push_text_in(std::string(R"({"type":"hello","exhibit":"",)") + sizes[i] +
                               R"(,"lang":"en","role":"visitor"})");
  }
  double now = 0;
  size_t most[2] = {}, walking = 0;
  bool still[2] = {};  // for some pictures in fine light
  int pictures[2] = {};
  uint64_t last[2] = {};
  int widest = 0;  // picture that was drawn for warps
  for (int i = 0; i < 24 || (i < 4000 && !(still[0] && still[1])); i++) {
    bool walks = i < 8;
    if (i % 4 == 0)
      for (auto& link : links)
        link->push_text_in(R"({"type":"input","seq":)" + std::to_string(i + 1) +
                           R"(,"move":[0,0,)" + (walks ? "0.3" : "0") + R"(],"look":[)" +
                           (walks ? "0.4" : "0") + ",0]}");
    // Keyframes of full resolution, however slow the machine is.
    if (walks)
      for (Visitor& visitor : show->visitors) visitor.times = {};
    tick(*show, arrivals, now += 0.05);
    show->renderer.worker.wait_for(10);
    size_t k = 0;
    for (Visitor& visitor : show->visitors) {
      visitor.shown.encoder->task.wait();
      const VisitorPicture& picture = visitor.picture;
      most[k] = std::max(most[k], picture.memory_bytes);
      if (k == 0 && !picture.job.still) walking = std::max(walking, picture.memory_bytes);
      if (k == 0) widest = std::max(widest, picture.keyframe.view.width);
      still[k] = pictures[k] >= 8;
      if (!picture.job.passing && picture.job.tick != last[k]) pictures[k]++;
      last[k] = picture.job.tick;
      k++;
    }
    for (auto& link : links)
      for (Link::Out out; link->take_out(out);) {}
  }
  EXPECT_TRUE(still[0] && still[1]);
  EXPECT_GT(widest, 1280);  // how much depends on the pace of the machine
  EXPECT_LE(walking, 64'000'000u);
  EXPECT_LE(most[0], size_t(64) << 20);  // samples at rest are kept by themselves, too
  EXPECT_GE(most[0], 50'000'000u);       // all of it is counted
  EXPECT_LE(most[1], (size_t(64) << 20) * 9 / 4);
  EXPECT_GE(double(most[1]), 2.0 * double(most[0]));
  EXPECT_GT(show->renderer.work_bytes, size_t(40) << 20);

  std::string told = write_metrics(make_report(*show));
  EXPECT_NE(told.find("wellspring_visitor_memory_bytes{visitor=\"1\""), std::string::npos);
  EXPECT_NE(told.find("wellspring_drawing_bytes "), std::string::npos);
}

}  // namespace
}  // namespace wellspring
