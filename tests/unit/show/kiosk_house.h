// SPDX-License-Identifier: Apache-2.0
// A house with kiosks, whose cameras and pages the test plays.
#pragma once
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/show/show_stage.h"
#include "wire/json.h"

namespace wellspring::test {

using nlohmann::json;

struct StageCamera {
  std::shared_ptr<Link> link;
  std::string kiosk;
  Observation seen;
  bool on = true;
  std::vector<json> orders;
};

struct KioskHouse : testing::Test, ShowStage {
  std::vector<StageCamera> cameras;

  void SetUp() override { set_up({}); }
  void set_up(std::vector<KioskSettings> kiosks) {
    Exhibit exhibit = make_tiny_exhibit();
    StorytellerPlace& anna = add_storyteller(exhibit, "anna", {-2, 0, 1});
    for (const char* line : {"Welcome.", "Hello."}) anna.greetings["en"].emplace_back().text = line;
    anna.farewells["en"].emplace_back().text = "Goodbye.";
    exhibit.stories.push_back(exhibit.stories[0]);
    exhibit.stories[1].id = "other";
    for (StoryText& story : exhibit.stories)
      for (int i = 0; i < 40; i++) story.text["en"].emplace_back().text = "And on it goes, and on.";
    exhibit.kiosks = std::move(kiosks);
    tick_seconds = 0.05;
    begin(std::move(exhibit), settings_for("direct"));
  }
  size_t page(const std::string& kiosk) {
    const size_t number = connect();
    say(json{{"type", "hello"}, {"role", "kiosk"}, {"kiosk", kiosk}, {"width", 32}, {"height", 32}}
            .dump(),
        number);
    go(0.1);
    return number;
  }
  size_t camera(const std::string& kiosk) {
    auto link = std::make_shared<Link>(100 + cameras.size(), LinkKind::eye, "test");
    cameras.push_back({link, kiosk, {}, true, {}});
    arrivals.put(link);
    go(0.2);
    return cameras.size() - 1;
  }
  // People by their places; none: nobody is there.
  void see(size_t camera, std::vector<vec3> places, const std::string& gesture = "") {
    Observation& seen = cameras[camera].seen;
    seen.state = places.empty() ? Presence::absent : Presence::person;
    seen.people.clear();
    for (vec3 place : places) {
      Person& person = seen.people.emplace_back();
      person.id = uint32_t(seen.people.size());
      person.position = place;
      person.confidence = 0.9f;
      person.gesture = gesture;
    }
  }
  void go(double seconds) {
    for (double end = now + seconds; now < end - 1e-9;) {
      for (StageCamera& one : cameras) {
        one.seen.time = now;
        one.seen.kiosk = one.kiosk;
        if (one.on) one.link->push_text_in(write_observation(one.seen));
      }
      step();
      for (StageCamera& one : cameras)
        for (Link::Out out; one.link->take_out(out);) one.orders.push_back(json::parse(out.text));
    }
  }
  json heard(size_t page) { return last("kiosk", page); }
  std::string stage(size_t page) { return heard(page)["stage"]; }
  std::vector<std::string> read(size_t page) {
    std::vector<std::string> texts;
    for (const json& subtitle : told("subtitle", page))
      if (subtitle["text"] != "") texts.push_back(subtitle["text"]);
    return texts;
  }
  void does(size_t page, const std::string& showing, bool touched = true) {
    say(json{{"type", "kiosk"}, {"touched", touched}, {"showing", showing}}.dump(), page);
    go(0.1);
  }
  void tells(size_t page, const std::string& story) {
    say(json{{"type", "storyteller"}, {"story", story}}.dump(), page);
    go(0.1);
  }
};

inline const vec3 near_screen(0, 0, 1);

}  // namespace wellspring::test
