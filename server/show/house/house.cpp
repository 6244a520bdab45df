// SPDX-License-Identifier: Apache-2.0
#include "show/house/house.h"

#include <algorithm>
#include <chrono>

#include "base/log.h"
#include "show/exhibit/exhibit_story.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

namespace {

bool is_over_midnight(const MinuteSpan& span) { return span.end <= span.begin; }

// Returns whether the minute lies in the span: in its part on the day of its beginning, or in its
// rest on the next.
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

using nlohmann::json;

namespace {

// "00:00" to "24:00" to minutes; -1: it is no time.
int read_time(const json& value) {
  if (!value.is_string()) return -1;
  const std::string& text = value.get_ref<const std::string&>();
  auto digit = [&](size_t i) { return text[i] >= '0' && text[i] <= '9' ? text[i] - '0' : 100; };
  if (text.size() != 5 || text[2] != ':') return -1;
  const int hour = 10 * digit(0) + digit(1), minute = 10 * digit(3) + digit(4);
  if (minute >= 60 || hour * 60 + minute > minutes_a_day) return -1;
  return hour * 60 + minute;
}

// Two times, noted at `place` where they are not.
std::optional<MinuteSpan> read_span(Fields& fields, const std::string& place, const json& value) {
  const bool two = value.is_array() && value.size() == 2;
  const MinuteSpan span{two ? read_time(value[0]) : -1, two ? read_time(value[1]) : -1};
  const char* wrong = nullptr;
  if (span.begin < 0 || span.end < 0) wrong = "must be two times such as [\"09:00\", \"17:00\"]";
  else if (span.begin == minutes_a_day) wrong = "begins at 24:00; that is 00:00 of the next day";
  else if (span.begin == span.end) wrong = "begins and ends at the same time";
  if (!wrong) return span;
  fields.problem(place, wrong);
  return std::nullopt;
}

void read_hours(HouseSettings& house, Fields fields) {
  house.always_open = false;
  auto day = [&](const char* name, std::optional<MinuteSpan>& open) {
    const json* value = fields.value(name);
    if (!value) return;
    const bool closed = value->is_array() && value->empty();
    open = closed ? std::nullopt : read_span(fields, name, *value);
  };
  std::optional<MinuteSpan> every;
  day("every", every);
  house.open.fill(every);
  for (size_t i = 0; i < house.open.size(); i++) day(weekday_names[i], house.open[i]);
  fields.finish();
}

void read_quiet(HouseSettings& house, Fields& root) {
  const json* list = root.value("quiet");
  if (!list) return;
  if (!list->is_array()) return root.problem("quiet", "must be a list of pairs of times");
  for (size_t i = 0; i < list->size(); i++)
    if (const auto span = read_span(root, "quiet/" + std::to_string(i), (*list)[i]))
      house.quiet.push_back(*span);
}

}  // namespace

HouseSettings read_house(const std::string& file, Exhibit& exhibit,
                         std::vector<Problem>& problems) {
  HouseSettings house;
  const auto read = read_json_file(file, problems);
  if (!read) return house;
  Fields root(*read, file, "", problems);
  root.object("hours", false, [&](Fields hours) { read_hours(house, std::move(hours)); });
  read_quiet(house, root);
  house.volume = float(root.number("volume", false, double(house.volume), 0, 1));
  house.quiet_volume = float(root.number("quiet_volume", false, double(house.quiet_volume), 0, 1));
  house.headphones = root.flag("headphones", house.headphones);
  if (const json* reload = root.value("reload")) {
    const int minute = read_time(*reload);
    if (minute >= 0 && minute < minutes_a_day) house.reload = minute;
    else root.problem("reload", "must be a time from \"00:00\" to \"23:59\"");
  }
  house.address = root.text("address", false);
  while (house.address.ends_with('/')) house.address.pop_back();
  const bool web = house.address.starts_with("https://") || house.address.starts_with("http://");
  if (!house.address.empty() && (!web || house.address.size() > 300 ||
                                 house.address.find_first_of(" \t\n\"<>?#") != std::string::npos))
    root.problem("address", "must be an address that begins with https:// or http://");
  read_kiosks(exhibit, root);
  root.finish();
  return house;
}

HouseSettings load_house(const std::string& file, Exhibit& exhibit) {
  std::vector<Problem> problems;
  HouseSettings house = read_house(file, exhibit, problems);
  if (std::any_of(problems.begin(), problems.end(), [](const Problem& p) { return p.fatal; }))
    throw ExhibitError(std::move(problems));
  for (const Problem& problem : problems) log::warn("{}", to_string(problem));
  return house;
}

}  // namespace wellspring::show
