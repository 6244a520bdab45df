// SPDX-License-Identifier: Apache-2.0
// The day of the house is a function of its settings and of what the clock on its wall shows. When
// the clock is put forward or back, the clock rules: an hour that is left out is nobody's, one that
// comes twice is taken twice.
#pragma once
#include <array>
#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// The house says these things on all screens.

struct Announcement {
  uint32_t id = 0;     // grows with each
  LocalText text;      // empty: the last is taken back
  double seconds = 0;  // duration on the screens
  bool urgent = false;
};

inline constexpr int minutes_a_day = 24 * 60;

// Minutes since midnight, the first and the one after the last; an end that is not after the
// beginning is on the next day.
struct MinuteSpan {
  int begin = 0, end = minutes_a_day;
};

inline constexpr const char* weekday_names[] = {"mon", "tue", "wed", "thu", "fri", "sat", "sun"};

struct HouseSettings {
  bool always_open = true;                        // whatever `open` says
  std::array<std::optional<MinuteSpan>, 7> open;  // by weekday; nothing: closed
  std::vector<MinuteSpan> quiet;                  // every day
  float volume = 1, quiet_volume = 0.2f;          // volumes of kiosks, 0 to 1
  bool headphones = false;                        // kiosks have some, for quiet hours
  std::optional<int> reload;                      // minute at which kiosk pages begin anew
  std::string
      address;  // this server's address for people's phones, without a slash at its end; or empty
};

// Holds what a clock on the wall and a calendar show.
struct LocalTime {
  int64_t day = 0;  // since 1970-01-01
  int minute = 0;   // since midnight
};
// In the process's time zone (TZ).
LocalTime local_time(std::time_t time);
// Index into weekday_names.
int weekday_of(int64_t day);

struct HouseState {
  bool open = true, quiet = false;
  int64_t night = 0;  // the day of the last time to reload; grows by one a day
};
HouseState house_at(const HouseSettings& settings, const LocalTime& now);

// Returns the volume of a kiosk whose own volume is `own`: quiet hours make none louder.
float kiosk_volume(const HouseSettings& settings, const HouseState& house, float own);

// The house file of `./wellspring run --house FILE` (docs/kiosk.md), checked as an exhibit is.

// Never throws; what is wrong is in `problems`. Its `kiosks` come into the exhibit: what is said of
// one that is there already takes the place of what was said.
HouseSettings read_house(const std::string& file, Exhibit& exhibit, std::vector<Problem>& problems);

// As above. Throws ExhibitError where a problem is fatal; logs the others.
HouseSettings load_house(const std::string& file, Exhibit& exhibit);

// Returns the JSON Schema of a house file, out of the same list of fields.
nlohmann::ordered_json house_schema();

}  // namespace wellspring::show
