// SPDX-License-Identifier: Apache-2.0
// The house's day at local times of the test's own, its file, and clocks that are put forward and
// back.
#include "show/house/house.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>

#include "unit/folder.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

using namespace std::chrono;

int64_t day_of(year_month_day date) { return sys_days(date).time_since_epoch().count(); }
const int64_t monday = day_of(2026y / November / 23);

LocalTime at(int64_t day, int hour, int minute = 0) { return {day, hour * 60 + minute}; }

HouseSettings read(const std::string& text, std::vector<Problem>* problems = nullptr,
                   Exhibit* exhibit = nullptr) {
  const test::Folder folder;
  std::vector<Problem> found;
  Exhibit tiny = make_tiny_exhibit();
  const HouseSettings house =
      read_house(folder.write("house.json", text), exhibit ? *exhibit : tiny, found);
  if (problems) *problems = found;
  else
    for (const Problem& problem : found) ADD_FAILURE() << to_string(problem);
  return house;
}

bool is_open(const HouseSettings& house, const LocalTime& now) { return house_at(house, now).open; }

TEST(House, WithoutHoursItIsAlwaysOpen) {
  const HouseSettings house = read("{}");
  for (int minute = 0; minute < 7 * minutes_a_day; minute++)
    ASSERT_TRUE(is_open(house, {monday + minute / minutes_a_day, minute % minutes_a_day}));
  EXPECT_FALSE(is_open(read(R"({"hours": {}})"), at(monday, 12))) << "hours, but none";
}

TEST(House, DaysThatAreLeftOutAreClosed) {
  const HouseSettings house =
      read(R"({"hours": {"mon": ["09:00", "17:00"], "sun": ["10:30", "12:00"]}})");
  EXPECT_FALSE(is_open(house, at(monday, 8, 59)));
  EXPECT_TRUE(is_open(house, at(monday, 9)));
  EXPECT_TRUE(is_open(house, at(monday, 16, 59)));
  EXPECT_FALSE(is_open(house, at(monday, 17)));
  for (int day = 1; day < 6; day++)
    for (int hour = 0; hour < 24; hour++)
      EXPECT_FALSE(is_open(house, at(monday + day, hour))) << day << " " << hour;
  EXPECT_FALSE(is_open(house, at(monday + 6, 10, 29)));
  EXPECT_TRUE(is_open(house, at(monday + 6, 10, 30)));
  EXPECT_FALSE(is_open(house, at(monday - 1, 12)));
}

TEST(House, ADayComesBeforeEvery) {
  const HouseSettings house =
      read(R"({"hours": {"every": ["09:00", "17:00"], "mon": [], "sat": ["12:00", "24:00"]}})");
  EXPECT_FALSE(is_open(house, at(monday, 12)));
  EXPECT_TRUE(is_open(house, at(monday + 1, 12)));
  EXPECT_FALSE(is_open(house, at(monday + 5, 9)));
  EXPECT_TRUE(is_open(house, at(monday + 5, 23, 59)));
  EXPECT_FALSE(is_open(house, at(monday + 6, 0)));
}

TEST(House, HoursGoOverMidnight) {
  const HouseSettings house = read(R"({"hours": {"sun": ["18:00", "02:00"],
      "wed": ["22:00", "00:00"]}})");
  EXPECT_FALSE(is_open(house, at(monday - 1, 1))) << "of Saturday's evening";
  EXPECT_TRUE(is_open(house, at(monday - 1, 18)));
  EXPECT_TRUE(is_open(house, at(monday, 1, 59)));
  EXPECT_FALSE(is_open(house, at(monday, 2)));
  EXPECT_FALSE(is_open(house, at(monday, 18)));
  EXPECT_TRUE(is_open(house, at(monday + 2, 23, 59)));
  EXPECT_FALSE(is_open(house, at(monday + 3, 0)));
}

TEST(House, AWholeDay) {
  const HouseSettings house = read(R"({"hours": {"tue": ["00:00", "24:00"]}})");
  EXPECT_FALSE(is_open(house, at(monday, 23, 59)));
  EXPECT_TRUE(is_open(house, at(monday + 1, 0)));
  EXPECT_TRUE(is_open(house, at(monday + 1, 23, 59)));
  EXPECT_FALSE(is_open(house, at(monday + 2, 0)));
}

