// SPDX-License-Identifier: Apache-2.0
// Pictures drawn in the background and warped meanwhile, driven by a clock of the test's own and by
// a hand on the renderer.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>
#include <utility>

#include "base/rng.h"
#include "show/http/answer.h"
#include "show/draw/make_picture_job.h"
#include "show/draw/pace.h"
#include "show/draw/picture.h"
#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "show/tick.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct LatePictures : testing::Test, ShowStage {
  std::promise<void> held;

  void begin(int visitors = 1) {
    ShowStage::begin(make_tiny_exhibit(), settings_for("direct", 50));
    for (int i = 0; i < visitors; i++) join(96, 64);
  }
  // Makes the renderer busy from now on, as if a picture took long.
  void hold_renderer() {
    step();
    step();
    while (!show->drawing->renderer.idle()) step();
    show->drawing->renderer.worker.run([wait = held.get_future().share()] { wait.wait(); });
  }
  void release_renderer() {
    held.set_value();
    held = {};
    show->drawing->renderer.worker.wait();
  }
  ~LatePictures() override {
    if (show && !show->drawing->renderer.idle()) held.set_value();
  }
  using ShowStage::truth;
  Image8 truth() { return truth(visitor().place.last_view, 64); }
};

TEST_F(LatePictures, GoOnWhileOneIsDrawn) {
  begin();
  steps(60);
  hold_renderer();
  Image8 before = last_image();
  size_t first = pictures().size();
  uint64_t drawn = show->totals.drawn, warped = show->totals.warped;
  for (int i = 0; i < 6; i++) {
    turn(0.02, 0.5);
    step_on();
  }
  ASSERT_EQ(pictures().size(), first + 6);  // one a tick, each of the newest input
  for (size_t i = first; i < pictures().size(); i++)
    EXPECT_EQ(header(i).seq, seq - 5 + uint32_t(i - first));
  EXPECT_EQ(show->totals.drawn, drawn);
  EXPECT_EQ(show->totals.warped, warped + 6);
  // The sent picture shows the view as it is, not as it was.
  Image8 now = truth(), shown = last_image();
  EXPECT_LT(mean_difference(shown, now), 0.5 * mean_difference(before, now));
  release_renderer();
}

TEST_F(LatePictures, StandingStillIsShownAsDrawn) {
  begin();
  for (int i = 0; i < 20; i++) turn(0.01), step();
  steps(200);
  EXPECT_TRUE(last_header().flags & packet_still);
  EXPECT_EQ(visitor().picture->keyframe.view, visitor().place.last_view);
  EXPECT_LT(mean_difference(last_image(), truth()), 4);
}

TEST_F(LatePictures, SeqNeverGoesBack) {
  begin();
  steps(10);
  for (int i = 0; i < 150; i++) {
    turn(i % 50 < 10 ? 0.9 : 0.03, 1);  // at times too quick for warps
    i % 3 == 0 ? step() : step_on();
  }
  turn(0);
  steps(30);
  ASSERT_GT(pictures().size(), 60u);
  for (size_t i = 1; i < pictures().size(); i++) {
    EXPECT_GE(header(i).seq, header(i - 1).seq);
    EXPECT_EQ(header(i).frame, header(i - 1).frame + 1);
  }
  EXPECT_EQ(last_header().seq, seq);
}

TEST_F(LatePictures, QuickTurnsShowWhatIsDrawn) {
  begin();
  steps(20);
  size_t before = pictures().size();
  for (int i = 0; i < 50; i++) turn(0.5), step();  // four turns a second: some of it is there
  EXPECT_EQ(show->totals.unwarpable, 0u);
  EXPECT_GT(pictures().size(), before + 40);
  before = pictures().size();
  Rng rng(5);  // nothing is to be foreseen of that
  for (int i = 0; i < 50; i++) turn(1.2 + 0.2 * double(rng.next() % 20)), step();
  EXPECT_GT(show->totals.unwarpable, 5u);
  EXPECT_GT(pictures().size(), before + 15);
}

