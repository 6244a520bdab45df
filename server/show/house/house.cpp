// SPDX-License-Identifier: Apache-2.0
#include "show/house/house.h"

#include <algorithm>
#include <chrono>

namespace wellspring::show {

namespace {

bool is_over_midnight(const MinuteSpan& span) { return span.end <= span.begin; }

// Of the part of a span that is on the day of its beginning, and of the rest on the next.
bool is_within(const MinuteSpan& span, int minute) {
  return minute >= span.begin && (is_over_midnight(span) || minute < span.end);
}
bool is_within_rest(const MinuteSpan& span, int minute) {
  return is_over_midnight(span) && minute < span.end;
}

bool is_open(const HouseSettings& settings, const LocalTime& now) {
  if (settings.always_open) return true;
  const auto& today = settings.open[size_t(weekday_of(now.day))];
  const auto& yesterday = settings.open[size_t(weekday_of(now.day - 1))];
  return (today && is_within(*today, now.minute)) ||
         (yesterday && is_within_rest(*yesterday, now.minute));
}

}  // namespace

LocalTime local_time(std::time_t time) {
  std::tm parts{};
  localtime_r(&time, &parts);
  const std::chrono::sys_days day = std::chrono::year(parts.tm_year + 1900) /
                                    std::chrono::month(unsigned(parts.tm_mon + 1)) /
                                    std::chrono::day(unsigned(parts.tm_mday));
  return {day.time_since_epoch().count(), parts.tm_hour * 60 + parts.tm_min};
}

int weekday_of(int64_t day) {
  const int64_t since_monday = (day + 3) % 7;  // 1970-01-01 was a Thursday
  return int(since_monday < 0 ? since_monday + 7 : since_monday);
}

HouseState house_at(const HouseSettings& settings, const LocalTime& now) {
  HouseState house;
  house.open = is_open(settings, now);
  house.quiet = std::any_of(settings.quiet.begin(), settings.quiet.end(), [&](auto& span) {
    return is_within(span, now.minute) || is_within_rest(span, now.minute);
  });
  if (settings.reload) house.night = now.day - (now.minute < *settings.reload);
  return house;
}

float kiosk_volume(const HouseSettings& settings, const HouseState& house, float own) {
  const float volume = own * settings.volume;
  return house.quiet ? std::min(volume, settings.quiet_volume) : volume;
}

}  // namespace wellspring::show
