// SPDX-License-Identifier: Apache-2.0
// What is drawn when: a table with a row for every rule.
#include "show/draw/decide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace wellspring::test {

void PrintTo(const Decision& one, std::ostream* out) {
  static const char* names[] = {"nothing", "moving",  "skin", "go_on",
                                "lens",    "samples", "pass", "picture"};
  *out << names[int(one.what)] << " of " << one.visitor << (one.hurry ? ", in a hurry" : "")
       << ", kind " << int(one.kind);
}

void PrintTo(const Demand& one, std::ostream* out) {
  *out << one.waiting << " wait" << (one.moving ? ", what moves is due" : "");
}

namespace {
constexpr double now = 100;  // show time
using States = std::vector<VisitorDrawState>;
// Returns a walking visitor whose last picture was sent, and whose next is not due for a second.
VisitorDrawState walker() {
  VisitorDrawState state{
      .welcomed = true, .can_take = true, .drawn_at = now, .shown_at = now, .moved_at = now};
  return state;
}

// Returns a visitor who has stood for a while: nothing changes in the picture.
VisitorDrawState stander() {
  VisitorDrawState state = walker();
  state.stands = state.same_view = true;
  state.moved_at = now - 20;
  return state;
}

// Returns a visitor before whom the storyteller stands, drawn by itself over a picture at rest.
VisitorDrawState listener() {
  VisitorDrawState state = stander();
  state.sees_moving = state.drew_moving = state.backdrop = true;
  state.posed_at = now;
  return state;
}

// Returns a visitor whose picture is a reconstruction.
VisitorDrawState reconstructed() {
  VisitorDrawState state = stander();
  state.rest.reconstructed = true;
  state.rest.samples = state.rest.passed_samples = 4;
  state.rest.passed_at = now - 10;
  state.rest.passed_seconds = 1;
  return state;
}

// Returns a visitor for whom a picture is due.
VisitorDrawState due(VisitorDrawState state, double seconds_ago = 2) {
  state.drawn_at = now - seconds_ago;
  return state;
}

// Returns a visitor for whom the moving picture is due.
VisitorDrawState moving_due(VisitorDrawState state, double seconds_ago = 2) {
  state.posed_at = now - seconds_ago;
  return state;
}

// Returns a visitor who wants pictures all the time, and was shown the last one when it was drawn.
VisitorDrawState hurried() {
  VisitorDrawState state = walker();
  state.picture_rate = 60;
  state.drawn_at = state.shown_at = state.came_at = now;
  return state;
}

struct Row {
  const char* rule;
  std::function<void(States&, RendererState&)> given;
  Decision expected;
};

const std::vector<Row> rows = {
    {"nobody is there: nothing is drawn", [](States&, RendererState&) {}, {}},
    {"what the renderer has in hand is waited for",
     [](States& all, RendererState& renderer) {
       all = {due(walker())};
       renderer.idle = false;
     },
     {}},
    {"who has not been welcomed gets no picture",
     [](States& all, RendererState&) {
       all = {due(walker())};
       all[0].welcomed = false;
     },
     {}},
    {"whose browser or socket cannot take one gets no picture",
     [](States& all, RendererState&) {
       all = {due(walker())};
       all[0].can_take = false;
     },
     {}},
    {"a walker gets pictures at its rate",
     [](States& all, RendererState&) {
       all = {due(walker(), 0.99), due(walker(), 1)};
     },
     {Drawing::picture, 1}},
    {"who walks fast enough for it gets them as often as they are shown, not as they are drawn",
     [](States& all, RendererState&) {
       all = {due(walker(), 0.5)};
       all[0].picture_rate = 4;
       all[0].drawing_rate = 1;
     },
     {Drawing::picture, 0}},
    {"who stands gets them as often as pictures at rest are drawn",
     [](States& all, RendererState&) {
       all = {due(stander(), 0.5)};
       all[0].picture_rate = 4;
       all[0].drawing_rate = 1;
     },
     {}},
    {"a new place is drawn at once",
     [](States& all, RendererState&) {
       all = {stander()};
       all[0].new_place = all[0].unshown = true;
     },
     {Drawing::picture, 0, false, PictureKind::still}},
    {"who stands is shown one picture before the next is drawn",
     [](States& all, RendererState&) {
       all = {due(stander())};
       all[0].unshown = true;
     },
     {}},
    {"a walker's next is drawn before the last was sent: that is warped meanwhile",
     [](States& all, RendererState&) {
       all = {due(walker())};
       all[0].unshown = true;
     },
     {Drawing::picture, 0}},
    {"who rests sees switched lamps at once",
     [](States& all, RendererState&) {
       all = {stander()};
       all[0].other_light = true;
     },
     {Drawing::picture, 0, false, PictureKind::still}},
    {"a walker sees switched lamps in its next picture",
     [](States& all, RendererState&) {
       all = {walker()};
       all[0].other_light = true;
     },
     {}},
    {"who rests sees at once that the storyteller came or went",
     [](States& all, RendererState&) {
       all = {stander()};
       all[0].sees_moving = true;
     },
     {Drawing::picture, 0, false, PictureKind::still}},
    {"who has waited longest comes first",
     [](States& all, RendererState&) {
       all = {due(walker(), 2), due(walker(), 4), due(walker(), 3)};
     },
     {Drawing::picture, 1}},
    {"a newcomer comes before who was drawn since then, and after who was not",
     [](States& all, RendererState&) {
       all = {due(walker(), 2), due(walker(), 4), walker()};
       all[2].drawn_at = -1e9;
       all[2].came_at = now - 3;
       all[2].new_place = true;
     },
     {Drawing::picture, 1}},
    {"and does not wait until theirs are due",
     [](States& all, RendererState&) {
       all = {due(walker(), 0.9), due(walker(), 0.5), walker()};
       all[2].drawn_at = -1e9;
       all[2].came_at = now;
       all[2].new_place = true;
     },
     {Drawing::picture, 2}},
    {"who has had least of the renderer's time comes before who has waited longest",
     [](States& all, RendererState&) {
       all = {due(walker(), 4), due(walker(), 2), due(walker(), 3)};
       all[0].served = 0.3, all[1].served = 0.1, all[2].served = 0.2;
     },
     {Drawing::picture, 1, false, PictureKind::moving, 0.1}},
    {"who wanted no pictures for a while has saved up no time",
     [](States& all, RendererState& renderer) {
       all = {due(walker(), 2), due(walker(), 4)};
       all[0].served = 0.1, all[1].served = renderer.served = 0.5;
     },
     {Drawing::picture, 1, false, PictureKind::moving, 0.5}},
    {"a walker who was shown none for half a second comes first, and keeps back nobody else",
     [](States& all, RendererState&) {
       all = {due(walker(), 0.7), due(walker(), 0.6), due(walker(), 2)};
       all[0].served = 0.3, all[1].served = 0.2, all[2].served = 0.1;
       all[0].shown_at = now - 0.55, all[1].shown_at = now - 0.4, all[2].shown_at = now - 0.2;
       for (VisitorDrawState& one : all) one.picture_rate = 60;
     },
     {Drawing::picture, 0, false, PictureKind::moving, 0.1}},
    {"not one whose picture at rest is only to become better",
     [](States& all, RendererState&) {
       all = {due(stander(), 9), due(walker(), 2)};
       all[0].served = 0.3, all[1].shown_at = now - 0.2;
       all[0].shown_at = now - 9;
     },
     {Drawing::picture, 1}},
    {"of two who wait alike the first comes first",
     [](States& all, RendererState&) {
       all = {due(walker()), due(walker())};
     },
     {Drawing::picture, 0}},
    {"what moves is drawn over a picture at rest, at its own rate",
     [](States& all, RendererState&) {
       all = {moving_due(listener(), 0.99), moving_due(listener())};
     },
     {Drawing::moving, 1}},
    {"what moves comes before pictures",
     [](States& all, RendererState&) {
       all = {due(walker()), moving_due(listener())};
     },
     {Drawing::moving, 1}},
    {"what moves comes between the steps of the same visitor's picture",
     [](States& all, RendererState& renderer) {
       all = {moving_due(listener())};
       all[0].at_work = true;
       renderer.drawn = 0;
     },
     {Drawing::moving, 0}},
    {"what moves waits for the visitor's samples",
     [](States& all, RendererState&) {
       all = {moving_due(listener())};
       all[0].at_work = true;
     },
     {}},
    {"what moves is not laid over a picture that nobody has seen yet",
     [](States& all, RendererState&) {
       all = {moving_due(listener())};
       all[0].unshown = true;
     },
     {}},
    {"over a picture of another view nothing is laid",
     [](States& all, RendererState&) {
       all = {moving_due(listener())};
       all[0].same_view = false;
     },
     {}},
    {"light on what moves is found five times a second where somebody sees it",
     [](States& all, RendererState& renderer) {
       all = {listener()};
       renderer.has_skin = true;
       renderer.skin_at = now - 0.2;
     },
     {Drawing::skin, 0}},
    {"in the world of each who sees it in turn",
     [](States& all, RendererState& renderer) {
       all = {listener(), stander(), listener()};
       renderer.has_skin = true;
       renderer.skin_turn = 7;
     },
     {Drawing::skin, 2}},
    {"and not more often",
     [](States& all, RendererState& renderer) {
       all = {listener()};
       renderer.has_skin = true;
       renderer.skin_at = now - 0.19;
     },
     {}},
    {"nor sooner than it is due where it is small",
     [](States& all, RendererState& renderer) {
       all = {listener()};
       renderer.has_skin = true;
       renderer.skin_at = now - 0.3, renderer.skin_interval = 0.4;
     },
     {}},
    {"light on what moves is not found where nobody sees it",
     [](States& all, RendererState& renderer) {
       all = {stander()};
       renderer.has_skin = true;
     },
     {}},
    {"light on what moves comes after what moves and before what is begun",
     [](States& all, RendererState& renderer) {
       all = {due(walker()), listener()};
       renderer.has_skin = true;
       renderer.drawn = 0;
     },
     {Drawing::skin, 1}},
    {"a picture that is begun goes on before the next",
     [](States& all, RendererState& renderer) {
       all = {due(stander()), due(walker(), 9)};
       all[0].at_work = true;
       renderer.drawn = 0;
     },
     {Drawing::go_on, 0}},
    {"where others wait, it is drawn with the samples that it has by then",
     [](States& all, RendererState& renderer) {
       all = {due(stander()), due(walker(), 9)};
       renderer.drawn = 0;
       renderer.traces = true;
       renderer.waiting = 1;
     },
     {Drawing::go_on, 0, true}},
    {"its other steps are not left out",
     [](States& all, RendererState& renderer) {
       all = {due(stander()), due(walker(), 9)};
       renderer.drawn = 0;
       renderer.waiting = 1;
     },
     {Drawing::go_on, 0, false}},
    {"a glass comes after what is begun",
     [](States& all, RendererState& renderer) {
       all = {due(stander()), stander()};
       all[1].lens_due = true, renderer.drawn = 0;
     },
     {Drawing::go_on, 0}},
    {"a glass comes before samples and pictures, whoever waited longest first",
     [](States& all, RendererState&) {
       all = {due(stander()), stander(), stander()};
       all[1].lens_due = all[2].lens_due = true;
       all[1].lens_at = now - 1, all[2].lens_at = now - 2;
     },
     {Drawing::lens, 2}},
    {"while a glass moves the picture that rests is left as it is",
     [](States& all, RendererState&) { (all = {due(stander())})[0].lens_moves = true; },
     {}},
    {"no glass is drawn while the picture of its visitor is",
     [](States& all, RendererState&) {
       all = {stander()}, all[0].lens_due = all[0].at_work = true;
     },
     {}},
    {"samples that were asked for come before the next picture",
     [](States& all, RendererState&) {
       all = {due(walker()), walker()};
       all[1].asked_seconds = 0.01;
     },
     {Drawing::samples}},
    {"a reconstruction goes on while nobody waits",
     [](States& all, RendererState& renderer) {
       all = {stander()};
       all[0].in_pass = renderer.in_pass = true;
     },
     {Drawing::pass}},
    {"others' pictures come before it",
     [](States& all, RendererState& renderer) {
       all = {due(stander(), 9), due(walker())};
       all[0].in_pass = renderer.in_pass = true;
       renderer.waiting = 1;
     },
     {Drawing::picture, 1}},
    {"half a second after a visitor stands its picture becomes a reconstruction",
     [](States& all, RendererState& renderer) {
       all = {due(stander())};
       all[0].moved_at = now - 0.5;
       all[0].rest.samples = 0.25;
       renderer.can_reconstruct = true;
     },
     {Drawing::picture, 0, false, PictureKind::reconstruction}},
    {"not sooner",
     [](States& all, RendererState& renderer) {
       all = {due(stander())};
       all[0].moved_at = now - 0.49;
       all[0].rest.samples = 1;
       renderer.can_reconstruct = true;
     },
     {Drawing::picture, 0, false, PictureKind::still}},
    {"not of fewer samples than a quarter a pixel",
     [](States& all, RendererState& renderer) {
       all = {due(stander())};
       all[0].rest.samples = 0.24;
       renderer.can_reconstruct = true;
     },
     {Drawing::picture, 0, false, PictureKind::still}},
    {"not where what moves would be in it",
     [](States& all, RendererState& renderer) {
       all = {due(listener())};
       all[0].backdrop = false;
       all[0].rest.samples = 1;
       renderer.can_reconstruct = true;
     },
     {Drawing::picture, 0, false, PictureKind::still}},
    {"not where there is no network",
     [](States& all, RendererState&) {
       all = {due(stander())};
       all[0].rest.samples = 1;
     },
     {Drawing::picture, 0, false, PictureKind::still}},
    {"who has a reconstruction gets samples alone",
     [](States& all, RendererState& renderer) {
       all = {due(reconstructed())};
       renderer.can_reconstruct = true;
     },
     {Drawing::picture, 0, false, PictureKind::samples}},
    {"the next one begins at 1.4 times as many samples",
     [](States& all, RendererState& renderer) {
       all = {due(reconstructed())};
       all[0].rest.samples = 1.4 * 4;
       renderer.can_reconstruct = true;
     },
     {Drawing::picture, 0, false, PictureKind::reconstruction}},
    {"passes take a third of the time at most",
     [](States& all, RendererState& renderer) {
       all = {due(reconstructed())};
       all[0].rest.samples = 8;
       all[0].rest.passed_at = now - 1.8;
       renderer.can_reconstruct = true;
     },
     {Drawing::picture, 0, false, PictureKind::samples}},
    {"the last one has all samples that are kept",
     [](States& all, RendererState& renderer) {
       all = {due(reconstructed())};
       all[0].rest.samples = most_rest_samples;
       all[0].rest.passed_samples = 0.9 * most_rest_samples;
       renderer.can_reconstruct = true;
     },
     {Drawing::picture, 0, false, PictureKind::reconstruction}},
    {"of a reconstruction in other light a drawn picture is made",
     [](States& all, RendererState& renderer) {
       all = {due(reconstructed())};
       all[0].other_light = true;
       all[0].rest.samples = 4;
       renderer.can_reconstruct = true;
     },
     {Drawing::picture, 0, false, PictureKind::still}},
    {"where others wait, who only gains by samples does without",
     [](States& all, RendererState& renderer) {
       all = {due(reconstructed(), 9), due(walker())};
       renderer.can_reconstruct = true;
       renderer.waiting = 1;
     },
     {Drawing::picture, 1}},
};

TEST(Decide, every_rule_of_the_table) {
  for (const Row& row : rows) {
    States states;
    RendererState renderer;
    row.given(states, renderer);
    EXPECT_EQ(decide(now, states, renderer), row.expected) << row.rule;
  }
}

double max_of(const std::vector<double>& all) { return *std::max_element(all.begin(), all.end()); }

// Visitors whose pictures take as long as each says, drawn one after the other for a minute: the
// longest time that each went without one.
std::vector<double> longest_gaps(const std::vector<double>& costs) {
  States all(costs.size(), hurried());
  RendererState renderer;
  std::vector<double> gaps(costs.size(), 0);
  for (double time = now + 1; time < now + 60;) {
    const Decision next = decide(time, all, renderer);
    VisitorDrawState& one = all[size_t(next.visitor)];
    renderer.served = next.served;
    one.served = std::max(one.served, renderer.served);
    const double cost = costs[size_t(next.visitor)];
    one.drawn_at = time;
    one.served += cost;
    time += cost;
    if (time > now + 10)
      gaps[size_t(next.visitor)] = std::max(gaps[size_t(next.visitor)], time - one.shown_at);
    one.shown_at = time;
  }
  return gaps;
}

TEST(Decide, nobody_goes_without_a_picture_for_much_longer_than_others) {
  auto longest = [](const std::vector<double>& costs) { return max_of(longest_gaps(costs)); };
  // Equal time alone: 1.9 s for the dear ones.
  EXPECT_LE(longest({0.05, 0.2, 0.05, 0.05, 0.2, 0.05, 0.05, 0.05}), 0.8);
  // If one picture for each takes longer than that, each has as many: 3.8 s by equal time.
  EXPECT_LE(longest({0.2, 0.2, 0.05, 0.4, 0.2, 0.05, 0.1, 0.1}), 1.31);
  // If nobody waits for long, each has as much time.
  const std::vector<double> gaps = longest_gaps({0.02, 0.02, 0.04});
  EXPECT_NEAR(gaps[2], 0.16, 0.01);
  EXPECT_NEAR(gaps[0], 0.08, 0.01);
}

TEST(Demand, counts_who_waits_for_a_picture_and_not_who_gains_by_samples) {
  RendererState renderer{.can_reconstruct = true};
  const States states{due(walker()), due(reconstructed()), walker(), due(stander())};
  EXPECT_EQ(find_demand(now, states, renderer), (Demand{2, false}));
}

TEST(Demand, the_storyteller_moves_where_what_moves_is_due) {
  EXPECT_EQ(find_demand(now, States{moving_due(listener())}, {}), (Demand{0, true}));
}

TEST(Demand, nobody_waits_while_the_renderer_is_busy) {
  RendererState renderer{.idle = false};
  const States states{due(walker()), moving_due(listener())};
  EXPECT_EQ(find_demand(now, states, renderer), Demand{});
}

}  // namespace
}  // namespace wellspring::test
