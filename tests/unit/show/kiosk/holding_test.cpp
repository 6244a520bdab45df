// SPDX-License-Identifier: Apache-2.0
#include "show/kiosk/holding.h"

#include <gtest/gtest.h>

#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

Holding object(const std::string& id) {
  Holding holding;
  holding.id = id;
  holding.title = {{"en", "A " + id}, {"de", "Ein " + id}};
  return holding;
}

Holding undecided(const std::string& hint) {
  Holding holding;
  holding.of_class = "coin";
  holding.title["en"] = "A coin";
  if (!hint.empty()) holding.hint = {{"en", hint}, {"de", "Bitte."}};
  return holding;
}

struct Talk : testing::Test {
  Exhibit exhibit = make_tiny_exhibit();
  HoldingTalk talk;
  std::vector<std::string> heard;
  double now = 0;
  // Lists what she says in so many seconds, each sentence once, and stories in brackets. A sentence
  // takes two seconds.
  std::vector<std::string> hear(const std::optional<Holding>& holding, double seconds,
                                bool busy = false) {
    std::vector<std::string> out;
    double silent = now;
    for (const double end = now + seconds; now < end - 1e-9; now += 0.1) {
      const HoldingWords words =
          choose_words(talk, holding, exhibit, heard, busy || now < silent, now);
      if (!words.text.empty()) out.push_back(words.text.at("en")[0].text), silent = now + 2;
      if (!words.story.empty())
        out.push_back("[" + words.story + "]"), heard.push_back(words.story);
    }
    return out;
  }
};
using Said = std::vector<std::string>;

TEST_F(Talk, a_hint_is_asked_for_once_and_again_only_after_a_pause) {
  EXPECT_EQ(hear(undecided("Turn it over, please."), hint_settles - 0.2), Said{});
  EXPECT_EQ(hear(undecided("Turn it over, please."), repeat_pause - 2),
            Said{"Turn it over, please."});
  EXPECT_EQ(hear(undecided("Turn it over, please."), 4), Said{"Turn it over, please."});
}

TEST_F(Talk, hints_that_flicker_are_not_said) {
  Said all;
  for (int i = 0; i < 20; i++) {
    const Said now = hear(undecided(i % 2 ? "A little closer." : "Turn it over, please."), 0.5);
    all.insert(all.end(), now.begin(), now.end());
  }
  EXPECT_EQ(all, Said{});
}

TEST_F(Talk, sentences_come_with_pauses) {
  hear(undecided("Turn it over, please."), 1.5);
  const double first = talk.said_at;
  EXPECT_EQ(hear(undecided("A little closer."), 8), Said{"A little closer."});
  EXPECT_GE(talk.said_at - first, talk_pause);
  const double second = talk.said_at;
  EXPECT_EQ(hear(object("as"), 4), Said{"A as"});
  EXPECT_GE(talk.said_at - second, talk_pause);
}

TEST_F(Talk, she_says_nothing_while_she_talks_or_nothing_is_asked_for) {
  EXPECT_EQ(hear(undecided("Turn it over, please."), 10, true), Said{});
  EXPECT_EQ(hear(undecided(""), 10), Said{});
  EXPECT_EQ(hear({}, 10), Said{});
  EXPECT_EQ(hear(object("as"), 10, true), Said{});
}

TEST_F(Talk, an_object_is_named_once_while_it_is_held) {
  EXPECT_EQ(hear(object("as"), 60), Said{"A as"});
  hear({}, 1);
  EXPECT_EQ(hear(object("as"), 3), Said{"A as"}) << "later it is a new one";
  EXPECT_EQ(hear(object("denarius"), 8), Said{"A denarius"});
  hear({}, 1);
  EXPECT_EQ(hear(object("as"), 8), Said{"A as"}) << "another was named between";
}

TEST_F(Talk, whoever_still_holds_it_is_told_its_story_once) {
  exhibit.points.emplace_back().id = "as";
  exhibit.points.back().story = "tale";
  EXPECT_EQ(hear(object("as"), story_pause - 1), Said{"A as"});
  EXPECT_EQ(hear(object("as"), 20), Said{"[tale]"});
  hear({}, 30);
  EXPECT_EQ(hear(object("as"), 20), Said{"A as"});
}

