// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_kiosks.h"

#include <algorithm>
#include <set>

namespace wellspring::show {

namespace {

constexpr double longest = 3600;  // seconds that a kiosk may be told to wait
constexpr double smallest_screen = 0.1, largest_screen = 10;  // metres

// What is left out stays as it is.
void read_times(KioskTimes& times, Fields fields) {
  auto read = [&](const char* name, double& seconds) {
    seconds = fields.number(name, false, seconds, 0, longest);
  };
  read("hold_person", times.hold_person);
  read("sleep_after", times.sleep_after);
  read("leave_after", times.leave_after);
  read("leave_untouched", times.leave_untouched);
  read("leave_playing", times.leave_playing);
  read("farewell", times.farewell);
  read("sleep_latest", times.sleep_latest);
  fields.finish();
}

}  // namespace

void read_kiosks(Exhibit& exhibit, Fields& root) {
  std::set<std::string> named;
  root.objects("kiosks", false, [&](Fields fields) {
    const std::string name = fields.text("name", true);
    if (!named.insert(name).second)
      fields.problem("name", "'" + name + "' is taken by another kiosk");
    auto is_it = [&](const KioskSettings& one) { return one.name == name; };
    auto kiosk = std::find_if(exhibit.kiosks.begin(), exhibit.kiosks.end(), is_it);
    if (kiosk == exhibit.kiosks.end()) kiosk = exhibit.kiosks.insert(kiosk, KioskSettings{name});
    kiosk->viewpoint = fields.text("viewpoint", false, kiosk->viewpoint);
    if (!kiosk->viewpoint.empty() && find_viewpoint(exhibit, kiosk->viewpoint) < 0)
      fields.problem("viewpoint", unknown_viewpoint(exhibit, kiosk->viewpoint));
    kiosk->teller = fields.text("teller", false, kiosk->teller);
    if (!kiosk->teller.empty() && find_storyteller(exhibit, kiosk->teller) < 0)
      fields.problem("teller", unknown_storyteller(exhibit, kiosk->teller));
    kiosk->volume = float(fields.number("volume", false, double(kiosk->volume), 0, 1));
    fields.object("screen", false, [&](Fields screen) {
      kiosk->screen = {float(screen.number("width", true, 0, smallest_screen, largest_screen)),
                       float(screen.number("height", true, 0, smallest_screen, largest_screen))};
      screen.finish();
    });
    fields.object("times", false,
                  [&](Fields times) { read_times(kiosk->times, std::move(times)); });
    fields.finish();
  });
}

}  // namespace wellspring::show
