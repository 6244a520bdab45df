// SPDX-License-Identifier: Apache-2.0
// Twenty visitors who do anything that the protocol has for ten minutes, beside one who does
// nothing.
#include <gtest/gtest.h>

#include <malloc.h>

#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "show/exhibit/exhibit_lights.h"
#include "unit/show/show_stage.h"
#include "world/load/lamp.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

struct Crowd : testing::Test, ShowStage {
  const size_t people = 20;
  std::mt19937 random{7};
  std::vector<size_t> present;      // browsers of the crowd
  std::vector<std::string> tokens;  // tokens of visits that ended
  std::string code;                 // a group's code
  std::set<std::string> errors;

  void SetUp() override {
    Exhibit exhibit = make_tiny_exhibit();
    add_storyteller(exhibit, "anna", {-2, 0, 1});
    add_storyteller(exhibit, "otto", {-2, 0, 2});
    add_lamp({"ceiling", {"light"}, {}}, exhibit.scene);
    exhibit.lamps = {{"ceiling", {{"en", "Ceiling"}}}};
    ShowSettings settings = settings_for("direct", 1);
    settings.idle_after = 0;  // the quiet one stays
    tick_seconds = 0.25;
    begin(std::move(exhibit), settings);
  }

  int any(int count) { return int(random() % uint32_t(count)); }
  double part() { return double(any(2001) - 1000) / 1000; }

  std::string order() {
    const std::vector<json> all = {
        {{"type", "input"}, {"move", {part(), 0, part()}}, {"look", {part(), part()}}},
        {{"type", "input"}, {"move", {0, 0, 0}}, {"pointer", {0.5, 0.2}}},
        {{"type", "camera"}, {"position", {2 * part(), 1.6, 2 * part()}}, {"yaw", part()}},
        {{"type", "viewpoint"}, {"name", any(2) ? "corner" : "nowhere"}},
        {{"type", "go"}, {"to", {3 * part(), 0, 3 * part()}}},
        {{"type", "go"}, {"at", {0.5 + part() / 2, 0.5 + part() / 2}}},
        {{"type", "tour"}, {"action", any(2) ? "play" : "pause"}},
        {{"type", "tour"}, {"action", "stop"}},
        {{"type", "storyteller"}, {"story", any(3) ? "tale" : "none"}},
        {{"type", "storyteller"}, {"teller", any(2) ? "anna" : "otto"}, {"visible", any(2) == 0}},
        {{"type", "storyteller"}, {"action", any(2) ? "pause" : "skip"}},
        {{"type", "storyteller"}, {"action", any(2) ? "stop" : "restart"}},
        {{"type", "ask"}, {"text", any(2) ? "What is the tale about?" : "?!"}},
        {{"type", "lamp"}, {"name", "ceiling"}, {"on", any(2) == 0}},
        {{"type", "group"}, {"action", "lead"}},
        {{"type", "group"}, {"action", "follow"}, {"code", code.empty() ? "NOBODY" : code}},
        {{"type", "group"}, {"action", any(2) ? "leave" : "rejoin"}},
        {{"type", "settings"}, {"lang", any(2) ? "de" : "en"}, {"attention", any(2) == 0}},
        {{"type", "settings"}, {"width", 16 + 16 * any(2)}, {"height", 16}, {"comfort", true}},
        {{"type", "ack"}, {"frame", any(1000)}, {"decoded_ms", any(100)}},
        {{"type", "kiosk"}, {"showing", "book"}},
        {{"type", any(2) ? "nonsense" : "hello"}, {"resume", "x.y"}, {"width", 16}, {"height", 16}},
    };
    json one = all[size_t(any(int(all.size())))];
    one["seq"] = ++seq;
    return one.dump();
  }

  void come() {
    const size_t number = connect();
    json hello = {{"type", "hello"}, {"width", 16}, {"height", 16}};
    if (!tokens.empty() && any(2)) hello["resume"] = tokens[size_t(any(int(tokens.size())))];
    say(hello.dump(), number);
    present.push_back(number);
  }
  void leave(size_t place) {
    const size_t number = present[place];
    if (any(2)) say(R"({"type":"bye"})", number);
    else browsers[number].link->mark_closed();
    present.erase(present.begin() + long(place));
  }
  // Looks at messages and forgets them, as a browser does; the quiet browser's stay.
  void read() {
    for (size_t i = 1; i < browsers.size(); i++) {
      for (const std::string& text : browsers[i].texts) {
        const json message = json::parse(text);
        if (message["type"] == "error") errors.insert(message["code"]);
        if (message["type"] == "keep" && tokens.size() < 50) tokens.push_back(message["token"]);
        if (message["type"] == "group" && message.value("role", "") == "leader")
          code = message["code"];
      }
      browsers[i].texts = {}, browsers[i].pictures = {}, browsers[i].sounds = {};
    }
  }
};

TEST_F(Crowd, DisturbsNobodyAndLeavesNothingBehind) {
  const size_t quiet = join(16, 16);
  while (present.size() < people) come();
  run(1);
  size_t early = 0;
  const int seconds = 600;
  for (int second = 0; second < seconds; second++) {
    for (size_t number : present)
      if (any(2)) say(order(), number);
    if (any(4) == 0) leave(size_t(any(int(present.size()))));
    while (present.size() < people) come();
    run(1);
    read();
    ASSERT_EQ(show->visits.visitors.size(), people + 1) << second;
    ASSERT_LE(show->visits.kept.size(), 4u);
    for (const Visitor& visitor : show->visits.visitors)
      ASSERT_TRUE(is_finite(vec3(visitor.place.view.position))) << second;
    if (second == seconds / 3) early = mallinfo2().uordblks;
  }
  EXPECT_LT(mallinfo2().uordblks, early + (4 << 20));
  const std::set<std::string> expected = {
      "unknown_type", "unknown_viewpoint", "unknown_story", "unknown_group", "no_group",
      "no_way",       "nothing_there",     "no_kiosk",      "in_group",      "bad_field"};
  for (const std::string& error : errors) EXPECT_TRUE(expected.contains(error)) << error;
  EXPECT_GE(errors.size(), 5u) << "the crowd tried what does not go, too";
  // The quiet one stands where they stood, and saw and heard nothing of all that.
  std::set<json> places, lamps, tellers;
  for (const json& state : told("state", quiet)) places.insert(state["position"]);
  for (const json& agent : told("agent", quiet)) tellers.insert(agent["teller"]);
  EXPECT_EQ(places.size(), 1u);
  EXPECT_EQ(tellers.size(), 1u);
  EXPECT_TRUE(told("subtitle", quiet).empty() && told("lamps", quiet).empty());
  EXPECT_TRUE(told("error", quiet).empty() && told("group", quiet).empty());
  EXPECT_GE(pictures(quiet).size(), 1u);  // the many who walk come first
}

}  // namespace
}  // namespace wellspring::test
