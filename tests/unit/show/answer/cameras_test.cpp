// SPDX-License-Identifier: Apache-2.0
// Kiosks' cameras that come, go for a while, and go for good.
#include "show/answer/cameras.h"
#include "show/http/report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "show/http/answer.h"
#include "unit/show/show_stage.h"
#include "wire/json.h"

namespace wellspring::test {
namespace {

struct Cameras : testing::Test, ShowStage {
  uint64_t next_link = 100;
  Observation seen;
  void SetUp() override {
    Exhibit exhibit = make_tiny_exhibit();
    add_storyteller(exhibit, "anna", {-2, 0, 1});
    begin(std::move(exhibit), settings_for("direct"));
  }
  std::shared_ptr<Link> connect_camera(const std::string& name) {
    auto link = std::make_shared<Link>(next_link++, LinkKind::eye, "test");
    arrivals.put(link);
    speak(*link, name);
    return link;
  }
  void speak(Link& link, const std::string& name) {
    seen.name = name;
    link.push_text_in(write_observation(seen));
    step();
  }
  void wait(double seconds) {  // in long ticks, and in longer ones where nothing is to happen
    for (double end = now + seconds; now < end;)
      step(std::min(end - now > 7200 ? 3600.0 : 1.0, end - now));
  }
  // "number name state seconds" of each.
  std::vector<std::string> listed() const {
    std::vector<std::string> all;
    for (const CameraReport& one : make_report(*show).cameras)
      all.push_back(std::to_string(one.number) + " " + one.name + " " + one.state + " " +
                    std::to_string(std::lround(one.since)));
    return all;
  }
  using List = std::vector<std::string>;
};

TEST_F(Cameras, ALostOneIsListedUntilItIsForgotten) {
  auto left = connect_camera("hall, left");
  auto right = connect_camera("hall, right");
  EXPECT_EQ(listed(), (List{"1 hall, left good 0", "2 hall, right good 0"}));
  left->mark_closed();
  wait(90);
  speak(*right, "hall, right");
  EXPECT_EQ(listed(), (List{"1 hall, left disconnected 89", "2 hall, right good 0"}));
  EXPECT_EQ(connected_cameras(show->kiosks), 1u);
  const std::string text = write_metrics(make_report(*show));
  EXPECT_NE(text.find("wellspring_kiosk_cameras 1\n"), std::string::npos);
  EXPECT_NE(text.find("wellspring_kiosk_camera_seconds{camera=\"1\",name=\"hall, left\","
                      "state=\"disconnected\"} 89\n"),
            std::string::npos);
  wait(lost_camera_listed - 92);
  EXPECT_EQ(listed().size(), 2u);
  wait(4);
  ASSERT_EQ(listed().size(), 1u);
  EXPECT_EQ(listed()[0].rfind("2 hall, right", 0), 0u) << "and keeps its number";
}

TEST_F(Cameras, OneThatComesBackIsTheSame) {
  auto left = connect_camera("left");
  auto right = connect_camera("right");
  left->mark_closed();
  wait(30);
  auto again = connect_camera("left");
  EXPECT_EQ(listed(), (List{"2 right silent 30", "1 left good 0"}));
  // One whose connection hangs has not closed when it connects anew.
  wait(5);
  auto anew = connect_camera("left");
  EXPECT_EQ(listed(), (List{"2 right silent 35", "1 left good 0"}));
  std::string reason;
  EXPECT_TRUE(again->close_requested(reason));
  // Two at work under one name are two.
  connect_camera("left");
  EXPECT_EQ(listed().size(), 3u);
}

TEST_F(Cameras, OneWithoutANameGoesWithItsConnection) {
  auto camera = connect_camera("");
  EXPECT_EQ(listed(), (List{"1  good 0"}));
  camera->mark_closed();
  step();
  EXPECT_TRUE(listed().empty());
}

TEST_F(Cameras, FewOfManyLostOnesAreListed) {
  for (int i = 0; i < 50; i++) connect_camera("kiosk " + std::to_string(i))->mark_closed();
  step();
  ASSERT_EQ(listed().size(), most_lost_cameras);
  EXPECT_EQ(show->kiosks.eyes.front().seen.name, "kiosk 18");
}

TEST_F(Cameras, ThereAreNotMoreThanMayBe) {
  std::vector<std::shared_ptr<Link>> links;
  for (size_t i = 0; i < 2 * most_cameras; i++) {
    seen.kiosk = "kiosk " + std::to_string(i / most_kiosk_cameras);
    links.push_back(connect_camera("camera " + std::to_string(i)));
  }
  EXPECT_EQ(show->kiosks.eyes.size(), most_cameras);
  std::string reason;
  EXPECT_FALSE(links[most_cameras - 1]->close_requested(reason));
  ASSERT_TRUE(links[most_cameras]->close_requested(reason));
  EXPECT_EQ(reason, "too many cameras");
  Link::Out out;
  ASSERT_TRUE(links[most_cameras]->take_out(out));
  EXPECT_EQ(nlohmann::json::parse(out.text)["code"], "too_many_cameras");
  links[3]->mark_closed();
  step();
  seen.kiosk = "kiosk 0";
  connect_camera("camera 3");
  EXPECT_EQ(show->kiosks.eyes.size(), most_cameras) << "one that comes back has its place";
}

TEST_F(Cameras, OneKioskHasFewerThanAll) {
  seen.kiosk = "hall";
  for (size_t i = 0; i < most_kiosk_cameras; i++) connect_camera("camera " + std::to_string(i));
  auto one_more = connect_camera("one more");
  std::string reason;
  EXPECT_TRUE(one_more->close_requested(reason));
  EXPECT_EQ(listed().size(), most_kiosk_cameras + 1);
  one_more->mark_closed();
  step();
  EXPECT_EQ(listed().size(), most_kiosk_cameras) << "it was never at work";
  seen.kiosk = "yard";
  auto yard = connect_camera("yard");
  EXPECT_FALSE(yard->close_requested(reason));
  seen.kiosk = "hall";
  speak(*yard, "yard");
  EXPECT_TRUE(yard->close_requested(reason)) << "nor by going there";
}

TEST_F(Cameras, ATokenOfOneKioskIsGoodForNoOther) {
  auto link = std::make_shared<Link>(next_link++, LinkKind::eye, "test");
  link->kiosk = "hall";
  arrivals.put(link);
  speak(*link, "");
  EXPECT_EQ(show->kiosks.eyes.at(0).kiosk, "hall") << "it need not say so";
  seen.kiosk = "hall";
  speak(*link, "");
  EXPECT_EQ(show->kiosks.eyes.at(0).refused, 0u);
  seen.kiosk = "yard";
  seen.state = Presence::person;
  seen.people = {Person{.id = 7}};
  speak(*link, "");
  EXPECT_EQ(show->kiosks.eyes.at(0).refused, 1u);
  EXPECT_EQ(show->kiosks.eyes.at(0).kiosk, "hall");
  for (const Kiosk& kiosk : show->kiosks.all) EXPECT_TRUE(kiosk.audience.guests.empty());
  std::string answer;
  for (Link::Out out; link->take_out(out);) answer = out.text;
  EXPECT_EQ(nlohmann::json::parse(answer)["code"], "not_trusted");
}

TEST_F(Cameras, WhoStaysBeforeOneKeepsTheirNumberWhenAnotherGoes) {
  wait(lost_camera_listed);
  auto left = connect_camera("left");
  auto right = connect_camera("right");
  Person person{.id = 7};
  seen.state = Presence::person;
  seen.people = {person};
  speak(*right, "right");
  step(0.1);
  ASSERT_EQ(show->kiosks.all.at(0).audience.guests.size(), 1u);
  const uint64_t guest = show->kiosks.all.at(0).audience.guests[0].id;
  left->mark_closed();
  for (int i = 0; i < 10; i++) speak(*right, "right"), step(1.0);
  ASSERT_EQ(show->kiosks.eyes.size(), 2u);
  show->kiosks.eyes.front().gone -= lost_camera_listed;
  for (int i = 0; i < 10; i++) speak(*right, "right"), step(1.0);
  EXPECT_EQ(show->kiosks.eyes.size(), 1u);
  ASSERT_EQ(show->kiosks.all.at(0).audience.guests.size(), 1u);
  EXPECT_EQ(show->kiosks.all.at(0).audience.guests[0].id, guest);
}

TEST_F(Cameras, TheScreenIsToldWhatIsHeld) {
  join(32, 32, "en", "kiosk");
  auto camera = connect_camera("hall");
  step(0.1);
  EXPECT_FALSE(last("kiosk").contains("holding"));
  seen.holding =
      Holding{.of_class = "coins", .title = {{"en", "a coin"}}, .hint = {{"en", "Turn"}}};
  speak(*camera, "hall");
  step(0.1);
  EXPECT_EQ(last("kiosk")["holding"],
            (nlohmann::json{
                {"class", "coins"}, {"title", {{"en", "a coin"}}}, {"hint", {{"en", "Turn"}}}}));
  seen.holding = Holding{.id = "as", .title = {{"en", "An as"}}, .position = vec3(0, 0, 0.3f)};
  speak(*camera, "hall");
  step(0.1);
  EXPECT_EQ(last("kiosk")["holding"]["id"], "as");
  seen.holding.reset();
  speak(*camera, "hall");
  step(0.1);
  EXPECT_FALSE(last("kiosk").contains("holding"));
}

TEST_F(Cameras, TheScreenIsToldWhereThePersonIsToStand) {
  join(32, 32, "en", "kiosk");
  auto camera = connect_camera("hall");
  step(0.1);
  EXPECT_FALSE(last("kiosk").contains("calibration"));
  seen.calibration = CalibrationStep{CalibrationStep::What::far_mark, 2, 0.51f};
  speak(*camera, "hall");
  step(0.1);
  EXPECT_EQ(last("kiosk")["calibration"],
            (nlohmann::json{{"step", "far"}, {"metres", 2}, {"progress", 0.5}}));
  EXPECT_EQ(listed(), (List{"1 hall calibrating 0"}));
  camera->mark_closed();
  wait(observation_lifetime + 0.2);
  EXPECT_FALSE(last("kiosk").contains("calibration"));
}

}  // namespace
}  // namespace wellspring::test
