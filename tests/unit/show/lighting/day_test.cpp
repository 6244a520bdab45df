// SPDX-License-Identifier: Apache-2.0
#include "show/lighting/day.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wellspring::test {
namespace {

// Towards -Z and up: the south of the scene at noon.
PunctualLight sun_at(double elevation_deg, double azimuth_deg = 0) {
  const double e = glm::radians(elevation_deg), a = glm::radians(azimuth_deg);
  PunctualLight sun{
      .type = PunctualType::directional,
      .direction = -vec3(std::sin(a) * std::cos(e), std::sin(e), -std::cos(a) * std::cos(e)),
      .intensity = vec3(12, 11, 9)};
  return sun;
}

Day day_of(DaySettings settings, double elevation_deg, double azimuth_deg = 0) {
  const PunctualLight sun = sun_at(elevation_deg, azimuth_deg);
  EXPECT_EQ(day_problem(settings, sun), "");
  Day day = make_day(settings, sun);
  day.lamp = 0, day.sun_lamp = 1;
  return day;
}

double elevation(const Day& day, double hour) {
  return glm::degrees(std::asin(eval_sun_place(day, hour).y));
}

// At 41 degrees of latitude the sun of an equinox stands 49 degrees high at noon, rises at 6 in the
// east and sets at 18 in the west.
TEST(Day, TheSunTakesItsWay) {
  const Day day = day_of({.latitude = 41}, 49);
  EXPECT_NEAR(day.declination, 0, 1e-4);
  EXPECT_NEAR(elevation(day, 12), 49, 1e-4);
  for (double hour : {6.0, 18.0}) EXPECT_NEAR(elevation(day, hour), 0, 1e-4);
  // North is +Z here, so that east is -X.
  const dvec3 rises = eval_sun_place(day, 6), sets = eval_sun_place(day, 18);
  EXPECT_NEAR(rises.x, -1, 1e-4);
  EXPECT_NEAR(sets.x, 1, 1e-4);
  EXPECT_LT(elevation(day, 0), -45);
  for (double hour = 0; hour < 24; hour += 0.5)
    EXPECT_NEAR(glm::length(eval_sun_place(day, hour)), 1, 1e-9);
  // Midsummer, from a place and a height: 90 - 50 + 23.44.
  const Day summer = day_of({.latitude = 50}, 63.44);
  EXPECT_NEAR(glm::degrees(summer.declination), 23.44, 0.01);
  EXPECT_GT(elevation(summer, 4.2), 0);
}

TEST(Day, AtItsOwnHourItIsTheSceneAndClosesToItSmoothly) {
  for (double at : {9.25, 13.5, 16.0}) {
    const Day day = day_of({.at = at, .latitude = 49}, 30, 28);
    const PunctualLight own = eval_sun(day, at);
    EXPECT_LT(glm::length(own.direction - day.sun.direction), 1e-5f) << at;
    EXPECT_LT(glm::length(own.intensity - day.sun.intensity), 1e-3f) << at;
    EXPECT_NEAR(eval_sky(day, at), 1, 1e-5);
    // A minute later: a quarter of a degree.
    const PunctualLight soon = eval_sun(day, at + 1 / 60.0);
    EXPECT_LT(glm::length(soon.direction - own.direction), 0.005f);
    EXPECT_LT(glm::length(soon.intensity - own.intensity), 0.2f);
  }
}

TEST(Day, EveningsAreDarkerAndTheSunRedder) {
  const Day day = day_of({.at = 12, .latitude = 49}, 41);
  float sun_before = 1e9f, sky_before = 2, blue_before = 1;
  for (double hour : {13.0, 15.0, 16.5, 17.5, 17.9}) {
    const vec3 sun = eval_sun(day, hour).intensity;
    EXPECT_LT(luminance(sun), sun_before) << hour;
    EXPECT_LT(sun.z / sun.x, blue_before) << hour;
    EXPECT_LT(eval_sky(day, hour), sky_before) << hour;
    EXPECT_GT(eval_sky(day, hour), 0.01f) << hour;
    sun_before = luminance(sun), sky_before = eval_sky(day, hour), blue_before = sun.z / sun.x;
  }
  for (double hour : {19.0, 20.5, 22.0, 5.0}) {
    EXPECT_EQ(eval_sun(day, hour).intensity, vec3(0)) << "the sun has set: " << hour;
    EXPECT_LT(eval_sky(day, hour), 0.01f) << hour;
  }
  EXPECT_GT(eval_sky(day, 18.2), 0) << "dusk";
  EXPECT_EQ(eval_sky(day, 12), 1);
}

TEST(Day, HoursAreWholeMinutesOfItsOwnSpan) {
  const Day day = day_of({.from = 6, .to = 21, .at = 12.5, .latitude = 49}, 40);
  EXPECT_EQ(hour_of_day(day, 3), 6);
  EXPECT_EQ(hour_of_day(day, 23.9), 21);
  EXPECT_EQ(hour_of_day(day, 17.5001), 17.5);
  EXPECT_FALSE(hour_of_day(day, 12.5));
  EXPECT_FALSE(hour_of_day(day, 12.5005));
  EXPECT_TRUE(hour_of_day(day, 12.6));
}

TEST(Day, LampsFollowSwitchAndHour) {
  const std::optional<Day> day = day_of({.at = 12, .latitude = 49}, 41);
  const LampSwitch on[] = {1, 1}, off[] = {0, 1};
  EXPECT_EQ(lamp_levels({}, on, {}), (LampLevels{lamp_full, lamp_full}));
  EXPECT_EQ(lamp_levels(day, on, {}), (LampLevels{lamp_full, lamp_full, lamp_full}));
  EXPECT_EQ(lamp_levels(day, off, {}), (LampLevels{0, lamp_full, 0}));
  const LampLevels evening = lamp_levels(day, on, 17.5);
  EXPECT_EQ(evening[2], 0) << "the scene's sun";
  EXPECT_EQ(evening[1], lamp_full) << "no daylight";
  EXPECT_NEAR(brightness_of(evening[0]), eval_sky(*day, 17.5), 0.01);
  EXPECT_EQ(lamp_levels(day, off, 17.5), (LampLevels{0, lamp_full, 0}));
  EXPECT_EQ(lamp_levels(day, on, 22), (LampLevels{0, lamp_full, 0}));
}

TEST(Day, LevelsAreFineInTheDarkAndExactAtTheirEnds) {
  EXPECT_EQ(brightness_of(0), 0);
  EXPECT_EQ(brightness_of(lamp_full), 1);
  for (int level = 0; level <= 255; level++)
    EXPECT_EQ(level_of(brightness_of(LampLevel(level))), level);
  EXPECT_LT(brightness_of(16) - brightness_of(15), 0.0005f);
}

TEST(Day, WhatCannotBeIsToldWithWhy) {
  EXPECT_NE(day_problem({.at = 12, .latitude = 49}, sun_at(5)).find("10 at least"),
            std::string::npos);
  EXPECT_NE(day_problem({.at = 12, .latitude = 49}, sun_at(80)).find("at most 64"),
            std::string::npos);
  EXPECT_NE(day_problem({.at = 12, .latitude = 10}, sun_at(30)).find("higher"), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
