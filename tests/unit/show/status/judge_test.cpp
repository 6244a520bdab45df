// SPDX-License-Identifier: Apache-2.0
// Every problem appears, says since when, and goes.
#include "show/status/judge.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "show/status/status.h"

namespace wellspring::test {
namespace {

struct Judged : testing::Test {
  ShowReport report;
  JudgeMemory memory;
  std::vector<Finding> findings;
  void SetUp() override {
    report.time = 1000;
    report.cores = 2;
    wait(0);
  }
  // `seconds` of such reports, four a second as the server makes them.
  void wait(double seconds) {
    for (double end = report.time + seconds;; report.time += 0.25) {
      findings = judge(report, memory);
      if (report.time >= end) return;
      for (CameraReport& camera : report.cameras) camera.since += 0.25;
    }
  }
  const Finding* found(const std::string& what) const {
    for (const Finding& one : findings)
      if (one.what == what) return &one;
    return nullptr;
  }
  std::string all() const {
    std::string text;
    for (const Finding& one : findings) text += one.what + "\n";
    return text;
  }
};

TEST_F(Judged, NothingIsWrongAtFirst) { EXPECT_EQ(all(), ""); }

TEST_F(Judged, EachStateOfACamera) {
  report.kiosks = {{.name = "hall", .cameras = 1}};
  const std::pair<const char*, const char*> words[] = {
      {"dark", "The camera at kiosk 'hall' sees only black"},
      {"frozen", "The picture of the camera at kiosk 'hall' stands still"},
      {"missing", "The camera at kiosk 'hall' gives no picture"},
      {"slow", "The camera at kiosk 'hall' gives fewer than 8 pictures a second"},
      {"silent", "The program of the camera at kiosk 'hall' says nothing"}};
  for (const auto& [state, what] : words) {
    report.cameras = {{"hall", 1, "", "good", 100}};
    wait(1);
    EXPECT_EQ(all(), "");
    report.cameras = {{"hall", 1, "", state, 30}};
    const double since = report.time - 30;
    wait(5);
    ASSERT_TRUE(found(what)) << state << ": " << all();
    EXPECT_NEAR(found(what)->since, since, 0.3);
    EXPECT_FALSE(found(what)->remedy.empty());
    EXPECT_TRUE(found(what)->grave);
  }
  report.cameras = {{"hall", 1, "", "calibrating", 30}};
  wait(5);
  EXPECT_EQ(all(), "");
}

TEST_F(Judged, NetworksThatAKioskIsMissing) {
  report.kiosks = {{.name = "hall", .cameras = 1}};
  report.cameras = {{"hall", 1, "", "good", 100}};
  report.cameras[0].parts = {.faces = false, .mesh = false};
  wait(5);
  const char* heads = "How heads are turned is told badly by the camera at kiosk 'hall'";
  ASSERT_TRUE(found(heads)) << all();
  EXPECT_FALSE(found(heads)->grave);
  EXPECT_EQ(all().find("Eyes and distances"), std::string::npos) << "the heads' line says it all";
  EXPECT_NE(found(heads)->remedy.find("./wellspring kiosk"), std::string::npos);
  report.cameras[0].parts = {.expression = false};
  wait(5);
  EXPECT_TRUE(
      found("No expressions are told by the camera at kiosk 'hall', though they are asked "
            "for"))
      << all();
  EXPECT_FALSE(found(heads));
  report.cameras[0].parts = {.mesh = true, .expression = true};
  wait(5);
  EXPECT_EQ(all(), "");
}

TEST_F(Judged, AKioskThatHasLostItsOnlyCamera) {
  report.kiosks = {{.name = "hall", .cameras = 0}};
  wait(10);
  EXPECT_EQ(all(), "") << "it never had one: it works by touch";
  report.kiosks[0].cameras = 1;
  report.cameras = {{"hall", 1, "left", "good", 1}};
  wait(5);
  const double lost = report.time;
  report.kiosks[0].cameras = 0;
  report.cameras = {{"hall", 1, "left", "disconnected", 0}};
  wait(1);
  EXPECT_EQ(all(), "") << "for a moment it may";
  wait(3);
  EXPECT_EQ(all(), "No camera at kiosk 'hall'\n");
  EXPECT_NEAR(findings[0].since, lost, 0.3);
  EXPECT_EQ(findings[0].remedy, "Check its cable and the program 'wellspring kiosk'.");
  report.cameras.clear();  // the server lists lost cameras for a time only
  wait(3600);
  ASSERT_EQ(all(), "No camera at kiosk 'hall'\n");
  EXPECT_NEAR(findings[0].since, lost, 0.3);
  report.kiosks[0].cameras = 1;
  wait(0.5);
  EXPECT_EQ(all(), "");
}

TEST_F(Judged, OneCameraOfTwoIsNamed) {
  report.kiosks = {{.name = "hall", .cameras = 1}};
  report.cameras = {{"hall", 1, "left", "good", 9}, {"hall", 2, "right", "disconnected", 0}};
  wait(4);
  EXPECT_EQ(all(), "The camera 'right' at kiosk 'hall' is gone\n");
}

TEST_F(Judged, WhatIsGoneIsSaidForAWeek) {
  report.kiosks = {{.name = "hall", .screens = 1, .cameras = 1}};
  wait(1);
  report.kiosks[0] = {.name = "hall"};
  wait(20);
  const double lost = report.time - 20;
  const std::string both = "No camera at kiosk 'hall'\nNo screen at kiosk 'hall'\n";
  for (int hours = 0; hours < 7 * 24 - 1; hours++, report.time += 3600) {
    wait(0);
    ASSERT_EQ(all(), both) << "after " << hours << " hours";
    ASSERT_NEAR(findings[0].since, lost, 0.6);
  }
  report.time += 2 * 3600;
  wait(0);
  EXPECT_EQ(all(), "") << "it is taken to be gone for good";
}

TEST_F(Judged, AKioskWhoseScreenHasGone) {
  report.kiosks = {{.name = "hall", .screens = 1}};
  wait(1);
  report.kiosks[0].screens = 0;
  const double gone = report.time;
  wait(10);
  EXPECT_EQ(all(), "") << "a page that loads anew is soon back";
  wait(10);
  ASSERT_TRUE(found("No screen at kiosk 'hall'")) << all();
  EXPECT_NEAR(findings[0].since, gone, 0.3);
  report.kiosks[0].screens = 1;
  wait(0.5);
  EXPECT_EQ(all(), "");
}

TEST_F(Judged, PicturesThatAreLate) {
  report.visitors.resize(5);
  for (VisitorReport& one : report.visitors) one.fps = 30, one.interval_ms = 100;
  report.visitors[3].interval_ms = 900;
  wait(10);
  EXPECT_EQ(all(), "") << "who stands waits for nothing";
  report.visitors[3].walks = true;
  const double since = report.time;
  wait(4);
  EXPECT_EQ(all(), "") << "for a moment it may";
  wait(2);
  ASSERT_TRUE(found("Pictures are late")) << all();
  EXPECT_NEAR(findings[0].since, since, 0.3);
  EXPECT_EQ(findings[0].why, "2 cores are not enough for 5 visitors");
  report.all_visitors = 7;
  wait(1);
  EXPECT_EQ(findings[0].why, "2 cores are not enough for 7 visitors") << "two are elsewhere";
  report.all_visitors = 0;
  report.visitors[3].walks = false;
  wait(10);
  EXPECT_NEAR(findings.at(0).since, since, 0.3) << "between two walks it is not said to be well";
  wait(10);
  EXPECT_EQ(all(), "");
  report.visitors.resize(1);
  report.cores = 1;
  report.visitors[0].walks = true;
  report.visitors[0].fps = 5;
  wait(6);
  ASSERT_EQ(all(), "Pictures are late\n");
  EXPECT_EQ(findings[0].why, "1 core is not enough for 1 visitor");
}

TEST_F(Judged, ALineThatIsSlowIsNotTheCores) {
  report.visitors.resize(1);
  report.visitors[0].id = 7;
  report.visitors[0].walks = true;
  report.visitors[0].fps = 3;
  report.visitors[0].round_trip_ms = 900;
  wait(6);
  ASSERT_EQ(all(), "The line to visitor 7 is slow\n");
  EXPECT_EQ(findings[0].why, "a picture and its answer take 900 ms");
  report.visitors[0].kiosk = true;
  report.visitors[0].name = "hall";
  wait(1);
  EXPECT_EQ(all(), "The line to the screen at kiosk 'hall' is slow\n");
  report.visitors.clear();
  wait(11);
  EXPECT_EQ(all(), "");
}

TEST_F(Judged, LineBrowserAndEncoderAreToldApart) {
  report.visitors.resize(1);
  VisitorReport& visitor = report.visitors[0];
  visitor.id = 7;
  visitor.limit = Limit::network;
  visitor.line_rate = 1.25e5f, visitor.line_ms = 80, visitor.eighths = 4;
  wait(6);
  ASSERT_EQ(all(), "The line to visitor 7 is slow\n");
  EXPECT_EQ(findings[0].why, "it carries 1.0 Mbit/s, there and back takes 80 ms");
  visitor.eighths = 8;  // fewer colours are seen by nobody
  wait(11);
  EXPECT_EQ(all(), "");
  visitor.limit = Limit::browser;
  visitor.decode_ms = 120;
  wait(6);
  ASSERT_EQ(all(), "The browser of visitor 7 is slow\n");
  EXPECT_EQ(findings[0].why, "decoding a picture takes 120 ms");
  visitor.limit = Limit::server;
  visitor.encode_ms = 90;
  wait(11);
  ASSERT_EQ(all(), "Pictures for visitor 7 are made slowly\n");
  EXPECT_EQ(findings[0].why, "encoding one takes 90 ms");
}

TEST_F(Judged, WhatIsCountedIsToldForTenMinutes) {
  struct Case {
    uint64_t& count;
    const char *once, *three_times;
  };
  const Case cases[] = {
      {report.voice_failed, "The voice has failed once", "The voice has failed 3 times"},
      {report.voice_restarts, "The voice's program has ended once",
       "The voice's program has ended 3 times"},
      {report.turned_away, "1 visitor was turned away", "3 visitors were turned away"},
      {report.doors.floods_closed, "1 connection was closed for sending too much",
       "3 connections were closed for sending too much"},
      {report.doors.accept_errors, "Newcomers could not be let in once",
       "Newcomers could not be let in 3 times"}};
  for (const Case& one : cases) {
    const double since = report.time;
    one.count += 1;
    wait(60);
    ASSERT_TRUE(found(one.once)) << all();
    EXPECT_NEAR(found(one.once)->since, since, 0.3);
    one.count += 2;
    wait(590);
    ASSERT_TRUE(found(one.three_times)) << all();
    EXPECT_NEAR(found(one.three_times)->since, since, 0.3);
    wait(20);
    EXPECT_EQ(all(), "");
  }
  report.voice_failed++;
  wait(1);
  EXPECT_EQ(all(), "The voice has failed once\n") << "what was told before is over";
  report.voice_failed = 0;  // another exhibit has begun
  wait(700);
  EXPECT_EQ(all(), "");
}

TEST_F(Judged, WhatIsMissingOrCannotBeWritten) {
  report.denoiser_problem = "the weights are not there";
  report.exhibit_problems = 1;
  wait(1);
  EXPECT_EQ(all(),
            "Pictures at rest take longer to become fine\n"
            "The exhibit's files have 1 mistake\n");
  EXPECT_EQ(findings[0].why, "the weights are not there");
  report.denoiser_problem.clear();
  report.exhibit_problems = 0;
  report.sums_problem = "disk is full";
  wait(1);
  EXPECT_EQ(all(), "The daily sums cannot be written\n");
  EXPECT_EQ(findings[0].why, "disk is full");
  report.sums_problem.clear();
  wait(1);
  EXPECT_EQ(all(), "");
}

TEST_F(Judged, AFullDiskAndDamagedFilesAreToldAtOnce) {
  report.full_disks = {"/var/cache", "/var/sums"};
  report.damaged_files = {"/var/cache/castle.bake"};
  wait(0.25);
  EXPECT_EQ(all(), "The disk is full\nFiles of the cache were damaged\n");
  EXPECT_TRUE(findings[0].grave);
  EXPECT_NE(findings[0].why.find("/var/cache, /var/sums"), std::string::npos);
  EXPECT_EQ(findings[1].why, "/var/cache/castle.bake");
  report.full_disks.clear();
  report.damaged_files.clear();
  wait(1);
  EXPECT_EQ(all(), "");
}

TEST_F(Judged, LightOfAnotherSceneIsTold) {
  report.light_problem = "content/hall/light.maps: is stale";
  wait(0.25);
  EXPECT_EQ(all(), "The exhibit's own light is not of the exhibit as it is\n");
  EXPECT_FALSE(findings[0].grave);
  EXPECT_EQ(findings[0].why, report.light_problem);
}

TEST_F(Judged, WaitingVisitorsAreToldAfterAWhile) {
  report.waiting = 2;
  wait(4);
  EXPECT_EQ(all(), "");
  wait(2);
  EXPECT_EQ(all(), "2 visitors wait to be let in\n");
  report.waiting = 0;
  wait(1);
  EXPECT_EQ(all(), "");
}

TEST_F(Judged, WorkersThatAreNotAskedAreTold) {
  report.workers.used = report.workers.connected = true;
  report.workers.workers = {{.name = "north", .problem = ""},
                            {.name = "south", .problem = "south refuses: scene"}};
  wait(10);
  ASSERT_TRUE(found("A worker is not asked")) << all();
  EXPECT_EQ(found("A worker is not asked")->why, "south refuses: scene");
  EXPECT_EQ(findings.size(), 1u);
  report.workers.workers.clear();
  wait(1);
  EXPECT_EQ(all(), "");
  report.workers.connected = false;
  wait(10);
  EXPECT_TRUE(found("No samples come from workers")) << all();
}

TEST_F(Judged, GraveOnesComeFirst) {
  report.denoiser_problem = "no weights";
  wait(10);
  report.turned_away = 2;
  wait(1);
  EXPECT_EQ(all(), "2 visitors were turned away\nPictures at rest take longer to become fine\n");
}

TEST(Status, TellsFindingsAndTablesAsJson) {
  ShowReport report{.time = 100};
  StatusDesk desk("castle");
  desk.see(report);
  auto status = nlohmann::json::parse(write_status({desk.tell()}, {}, true));
  EXPECT_EQ(status["fine"], true);
  EXPECT_EQ(status["sums"], true);
  report.time = 130;
  report.sums_problem = "full \xff";
  report.kiosks = {{"hall", Stage::engaged, 2, true, 1, 1}};
  report.cameras = {{"hall", 4, "", "good", 12.4}};
  desk.see(report);
  report.time = 160;
  desk.see(report);
  status = nlohmann::json::parse(write_status({desk.tell()}, {}, true));
  EXPECT_EQ(status["fine"], false);
  ASSERT_EQ(status["findings"].size(), 1u);
  EXPECT_EQ(status["findings"][0]["seconds"], 30);
  EXPECT_EQ(status["findings"][0]["exhibit"], "castle");
  EXPECT_EQ(status["kiosks"][0], (nlohmann::json{{"name", "hall"},
                                                 {"exhibit", "castle"},
                                                 {"stage", "engaged"},
                                                 {"people", 2},
                                                 {"storyteller", true},
                                                 {"screens", 1},
                                                 {"cameras", 1}}));
  EXPECT_EQ(status["cameras"][0], (nlohmann::json{{"kiosk", "hall"},
                                                  {"name", "4"},
                                                  {"state", "good"},
                                                  {"eyes", {{"faces", true}}},
                                                  {"seconds", 12}}));
}

TEST(Status, OfSeveralExhibitsTellsWhatIsAlikeOnceAndWhatFailed) {
  ShowReport report{.denoiser_problem = "no weights"};
  StatusDesk castle("castle"), hill("hill");
  castle.see(report);
  report.sums_problem = "full";
  hill.see(report);
  const auto status = nlohmann::json::parse(
      write_status({castle.tell(), hill.tell()}, {{"ruin", {"ruin/exhibit.json: no"}}}, false));
  std::vector<std::string> told;
  for (const auto& one : status["findings"]) told.push_back(one["about"]);
  EXPECT_EQ(told, (std::vector<std::string>{"failed ruin", "denoiser", "sums"}));
  EXPECT_EQ(status["findings"][0]["why"], "ruin/exhibit.json: no");
  EXPECT_EQ(status["findings"][0]["seconds"], nullptr);
}

}  // namespace
}  // namespace wellspring::test