TEST(House, QuietHoursMakeNoKioskLouder) {
  const HouseSettings house = read(
      R"({"quiet": [["12:00", "13:00"], ["22:00", "06:00"]], "volume": 0.8, "quiet_volume": 0.2})");
  auto volume = [&](int hour, float own) {
    return kiosk_volume(house, house_at(house, at(monday, hour)), own);
  };
  for (int hour = 0; hour < 24; hour++) {
    const bool quiet = hour == 12 || hour >= 22 || hour < 6;
    EXPECT_EQ(house_at(house, at(monday, hour)).quiet, quiet) << hour;
    EXPECT_FLOAT_EQ(volume(hour, 1), quiet ? 0.2f : 0.8f) << hour;
    EXPECT_FLOAT_EQ(volume(hour, 0.1f), 0.08f) << hour;
  }
}

TEST(House, ANightBeginsWhenItReloads) {
  const HouseSettings house = read(R"({"reload": "04:00"})");
  const int64_t night = house_at(house, at(monday, 3, 59)).night;
  EXPECT_EQ(house_at(house, at(monday - 1, 4)).night, night);
  EXPECT_EQ(house_at(house, at(monday, 4)).night, night + 1);
  EXPECT_EQ(house_at(house, at(monday + 1, 3, 59)).night, night + 1);
  EXPECT_EQ(house_at(read("{}"), at(monday, 4)).night, house_at(read("{}"), at(0, 0)).night);
}

TEST(House, WeekdaysAreThoseOfTheCalendar) {
  for (int64_t day = -1000; day < 40000; day++) {
    const weekday there{sys_days(days(day))};
    ASSERT_EQ(weekday_of(day), int(there.iso_encoding()) - 1) << day;
  }
}

// Sets a time zone for the test, and sets it back.
struct HouseZone : testing::Test {
  std::string before;
  void SetUp() override {
    if (const char* zone = getenv("TZ")) before = zone;
    set("CET-1CEST,M3.5.0,M10.5.0/3");
  }
  void TearDown() override { set(before); }
  static void set(const std::string& zone) {
    if (zone.empty()) unsetenv("TZ");
    else setenv("TZ", zone.c_str(), 1);
    tzset();
  }
  // Returns the clock's time so many minutes after midnight in Greenwich.
  static LocalTime clock(year_month_day date, int minutes) {
    return local_time(std::time_t(day_of(date) * 86400 + minutes * 60 + 30));
  }
};

TEST_F(HouseZone, TheClockOnTheWallRules) {
  const LocalTime winter = clock(2026y / November / 22, 23 * 60 + 10);
  EXPECT_EQ(winter.day, monday);
  EXPECT_EQ(winter.minute, 10);
  EXPECT_EQ(clock(2026y / July / 1, 12 * 60).minute, 14 * 60);
  set("PST8");
  EXPECT_EQ(clock(2026y / November / 23, 60).day, monday - 1);
}

TEST_F(HouseZone, AClockPutForwardLeavesNothingOut) {
  const auto date = 2026y / March / 29;  // 02:00 is 03:00
  const HouseSettings house = read(
      R"({"hours": {"sun": ["02:30", "05:00"]}, "reload": "02:30", "quiet": [["01:00", "02:30"]]})");
  EXPECT_FALSE(is_open(house, clock(date, 59)));
  EXPECT_EQ(clock(date, 60).minute, 3 * 60);
  EXPECT_TRUE(is_open(house, clock(date, 60)));
  EXPECT_TRUE(house_at(house, clock(date, 59)).quiet);
  EXPECT_FALSE(house_at(house, clock(date, 60)).quiet);
  EXPECT_EQ(house_at(house, clock(date, 60)).night, house_at(house, clock(date, 59)).night + 1);
  EXPECT_TRUE(is_open(house, clock(date, 2 * 60 + 59)));
  EXPECT_FALSE(is_open(house, clock(date, 3 * 60)));
}