TEST_F(LatePictures, OfQuickTurnsWhatLiesAroundIsDrawnToo) {
  begin();
  for (int i = 0; i < 30; i++) turn(0.01, 0.5), step(0.08);
  EXPECT_EQ(show->totals.surroundings, 1u);
  for (int i = 0; i < 30; i++) turn(0.3), step(0.08);  // a slow machine
  EXPECT_GT(show->totals.surroundings, 2u);
  ASSERT_FALSE(visitor().picture->around.keyframe.empty());
  const View& around = visitor().picture->around.keyframe.view;
  const View& keyframe = visitor().picture->keyframe.view;
  EXPECT_LE(around.width * around.height, keyframe.width * keyframe.height / 7);
  size_t memory = picture_memory(visitor());
  Keyframe kept = std::exchange(visitor().picture->around.keyframe, {});
  EXPECT_GE(memory, picture_memory(visitor()) + kept.color.size() * 8);  // colours and disparities
  visitor().picture->around.keyframe = std::move(kept);

  // Farther than the keyframe shows while nothing can be drawn, so that it alone would not do.
  hold_renderer();
  WarpScratch scratch;
  Image8 alone, with;
  float unknown = 0;
  // The keyframe may be of a view yet to come, and what lies around of an earlier one.
  const VisitorPicture& picture = *visitor().picture;
  bool to_the_left = dot(picture.around.keyframe.view.forward, picture.keyframe.view.right) < 0;
  const View& seen = visitor().place.last_view;
  auto is_beyond = [&] {  // on the side of what lies around
    return (dot(seen.forward, picture.keyframe.view.right) < 0) == to_the_left;
  };
  for (int i = 0; i < 60 && (unknown < 0.17f || !is_beyond()); i++) {
    turn(to_the_left ? 0.03 : -0.03);
    step_on();
    unknown = warp_picture(picture.keyframe, seen, 1, scratch, alone);
  }
  EXPECT_GE(unknown, 0.17f);
  EXPECT_LT(warp_picture(picture.keyframe, picture.around.keyframe, seen, 1, scratch, with),
            0.6f * unknown);
  EXPECT_EQ(last_header().seq, seq);
  EXPECT_LT(mean_difference(last_image(), with), mean_difference(last_image(), alone));
  release_renderer();

  // Soon it is no longer true.
  turn(0);
  steps(160);
  uint64_t drawn = show->totals.surroundings;
  EXPECT_TRUE(visitor().picture->around.keyframe.empty());
  steps(20);
  EXPECT_EQ(show->totals.surroundings, drawn);
}

TEST_F(LatePictures, NothingAroundTheOldPlaceAfterACameraCut) {
  begin();
  for (int i = 0; i < 60; i++) turn(0.3), step(0.08);  // a slow machine
  ASSERT_FALSE(visitor().picture->around.keyframe.empty());
  say(R"({"type":"viewpoint","seq":900,"name":"corner"})");
  for (int i = 0; i < 6; i++) {
    step();
    const Surroundings& around = visitor().picture->around;
    if (visitor().picture->job.camera_cuts == visitor().place.camera_cuts) {
      EXPECT_TRUE(around.keyframe.empty() || around.camera_cuts == visitor().place.camera_cuts);
    }
  }
  EXPECT_EQ(visitor().picture->job.camera_cuts, visitor().place.camera_cuts);
}

// Time counts so that all who walk get as many keyframes; who stands waits for them.
TEST_F(LatePictures, WhoseKeyframesAreDearIsChargedLess) {
  begin(3);
  for (int i = 0; i < 30; i++) turn(0.05, 0.5, 0), turn(0.05, 0.5, 1), step();
  auto visitors = show->visits.visitors.begin();
  Visitor &cheap = *visitors++, &dear = *visitors++, &standing = *visitors;
  cheap.times.whole = 20, dear.times.whole = 40;
  EXPECT_NEAR(20 * charge_weight(show->visits, show->time, cheap),
              40 * charge_weight(show->visits, show->time, dear), 1e-3);
  EXPECT_GT(charge_weight(show->visits, show->time, standing), 2);
  dear.times.whole = 4000;
  EXPECT_GT(charge_weight(show->visits, show->time, dear), 0.3);  // within bounds
}

