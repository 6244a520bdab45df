// SPDX-License-Identifier: Apache-2.0
#include "show/answer/idle.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/log.h"
#include "show/answer/come_back.h"
#include "show/answer/events.h"
#include "show/count/count.h"
#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "wire/json.h"

namespace wellspring::show {
namespace {

// Returns whether it is a message that the page of somebody who is not there sends by itself.
bool tells_of_nobody(const BrowserMessage& message) {
  if (const Input* input = std::get_if<Input>(&message))
    return input->move == vec3(0) && input->look == vec2(0) && !input->pointer;
  return std::holds_alternative<Ack>(message) || std::holds_alternative<Settings>(message);
}

bool is_told_something(const Show& show, const Visitor& visitor) {
  const Visitor* leader = leader_of(show.visits, visitor);
  const Voice& narrator = (leader ? *leader : visitor).hearing.narration.voice;
  if (!narrator.queue.empty() && !narrator.paused) return true;
  const Teller& teller = teller_of(show.cast, show.visits, visitor);
  return !teller.voice.queue.empty() && !teller.voice.paused && listens_to(show, visitor, teller);
}

bool leads_somebody(const ShowVisits& visits, const Visitor& visitor) {
  return !visitor.group.leads.empty() &&
         std::ranges::any_of(visits.visitors, [&](const Visitor& other) {
           return other.group.follows == visitor.group.leads;
         });
}

void send_to_rest(Show& show, std::list<Visitor>::iterator visitor) {
  log::info("visitor {} rests", visitor->link->id);
  Hello hello = visitor->presence.hello;
  hello.lang = visitor->lang;
  hello.width = visitor->wants.width, hello.height = visitor->wants.height;
  hello.resume = visit_token(show, *visitor);
  visitor->link->drop_sound();
  visitor->link->send_text(idle_message("paused", 0));
  visitor->link->put_back(hear_visitor(write_message(hello)));
  show.visits.resting.push_back(visitor->link);
  count_leaving(show, *visitor);
  show.visits.visitors.erase(visitor);
}

}  // namespace

void note_presence(Visitor& visitor, const BrowserMessage& message) {
  VisitorPresence& presence = visitor.presence;
  if (const Hello* hello = std::get_if<Hello>(&message)) presence.hello = *hello;
  const PresenceNews* news = std::get_if<PresenceNews>(&message);
  if (news) presence.hidden = news->here ? -1 : std::max(presence.hidden, 0.0);
  if (!(news && !news->here) && !tells_of_nobody(message)) presence.quiet = 0;
}

void watch_presence(Show& show, double dt) {
  const ShowSettings& settings = show.settings;
  for (auto next = show.visits.visitors.begin(); next != show.visits.visitors.end();) {
    auto visitor = next++;
    VisitorPresence& presence = visitor->presence;
    if (!visitor->welcomed || visitor->kiosk || is_of_wall(*visitor)) continue;
    const bool busy = is_told_something(show, *visitor) || leads_somebody(show.visits, *visitor);
    if (busy || visitor->place.moved_at == show.time) presence.quiet = 0;
    else presence.quiet += dt;
    if (presence.hidden >= 0) presence.hidden = busy ? 0 : presence.hidden + dt;
    const bool idle = settings.idle_after > 0 && presence.quiet > settings.idle_after;
    if (idle != presence.asked)
      visitor->link->send_text(idle_message(idle ? "asked" : "here", settings.idle_answer));
    presence.asked = idle;
    const bool silent = idle && presence.quiet > settings.idle_after + settings.idle_answer;
    const bool unseen = settings.hidden_after > 0 && presence.hidden > settings.hidden_after;
    if (!silent && !unseen) continue;
    const bool in_pass = show.drawing->pass.visitor == visitor->link->id;
    if (in_pass) show.drawing->pass.given_up = true;
    if (!visitor->picture->at_work && !in_pass) send_to_rest(show, visitor);  // else soon
  }
}

namespace {

void announce(Show& show, Announcement announcement) {
  show.totals.announcements++;
  log::info("announcement {}: {}", announcement.id,
            announcement.text.empty() ? "the last is taken back" : "on all screens");
  show.house.announced_until = show.time + announcement.seconds;
  show.house.announced = std::move(announcement);
  const std::string message = announce_message(show.house.announced, show.house.announced.seconds);
  for (Visitor& visitor : show.visits.visitors)
    if (visitor.welcomed) visitor.link->send_text(message);
}

// Nobody is before it: a page that begins anew takes nothing from anybody.
bool may_reload(const Show& show, const Visitor& page) {
  const Kiosk* kiosk = kiosk_of(show, page);
  return page.screen.showing == Showing::well && (!kiosk || !is_visit(kiosk->stage.now));
}

}  // namespace

void follow_house(Show& show, Arrivals& arrivals) {
  const HouseState before = show.house.state;
  show.house.state = house_at(show.settings.house, show.house.local_time);
  if (show.ticks > 1 && show.house.state.open != before.open)
    log::info("the house is {}", show.house.state.open ? "open" : "closed");
  std::string message = house_message(show, false);
  const bool news = message != show.house.message;
  show.house.message = std::move(message);
  for (Visitor& page : show.visits.visitors) {
    if (!page.welcomed || !page.kiosk) continue;
    if (news) page.link->send_text(show.house.message);
    if (page.loaded_night >= show.house.state.night || !may_reload(show, page)) continue;
    page.loaded_night = show.house.state.night;
    page.link->send_text(house_message(show, true));
  }
  for (Announcement& announcement : arrivals.take_announcements())
    announce(show, std::move(announcement));
}

void tell_house(const ShowHouse& house, double time, Visitor& visitor) {
  if (visitor.kiosk) {
    visitor.loaded_night = house.state.night;
    visitor.link->send_text(house.message);
  }
  const double left = house.announced_until - time;
  if (left > 0 && !house.announced.text.empty())
    visitor.link->send_text(announce_message(house.announced, left));
}

}  // namespace wellspring::show