TEST_F(HouseZone, AClockPutBackReloadsOnce) {
  const auto date = 2026y / October / 25;  // 03:00 is 02:00
  const HouseSettings house = read(R"({"hours": {"sun": ["02:30", "10:00"]}, "reload": "02:30"})");
  int64_t most = house_at(house, clock(date, 0)).night;
  int reloads = 0;
  for (int minute = 0; minute < 24 * 60 - 120; minute++)
    if (const int64_t night = house_at(house, clock(date, minute)).night; night > most)
      most = night, reloads++;
  EXPECT_EQ(reloads, 1);
  EXPECT_TRUE(is_open(house, clock(date, 30))) << "02:30";
  EXPECT_FALSE(is_open(house, clock(date, 60))) << "02:00, again";
  EXPECT_TRUE(is_open(house, clock(date, 90))) << "02:30, again";
  EXPECT_TRUE(is_open(house, clock(date, 9 * 60 - 1)));
  EXPECT_FALSE(is_open(house, clock(date, 9 * 60)));
}

TEST(HouseFile, SaysMoreOfTheKiosksOfTheExhibit) {
  Exhibit exhibit = make_tiny_exhibit();
  KioskSettings& hall = exhibit.kiosks.emplace_back();
  hall.name = "hall";
  hall.viewpoint = "corner";
  hall.volume = 0.5f;
  hall.times.farewell = 4;
  read(R"({"kiosks": [{"name": "hall", "volume": 0.3, "times": {"sleep_after": 10}},
      {"name": "attic"}]})",
       nullptr, &exhibit);
  ASSERT_EQ(exhibit.kiosks.size(), 2u);
  EXPECT_EQ(exhibit.kiosks[0].viewpoint, "corner");
  EXPECT_FLOAT_EQ(exhibit.kiosks[0].volume, 0.3f);
  EXPECT_EQ(exhibit.kiosks[0].times.farewell, 4);
  EXPECT_EQ(exhibit.kiosks[0].times.sleep_after, 10);
  EXPECT_EQ(exhibit.kiosks[1].name, "attic");
  EXPECT_EQ(exhibit.kiosks[1].volume, 1);
}

TEST(HouseFile, WhatIsWrongIsNamed) {
  const std::pair<const char*, const char*> wrong[] = {
      {R"({"hours": {"mon": "09:00"}})", "/hours/mon"},
      {R"({"hours": {"mon": ["9:00", "17:00"]}})", "/hours/mon"},
      {R"({"hours": {"tue": ["09:00", "24:01"]}})", "/hours/tue"},
      {R"({"hours": {"tue": ["09:60", "10:00"]}})", "/hours/tue"},
      {R"({"hours": {"every": ["24:00", "10:00"]}})", "/hours/every"},
      {R"({"hours": {"fri": ["10:00", "10:00"]}})", "/hours/fri"},
      {R"({"hours": {"fri": ["10:00", "12:00", "14:00"]}})", "/hours/fri"},
      {R"({"hours": {"monday": ["10:00", "12:00"]}})", "/hours/monday"},
      {R"({"hours": ["10:00", "12:00"]})", "/hours"},
      {R"({"quiet": ["12:00", "13:00"]})", "/quiet/0"},
      {R"({"quiet": "12:00"})", "/quiet"},
      {R"({"volume": 1.1})", "/volume"},
      {R"({"quiet_volume": -1})", "/quiet_volume"},
      {R"({"headphones": 1})", "/headphones"},
      {R"({"reload": "24:00"})", "/reload"},
      {R"({"reload": 4})", "/reload"},
      {R"({"address": "museum.example"})", "/address"},
      {R"({"address": "https://a b"})", "/address"},
      {R"({"kiosks": [{"name": "a"}, {"name": "a"}]})", "/kiosks/1/name"},
      {R"({"opening": {}})", "/opening"},
      {R"({"hours": )", "house.json"},
      {"[]", "house.json"},
  };
  for (const auto& [text, place] : wrong) {
    std::vector<Problem> problems;
    read(text, &problems);
    std::string all;
    for (const Problem& problem : problems) all += to_string(problem) + "\n";
    EXPECT_NE(all.find(place), std::string::npos) << text << "\n" << all;
  }
  const test::Folder folder;
  Exhibit exhibit = make_tiny_exhibit();
  EXPECT_THROW(load_house(folder.file("none.json"), exhibit), ExhibitError);
  EXPECT_THROW(load_house(folder.write("h.json", R"({"volume": 7})"), exhibit), ExhibitError);
  EXPECT_FALSE(load_house(folder.write("h.json", R"({"hours": {}})"), exhibit).always_open);
}

}  // namespace
}  // namespace wellspring::test