// A still picture waits for samples, which a visitor who moves on needs no more.
TEST_F(LatePictures, AreGivenUpWhenNobodyNeedsThem) {
  begin();
  steps(60);
  hold_renderer();
  Visitor& one = visitor();
  PictureJob job = make_picture_job(*show, one, 1);
  ASSERT_TRUE(is_still(job));
  EXPECT_FALSE(is_outdated(*show, job, one));
  show->drawing->renderer.drawn = one.link->id;  // as if the renderer were at work on it
  show->drawing->renderer.job = job;
  one.picture->at_work = true;
  step_on();
  EXPECT_FALSE(show->drawing->renderer.given_up);
  turn(0.02);
  step_on();
  EXPECT_TRUE(is_outdated(*show, job, one));
  EXPECT_TRUE(show->drawing->renderer.given_up);
  EXPECT_EQ(last_header().seq, seq);  // meanwhile warped

  Keyframe keyframe = one.picture->keyframe;
  uint64_t drawn = show->totals.drawn;
  release_renderer();
  draw_all(job, one);
  EXPECT_TRUE(one.picture->costs.given_up);
  EXPECT_EQ(one.picture->costs.samples, 0u);
  turn(0.02);
  step();
  EXPECT_EQ(show->totals.given_up, 1u);
  EXPECT_EQ(show->totals.drawn, drawn);
  EXPECT_EQ(one.picture->keyframe.color, keyframe.color);
  EXPECT_EQ(last_header().seq, seq);
  steps(2);
  EXPECT_EQ(show->totals.drawn, drawn + 1);  // the next, after what lies around the visitor now
  EXPECT_FALSE(is_still(one.picture->job));
  EXPECT_FALSE(one.picture->costs.given_up);
}

TEST_F(LatePictures, AreOutdatedByCameraCutsAndByMotionAfterRest) {
  begin();
  Visitor unseen;
  PictureJob job{.expected = unseen.place.last_view, .kind = PictureKind::still};
  unseen.place.last_view.position.x += 1;
  EXPECT_FALSE(is_outdated(*show, job, unseen));  // there is nothing else to show
  unseen.place.camera_cuts++;
  EXPECT_TRUE(is_outdated(*show, job, unseen));
  unseen.picture->job.camera_cuts = job.camera_cuts = unseen.place.camera_cuts;
  unseen.picture->drawn_at = 1;
  EXPECT_TRUE(is_outdated(*show, job, unseen));
  job.kind = PictureKind::moving;  // pictures of who moves are for views to come
  EXPECT_FALSE(is_outdated(*show, job, unseen));
  unseen.left = true;
  EXPECT_TRUE(is_outdated(*show, job, unseen));
}

TEST_F(LatePictures, NothingOfTheOldPlaceAfterACameraCut) {
  begin();
  turn(0, 1);
  steps(20);
  hold_renderer();
  size_t before = pictures().size();
  say(R"({"type":"viewpoint","seq":900,"name":"corner"})");
  for (int i = 0; i < 10; i++) step_on();
  EXPECT_EQ(pictures().size(), before);
  release_renderer();
  steps(4);
  ASSERT_GT(pictures().size(), before);
  EXPECT_EQ(header(before).seq, 900u);
  Image8 there = truth();
  EXPECT_LT(mean_difference(image(before), there), 25);
  // A camera that is put elsewhere is a camera cut as well; a small step is none.
  hold_renderer();
  before = pictures().size();
  say(R"({"type":"camera","seq":901,"position":[3,1.6,-2.95],"yaw":2,"pitch":0})");
  step_on();
  EXPECT_EQ(pictures().size(), before + 1);
  say(R"({"type":"camera","seq":902,"position":[-2,1.6,3],"yaw":2,"pitch":0})");
  for (int i = 0; i < 5; i++) step_on();
  EXPECT_EQ(pictures().size(), before + 1);
  release_renderer();
}

TEST_F(LatePictures, ACameraCutWhileDrawingDiscardsThatPicture) {
  begin();
  turn(0, 1);
  steps(20);
  while (!show->drawing->renderer.drawn) step_on();  // not only its samples are traced
  say(R"({"type":"viewpoint","seq":900,"name":"corner"})");
  size_t before = pictures().size();
  steps(6);
  ASSERT_GT(pictures().size(), before);
  for (size_t i = before; i < pictures().size(); i++) EXPECT_EQ(header(i).seq, 900u);
  EXPECT_LT(mean_difference(image(before), truth()), 25);
}

