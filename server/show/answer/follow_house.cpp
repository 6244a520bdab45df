// SPDX-License-Identifier: Apache-2.0
#include "show/answer/follow_house.h"

#include <algorithm>

#include "base/log.h"
#include "show/answer/events.h"

namespace wellspring::show {

namespace {

void announce(Show& show, Announcement announcement) {
  show.totals.announcements++;
  log::info("announcement {}: {}", announcement.id,
            announcement.text.empty() ? "the last is taken back" : "on all screens");
  show.announced_until = show.time + announcement.seconds;
  show.announced = std::move(announcement);
  const std::string message = announce_message(show.announced, show.announced.seconds);
  for (Visitor& visitor : show.visitors)
    if (visitor.welcomed) visitor.link->send_text(message);
}

// Nobody is before it: a page that begins anew takes nothing from anybody.
bool may_reload(const Show& show, const Visitor& page) {
  const Kiosk* kiosk = kiosk_of(show, page);
  return page.screen.showing == Showing::well && (!kiosk || !is_visit(kiosk->stage.now));
}

}  // namespace

void follow_house(Show& show, Arrivals& arrivals) {
  const HouseState before = show.house;
  show.house = house_at(show.settings.house, show.local_time);
  if (show.ticks > 1 && show.house.open != before.open)
    log::info("the house is {}", show.house.open ? "open" : "closed");
  std::string message = house_message(show, false);
  const bool news = message != show.house_message;
  show.house_message = std::move(message);
  for (Visitor& page : show.visitors) {
    if (!page.welcomed || !page.kiosk) continue;
    if (news) page.link->send_text(show.house_message);
    if (page.loaded_night >= show.house.night || !may_reload(show, page)) continue;
    page.loaded_night = show.house.night;
    page.link->send_text(house_message(show, true));
  }
  for (Announcement& announcement : arrivals.take_announcements())
    announce(show, std::move(announcement));
}

void tell_house(const Show& show, Visitor& visitor) {
  if (visitor.kiosk) {
    visitor.loaded_night = show.house.night;
    visitor.link->send_text(show.house_message);
  }
  const double left = show.announced_until - show.time;
  if (left > 0 && !show.announced.text.empty())
    visitor.link->send_text(announce_message(show.announced, left));
}

}  // namespace wellspring::show
