// SPDX-License-Identifier: Apache-2.0
// The storyteller in pictures at rest, drawn by itself between those of the rest.
#include "show/draw/still_pass.h"

#include <gtest/gtest.h>

#include "show/draw/picture.h"
#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

// A storyteller as flat as a door stands before the visitor.
Exhibit make_exhibit() {
  Exhibit exhibit = make_tiny_exhibit();
  StorytellerPlace& storyteller_place = add_storyteller(exhibit, "anna", {-2, 0, 0.5});
  storyteller_place.character.positions = {{-0.4f, 0.6f, 0}, {0.4f, 0.6f, 0}, {0, 2.2f, 0}};
  storyteller_place.character.normals.assign(3, {0, 0, 1});
  storyteller_place.character.appearances[0].base_color = vec4(0.8f, 0.05f, 0.05f, 1);
  return exhibit;
}

struct Moving : testing::Test, ShowStage {
  void SetUp() override {
    tick_seconds = 0.01;
    begin(make_exhibit(), settings_for("direct"));
    join(192, 128);
  }
  template <class Condition>
  bool step_until(const Condition& holds, int most = 600) {
    return ShowStage::step_until(holds, most);
  }
  // A picture of the rest is begun, and not finished.
  bool is_between_steps() {
    return step_until([&] {
      return show->drawing->renderer.drawn && show->drawing->renderer.step != DrawingStep::done;
    });
  }
  bool rested() {
    return step_until(
               [&] { return !show->visits.visitors.empty() && visitor().picture->backdrop; }) &&
           step_until([&] { return show->totals.posed > 20; });
  }
  // Red over green about where the place falls: the room is grey.
  double red_at(const Image8& image, vec3 place) {
    Projected at = project_point(visitor().place.last_view, place);
    double sum = 0;
    for (int dy = -3; dy <= 3; dy++)
      for (int dx = -3; dx <= 3; dx++)
        for (size_t c = 0; c < 2; c++)
          sum += (c == 0 ? 1 : -1) *
                 int(image.rgb[3 * size_t((int(at.y) + dy) * image.width + int(at.x) + dx) + c]);
    return sum / 49;
  }
};

TEST_F(Moving, IsDrawnMoreOftenThanTheRest) {
  ASSERT_TRUE(rested());
  uint64_t drawn = show->totals.drawn, posed = show->totals.posed;
  size_t sent = pictures().size();
  for (int i = 0; i < 200; i++) {
    visitor().times.moving = 1;  // however slow the machine is, which would draw it less often
    step();
  }
  EXPECT_GE(show->totals.drawn, drawn + 2);
  EXPECT_GT(show->totals.posed - posed, 2 * (show->totals.drawn - drawn));
  EXPECT_NEAR(double(pictures().size() - sent), double(show->totals.posed - posed), 2);
  EXPECT_TRUE(visitor().picture->backdrop);
  EXPECT_FALSE(visitor().picture->moving.empty());
  const PictureWindow& window = visitor().picture->moving.window;
  EXPECT_LT(2 * window.width * window.height, 192 * 128);
}

// It is shown where it is by now, though nothing else is drawn anew, and where it was, what lies
// behind.
TEST_F(Moving, ShowsWhereItIs) {
  ASSERT_TRUE(rested());
  steps(200);
  vec3 here(-2, 1, 0.5f), there(-1, 1, 0.5f);
  ASSERT_TRUE(is_between_steps());
  uint64_t drawn = show->totals.drawn, posed = show->totals.posed;
  Image8 before = last_image();
  show->cast.teller.storyteller.placement[3].x += 1;
  ASSERT_TRUE(step_until([&] { return show->totals.posed > posed; }));
  size_t sent = pictures().size();
  ASSERT_TRUE(step_until([&] { return pictures().size() > sent; }));
  Image8 after = last_image();
  EXPECT_LE(show->totals.drawn, drawn + 1);
  EXPECT_GT(red_at(before, here), 40);
  EXPECT_LT(red_at(before, there), 20);
  EXPECT_GT(red_at(after, there), 40);
  EXPECT_LT(red_at(after, here), 20);
}