TEST_F(LatePictures, SizesChangeWhileOneIsDrawn) {
  begin();
  turn(0, 1);
  steps(20);
  for (int width : {64, 120, 16, 96}) {
    say(R"({"type":"settings","width":)" + std::to_string(width) + R"(,"height":64})");
    step_on();
    steps(3);
    EXPECT_EQ(last_header().width, width);
    EXPECT_EQ(last_image().width, width);
  }
}

TEST_F(LatePictures, VisitorsLeaveWhileTheirsIsDrawn) {
  begin(3);
  for (int i = 0; i < 3; i++)
    say(R"({"type":"input","seq":1,"move":[0,0,1],"look":[0.1,0]})", size_t(i));
  steps(30);
  for (int i = 2; i >= 0; i--) {
    say(R"({"type":"input","seq":2,"move":[0,0,1],"look":[0.1,0]})", size_t(i));
    step_on();
    if (i == 1) browsers[size_t(i)].link->mark_closed();
    else say(R"({"type":"bye"})", size_t(i));
    step_on();
    steps(3);
    EXPECT_EQ(show->visits.visitors.size(), size_t(i));
  }
  EXPECT_EQ(show->drawing->renderer.drawn, 0u);
}

// Whenever a picture or its samples are finished, also in the midst of a tick, somebody gets the
// next.
TEST_F(LatePictures, NoVisitorIsForgottenWhenOneIsFinishedDuringATick) {
  begin(3);
  for (int i = 0; i < 3; i++)
    say(R"({"type":"input","seq":1,"move":[0,0,0.2],"look":[0.1,0]})", size_t(i));
  steps(10);
  for (int i = 0; i < 300; i++) {
    for (int k = 0; k < 100; k++) turn(0.001);  // much to hear, which takes most of the tick
    tick(*show, arrivals, now += 0.02);
    take_sent();
    auto at_work = std::count_if(show->visits.visitors.begin(), show->visits.visitors.end(),
                                 [](auto& one) { return one.picture->at_work; });
    ASSERT_EQ(size_t(at_work),
              show->drawing->renderer.asking.size() + (show->drawing->renderer.drawn ? 1 : 0))
        << "tick " << i;
  }
  step();
}

TEST_F(LatePictures, AllVisitorsGetDrawnPictures) {
  begin(3);
  for (int i = 0; i < 3; i++)
    say(R"({"type":"input","seq":1,"move":[0,0,0.2],"look":[0.1,0]})", size_t(i));
  std::vector<int> drawn(3, 0);
  for (int i = 0; i < 120; i++) {
    step();
    if (show->drawing->renderer.drawn) drawn[size_t(show->drawing->renderer.drawn - 1)]++;
  }
  // The renderer's time is shared, not pictures: what one costs differs with the machine's load.
  for (int count : drawn) EXPECT_GT(count, 10);
}

TEST_F(LatePictures, TheShowEndsWhileOneIsDrawn) {
  begin(2);
  for (int i = 0; i < 2; i++)
    say(R"({"type":"input","seq":1,"move":[0,0,1],"look":[0,0]})", size_t(i));
  for (int i = 0; i < 20; i++) step_on();
  while (!show->drawing->renderer.drawn) step_on();
  show.reset();  // sanitizers tell whether the drawing reads what is gone
}

TEST_F(LatePictures, TheShowEndsAfterWhatTheRendererIsAtWorkOn) {
  begin();
  hold_renderer();
  std::atomic<bool> released = false;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    released = true;
    held.set_value();
  });
  show.reset();
  EXPECT_TRUE(released);
  later.join();
}

TEST_F(LatePictures, ReportSaysWhatWasDrawnAndWarped) {
  begin();
  for (int i = 0; i < 40; i++) turn(0.02, 0.5), step();
  ShowReport report = make_report(*show);
  EXPECT_GT(report.totals.drawn, 5u);
  EXPECT_GT(report.totals.warped, report.totals.drawn);
  EXPECT_GT(report.visitors.at(0).drawn_fps, 0);
  std::string text = write_metrics(report);
  for (const char* name :
       {"pictures_drawn_total", "pictures_warped_total", "visitor_drawn_pictures_per_second"})
    EXPECT_NE(text.find("wellspring_" + std::string(name)), std::string::npos) << name;
}

}  // namespace
}  // namespace wellspring::test
