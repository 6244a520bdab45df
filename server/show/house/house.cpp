// SPDX-License-Identifier: Apache-2.0
#include "show/house/house.h"

#include <algorithm>
#include <chrono>

#include "base/log.h"
#include "show/exhibit/load/exhibit_story.h"

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

namespace {

// "00:00" to "24:00" to minutes; -1: it is no time.
int read_time(const nlohmann::json& value) {
  if (!value.is_string()) return -1;
  const std::string& text = value.get_ref<const std::string&>();
  auto digit = [&](size_t i) { return text[i] >= '0' && text[i] <= '9' ? text[i] - '0' : 100; };
  if (text.size() != 5 || text[2] != ':') return -1;
  const int hour = 10 * digit(0) + digit(1), minute = 10 * digit(3) + digit(4);
  if (minute >= 60 || hour * 60 + minute > minutes_a_day) return -1;
  return hour * 60 + minute;
}

// Reads two times.
std::optional<MinuteSpan> read_span(const JsonValue& field) {
  const nlohmann::json& value = field.value();
  const bool two = value.is_array() && value.size() == 2;
  const MinuteSpan span{two ? read_time(value[0]) : -1, two ? read_time(value[1]) : -1};
  const char* wrong = nullptr;
  if (span.begin < 0 || span.end < 0) wrong = "must be two times such as [\"09:00\", \"17:00\"]";
  else if (span.begin == minutes_a_day) wrong = "begins at 24:00; that is 00:00 of the next day";
  else if (span.begin == span.end) wrong = "begins and ends at the same time";
  if (!wrong) return span;
  field.fail(wrong);
  return std::nullopt;
}

void read_hours(HouseSettings& house, FieldReader& fields) {
  house.always_open = false;
  auto day = [&](const char* name, std::optional<MinuteSpan>& open) {
    const auto field = fields.take(name, FieldReader::list_schema({{"type", "string"}}, 0, 2),
                                   "two times such as 09:00 and 17:00, or none: closed");
    if (!field) return;
    const bool closed = field->value().is_array() && field->value().empty();
    open = closed ? std::nullopt : read_span(*field);
  };
  std::optional<MinuteSpan> every;
  day("every", every);
  house.open.fill(every);
  for (size_t i = 0; i < house.open.size(); i++) day(weekday_names[i], house.open[i]);
}

void read_quiet(HouseSettings& house, FieldReader& root) {
  const nlohmann::ordered_json pair = FieldReader::list_schema({{"type", "string"}}, 2, 2);
  const auto list = root.take("quiet", FieldReader::list_schema(pair, 0),
                              "pairs of times between which it is quiet, every day");
  if (!list) return;
  for (const JsonValue& one : list->list(0, SIZE_MAX, "pairs of times"))
    if (const auto span = read_span(one)) house.quiet.push_back(*span);
}

void read_reload(HouseSettings& house, FieldReader& root) {
  const auto field =
      root.take("reload", {{"type", "string"}}, "the time at which kiosk pages begin anew");
  if (!field) return;
  const int minute = read_time(field->value());
  if (minute >= 0 && minute < minutes_a_day) house.reload = minute;
  else field->fail("must be a time from \"00:00\" to \"23:59\"");
}

void read_settings(HouseSettings& house, Exhibit& exhibit, FieldReader& root) {
  root.part("hours", "when it is open; without them always",
            [&](FieldReader& hours) { read_hours(house, hours); });
  read_quiet(house, root);
  root.number("volume", 0, 1, house.volume, "of all kiosks");
  root.number("quiet_volume", 0, 1, house.quiet_volume, "at quiet times");
  root.boolean("headphones", house.headphones, "kiosks have some, for quiet times");
  read_reload(house, root);
  house.address = read_address(root, "address", "this server's address for people's phones", true);
  while (house.address.ends_with('/')) house.address.pop_back();
  if (house.address.find_first_of("?#") != std::string::npos)
    root.fail("address", "must be an address without '?' and '#'");
  read_kiosks(exhibit, root);
}

}  // namespace

HouseSettings read_house(const std::string& file, Exhibit& exhibit,
                         std::vector<Problem>& problems) {
  HouseSettings house;
  read_fields(file, problems, [&](FieldReader& root) { read_settings(house, exhibit, root); });
  return house;
}

nlohmann::ordered_json house_schema() {
  return describe_fields("A house of Wellspring (docs/kiosk.md explains every field)",
                         [](FieldReader& root) {
                           HouseSettings house;
                           Exhibit none;
                           read_settings(house, none, root);
                         });
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