// A visitor who walks on sees the storyteller in pictures that are warped from the last one.
TEST_F(Moving, IsInWhatIsWarped) {
  ASSERT_TRUE(rested());
  steps(200);
  ASSERT_TRUE(step_until(
      [&] { return visitor().picture->backdrop && !visitor().picture->moving.empty(); }));
  vec3 here(-2, 1, 0.5f);
  double shown = red_at(last_image(), here);
  turn(0.02);
  EXPECT_GT(shown, 40);
  uint64_t warped = show->totals.warped, drawn = show->totals.drawn;
  ASSERT_TRUE(step_until([&] { return show->totals.warped > warped; }));
  // One picture was under way, and a thread that is quicker than this one may draw another.
  EXPECT_LE(show->totals.drawn, drawn + 2);
  step();
  EXPECT_NEAR(red_at(last_image(), here), shown, 8);
  EXPECT_FALSE(visitor().picture->backdrop);
  EXPECT_TRUE(visitor().picture->moving.empty());
}

// A visitor who waits for a picture does not wait for more light of another's.
TEST_F(Moving, OthersNeedNotWaitForLight) {
  ASSERT_TRUE(rested());
  ASSERT_TRUE(step_until([&] {
    show->drawing->samples_per_second = 50000;  // so few that they are traced in several steps
    return show->drawing->renderer.drawn && show->drawing->renderer.step == DrawingStep::trace;
  }));
  size_t traced = show->drawing->renderer.work.traced;
  ASSERT_LT(traced, show->drawing->renderer.work.requests.size());
  join(64, 64);
  ASSERT_TRUE(step_until([&] { return show->drawing->renderer.drawn != visitor().link->id; }, 8));
  EXPECT_EQ(visitor().picture->costs.samples, traced);
  EXPECT_TRUE(step_until([&] { return show->visits.visitors.back().picture->drawn_at > 0; }, 8));
}

// Between the steps of a picture the visitor may go, and the storyteller too.
TEST_F(Moving, WhoLeavesBetweenStepsIsForgotten) {
  ASSERT_TRUE(rested());
  ASSERT_TRUE(is_between_steps());
  browsers[0].link->mark_closed();
  EXPECT_TRUE(step_until([&] { return show->visits.visitors.empty(); }, 50));
  EXPECT_EQ(show->drawing->renderer.drawn, 0u);
}
TEST_F(Moving, WhoIsHiddenIsGoneFromThePicture) {
  ASSERT_TRUE(rested());
  steps(200);
  vec3 here(-2, 1, 0.5f);
  EXPECT_GT(red_at(last_image(), here), 40);
  show->cast.teller.visible = false;
  ASSERT_TRUE(step_until([&] { return !visitor().picture->job.sees_moving; }));
  steps(30);
  EXPECT_LT(red_at(last_image(), here), 20);
  EXPECT_FALSE(visitor().picture->backdrop);
}

// The next picture shows the wall as though the storyteller had never stood there.
TEST_F(Moving, NoGhostStaysWhereSheStood) {
  ASSERT_TRUE(rested());
  steps(200);
  show->cast.teller.visible = false;
  const uint64_t drawn = show->totals.drawn;
  ASSERT_TRUE(step_until(
      [&] { return show->totals.drawn > drawn && !visitor().picture->job.sees_moving; }));
  const size_t sent = pictures().size();
  ASSERT_TRUE(step_until([&] { return pictures().size() > sent; }));
  const Image8 after = last_image();
  ShowStage without{.tick_seconds = 0.01};
  without.begin(make_tiny_exhibit(), settings_for("direct"));
  without.join(192, 128);
  ASSERT_TRUE(without.step_until([&] { return without.show->totals.drawn > 20; }, 600));
  const Image8 never = without.last_image();
  ASSERT_EQ(after.rgb.size(), never.rgb.size());
  const View& view = visitor().place.last_view;
  const Projected head = project_point(view, {-2, 2.2f, 0.5f}),
                  left = project_point(view, {-2.4f, 0.6f, 0.5f}),
                  right = project_point(view, {-1.6f, 0.6f, 0.5f});
  // The storyteller is red, and so would be any remains.
  double red = 0, count = 0;
  for (int y = int(head.y) - 4; y < int(left.y) + 4 && y < after.height; y++)
    for (int x = int(left.x) - 4; x < int(right.x) + 4; x++, count++) {
      const size_t at = 3 * (size_t(y) * size_t(after.width) + size_t(x));
      red +=
          double(after.rgb[at]) - after.rgb[at + 1] - (double(never.rgb[at]) - never.rgb[at + 1]);
      EXPECT_LT(after.rgb[at] - after.rgb[at + 1], 24) << x << ", " << y;
    }
  EXPECT_LT(std::abs(red / count), 1);
}

}  // namespace
}  // namespace wellspring::test
