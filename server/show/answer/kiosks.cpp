// SPDX-License-Identifier: Apache-2.0
#include "show/answer/kiosks.h"

#include <algorithm>

#include "base/log.h"
#include "show/answer/cameras.h"
#include "show/answer/commands.h"
#include "show/answer/storyteller_orders.h"
#include "show/answer/events.h"
#include "show/answer/guest_gestures.h"
#include "show/answer/kiosk_window.h"
#include "wire/json.h"

namespace wellspring::show {

namespace {

bool is_page_of(const Show& show, const Visitor& visitor, const Kiosk& kiosk) {
  return visitor.welcomed && kiosk_of(show, visitor) == &kiosk;
}

// Those that are named or connected, no others.
void keep_kiosks(Show& show) {
  std::vector<std::string> names;
  for (Eye& eye : show.eyes) {
    eye.kiosk = kiosk_name(show, eye.seen.kiosk);
    if (!is_lost(eye)) names.push_back(eye.kiosk);
  }
  for (const Visitor& visitor : show.visitors)
    if (visitor.welcomed && visitor.kiosk) names.push_back(kiosk_name(show, visitor.name));
  std::vector<KioskSettings> wanted = show.exhibit.kiosks;
  for (const std::string& name : names) {
    auto is_it = [&](const KioskSettings& one) { return one.name == name; };
    if (std::any_of(wanted.begin(), wanted.end(), is_it)) continue;
    wanted.emplace_back().name = name;
  }
  std::erase_if(show.kiosks, [&](const Kiosk& kiosk) {
    return std::none_of(wanted.begin(), wanted.end(),
                        [&](const KioskSettings& one) { return one.name == kiosk.settings.name; });
  });
  for (const KioskSettings& one : wanted)
    if (!find_kiosk(show, one.name)) show.kiosks.emplace_back().settings = one;
}

// Whether the storyteller tells something that this page asked for.
bool is_told(const Show& show, const Visitor& page) {
  return show.teller.voice.asked_by == page.link->id && !show.teller.voice.queue.empty();
}

KioskInput read_pages(Show& show, const Kiosk& kiosk) {
  KioskInput input;
  input.closed = !show.house.open;
  for (Visitor& page : show.visitors) {
    if (!is_page_of(show, page, kiosk)) continue;
    const bool told = is_told(show, page);
    const TourRide::State tour = page.place.tour.state;
    input.touched |= std::exchange(page.screen.touched, false);
    input.showing = std::max(input.showing, page.screen.showing);
    input.busy |= page.screen.showing != Showing::well || told || tour != TourRide::State::none;
    input.playing |= page.screen.playing || (told && !show.teller.voice.paused) ||
                     tour == TourRide::State::playing;
  }
  return input;
}

// Nobody is told a story who has left; lamps and hour are the house's, the screen is a window
// again.
void see_off(Show& show, const Kiosk& kiosk) {
  for (Visitor& page : show.visitors) {
    if (!is_page_of(show, page, kiosk)) continue;
    page.lamps.own.clear();
    page.lamps.wish.clear();
    page.lamps.hour.reset();
    if (is_told(show, page)) fall_silent(show, show.teller);
    if (page.place.tour.state != TourRide::State::none)
      handle(show, page, Tour{TourAction::stop, ""});
    go_to_viewpoint(page.place, page.hearing.narration.voice, show.exhibit,
                    kiosk_viewpoint(show, kiosk.settings.name));
  }
}

void note_story(Show& show, Kiosk& kiosk) {
  const std::string& story = show.teller.voice.story;
  std::vector<std::string>& heard = kiosk.visit.heard;
  if (story.empty() || !is_visit(kiosk.stage.now)) return;
  if (std::find(heard.begin(), heard.end(), story) != heard.end()) return;
  for (const Visitor& page : show.visitors)
    if (is_page_of(show, page, kiosk) && is_told(show, page)) return heard.push_back(story);
}

// A kiosk's own storyteller comes there with its guest.
void call_teller(Show& show, const Kiosk& kiosk) {
  if (kiosk.settings.teller.empty()) return;
  StorytellerOrder order;
  order.teller = kiosk.settings.teller;
  for (Visitor& page : show.visitors)
    if (is_page_of(show, page, kiosk)) {
      handle(show, page, order);
      return;
    }
}

void find_her_kiosk(Show& show) {
  if (!storyteller_of(show, show.teller)) return;
  const Kiosk* with = her_kiosk(show);
  if (with && is_visit(with->stage.now)) return;
  show.her_kiosk.reset();
  const Kiosk* first = nullptr;
  for (const Kiosk& kiosk : show.kiosks)
    if (has_guest(kiosk.stage.now) && (!first || kiosk.visit.began < first->visit.began))
      first = &kiosk;
  if (!first) return;
  show.her_kiosk = first->settings.name;
  show.her_visits++;
  call_teller(show, *first);
}

void tell_pages(Show& show) {
  std::string all = kiosk_message(show);
  const bool news = all != show.kiosk_message;
  if (news) show.kiosk_message = std::move(all);
  for (Visitor& visitor : show.visitors)
    if (news && visitor.welcomed && !visitor.kiosk) visitor.link->send_text(show.kiosk_message);
  for (Kiosk& kiosk : show.kiosks) {
    std::string message = kiosk_message(show, kiosk);
    if (message == kiosk.message) continue;
    kiosk.message = std::move(message);
    for (Visitor& visitor : show.visitors)
      if (is_page_of(show, visitor, kiosk)) visitor.link->send_text(kiosk.message);
  }
}

void tell_eyes(Show& show) {
  for (Eye& eye : show.eyes) {
    const Kiosk* kiosk = eye.observations > 0 ? find_kiosk(show, eye.kiosk) : nullptr;
    if (!kiosk || is_lost(eye)) continue;
    const bool page = std::any_of(show.visitors.begin(), show.visitors.end(),
                                  [&](auto& visitor) { return is_page_of(show, visitor, *kiosk); });
    const bool here = show.her_kiosk == eye.kiosk;
    const Stage stage = kiosk->stage.now;
    const bool idle = !show.house.open && stage == Stage::sleep;
    std::string order = write_eye_order({to_string(stage), needs_of(*kiosk, here, page), idle});
    if (order == eye.ordered) continue;
    eye.link->send_text(order);
    eye.ordered = std::move(order);
  }
}

}  // namespace

void follow_kiosks(Show& show) {
  keep_kiosks(show);
  for (Kiosk& kiosk : show.kiosks) {
    const Stage before = kiosk.stage.now;
    step_kiosk(kiosk, read_pages(show, kiosk), show.eyes, kiosk_window(show, kiosk.settings.name),
               show.time);
    const Stage now = kiosk.stage.now;
    if (kiosk.changed)
      log::info("kiosk '{}': {} -> {}", kiosk.settings.name, to_string(before), to_string(now));
    if (kiosk.changed && now == Stage::farewell) see_off(show, kiosk);
    // Who comes back is not talked to as somebody who goes.
    const bool back = kiosk.changed && before == Stage::farewell && has_guest(now);
    if (back && her_kiosk(show) == &kiosk && show.teller.voice.story.empty())
      fall_silent(show, show.teller);
  }
  find_her_kiosk(show);
  for (Kiosk& kiosk : show.kiosks) {
    follow_gestures(show, kiosk);
    note_story(show, kiosk);
  }
  tell_pages(show);
  tell_eyes(show);
}

void note_touch(Visitor& visitor, const BrowserMessage& message) {
  if (!visitor.kiosk) return;
  if (const auto* said = std::get_if<KioskTouch>(&message)) {
    const bool touched = visitor.screen.touched || said->touched;
    visitor.screen = *said;
    visitor.screen.touched = touched;
  } else if (const auto* order = std::get_if<StorytellerOrder>(&message)) {
    visitor.screen.touched |= !order->story.empty() || !order->action.empty();
  } else if (std::holds_alternative<Tour>(message)) {
    visitor.screen.touched = true;
  }
}

Kiosk* her_kiosk(Show& show) {
  for (Kiosk& kiosk : show.kiosks)
    if (show.her_kiosk == kiosk.settings.name) return &kiosk;
  return nullptr;
}

}  // namespace wellspring::show