TEST_F(Talk, a_story_of_its_id_is_its_story_too) {
  exhibit.stories[0].id = "as";
  EXPECT_EQ(hear(object("as"), 12), (Said{"A as", "[as]"}));
}

TEST_F(Talk, what_the_exhibit_says_of_it_is_said_where_there_is_no_story) {
  exhibit.points.emplace_back().id = "as";
  exhibit.points.back().text = {{"en", "It was lost in a well."}};
  HoldingWords words;
  for (; words.text.empty() && now < 5; now += 0.1)
    words = choose_words(talk, object("as"), exhibit, {}, false, now);
  ASSERT_EQ(words.text.at("en").size(), 2u);
  EXPECT_EQ(words.text.at("en")[1].text, "It was lost in a well.");
  EXPECT_EQ(words.text.at("de")[0].text, "Ein as");
}

struct Mirror : testing::Test {
  View view;  // at the origin, looks towards -z
  HeldObject held;
  std::optional<Holding> seen = object("as");
  Mirror() {
    seen->position = vec3(0.1f, -0.05f, 0.4f);
    seen->rotation = vec3(0);
  }
  void go(double seconds, int model = 0) {
    for (const double end = held.time < 0 ? seconds : held.time + seconds; held.time < end - 1e-9;)
      follow_held(held, model, seen, held.time < 0 ? 0 : held.time + 0.02);
  }
  vec3 place(vec3 own) { return vec3(place_held(held, view, 0.6f) * vec4(own, 1)); }
  static void expect_near(vec3 a, vec3 b) {
    EXPECT_LT(glm::length(a - b), 1e-3f) << a.x << ", " << a.y << ", " << a.z;
  }
};

TEST_F(Mirror, it_is_as_far_behind_the_screen_as_the_hand_is_before_it) {
  go(1);
  EXPECT_EQ(held.size, 1);
  expect_near(place({0, 0, 0}), {0.1f, -0.05f, -1});
  // Its front looks at the guest, and its writing is legible.
  expect_near(place({0.02f, 0, 0}), {0.12f, -0.05f, -1});
  expect_near(place({0, 0, 0.02f}), {0.1f, -0.05f, -0.98f});
}

TEST_F(Mirror, it_turns_as_a_mirror_shows_it) {
  // Yaw is positive towards +x: what faces the screen turns its face to the visitor's right.
  seen->rotation = vec3(0.5f, 0, 0);
  go(1);
  const vec3 front = place({0, 0, 1}) - place({0, 0, 0});
  EXPECT_GT(front.x, 0.4f);
  EXPECT_GT(front.z, 0.8f);
  seen->rotation = vec3(0, 0.5f, 0);  // it looks up
  go(2);
  EXPECT_GT((place({0, 0, 1}) - place({0, 0, 0})).y, 0.4f);
  seen->rotation = vec3(0, 0, 0.5f);  // its top leans to the visitor's right
  go(2);
  EXPECT_GT((place({0, 1, 0}) - place({0, 0, 0})).x, 0.4f);
}

TEST_F(Mirror, it_comes_and_goes_softly_and_one_after_the_other) {
  go(0.1);
  EXPECT_GT(held.size, 0);
  EXPECT_LT(held.size, 1);
  go(1);
  for (int i = 0; i < 3; i++) {
    follow_held(held, 1, seen, held.time + 0.05);
    EXPECT_EQ(held.model, 0) << "it is still there";
  }
  go(1, 1);
  EXPECT_EQ(held.model, 1);
  EXPECT_EQ(held.size, 1);
  seen.reset();
  go(1, -1);
  EXPECT_EQ(held.model, -1);
  EXPECT_EQ(held.size, 0);
}

TEST_F(Mirror, its_place_does_not_jump) {
  go(1);
  seen->position = vec3(-0.2f, 0, 0.4f);
  float last = held.place.x;
  for (int i = 0; i < 100; i++) {
    follow_held(held, 0, seen, held.time + 0.02);
    EXPECT_LT(std::abs(held.place.x - last), 0.06f);
    last = held.place.x;
  }
  EXPECT_NEAR(last, -0.2f, 1e-3f);
}

TEST_F(Mirror, what_has_no_place_or_no_model_is_not_shown) {
  go(1, -1);
  EXPECT_EQ(held.size, 0);
  seen->position.reset();
  go(1);
  EXPECT_EQ(held.size, 0);
}

}  // namespace
}  // namespace wellspring::test
