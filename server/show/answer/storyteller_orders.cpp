// SPDX-License-Identifier: Apache-2.0
#include "show/answer/storyteller_orders.h"

#include <algorithm>

#include "show/answer/events.h"
#include "show/answer/groups.h"
#include "show/answer/kiosk_window.h"
#include "show/count/count.h"
#include "show/state/make_show.h"

namespace wellspring::show {

namespace {

using Refusal = std::optional<WireError>;

const StoryText* find_story(const Exhibit& exhibit, const std::string& id) {
  for (const StoryText& story : exhibit.stories)
    if (story.id == id) return &story;
  return nullptr;
}

// Kiosks stand before whoever is there.
void call_storyteller(Show& show, Teller& teller, size_t storyteller_index) {
  if (storyteller_index == teller.index) return;
  fall_silent(show, teller);
  change_storyteller(show, teller, storyteller_index);
  for (Visitor& visitor : show.visitors) {
    if (!visitor.kiosk || !listens_to(show, visitor, teller)) continue;
    if (visitor.place.tour.state == TourRide::State::none)
      go_to_viewpoint(visitor.place, visitor.hearing.narration.voice, show.exhibit,
                      kiosk_viewpoint(show, kiosk_name(show, visitor.name)));
  }
}

const Visitor* who_asked(const Show& show) {
  for (const Visitor& visitor : show.visitors)
    if (visitor.link->id == show.teller.voice.asked_by) return &visitor;
  return nullptr;
}

// Where visitors share the storyteller, nobody far away takes it from a person who stands before it
// and is being told a story.
bool belongs_to_a_kiosk(const Show& show, const Visitor& other) {
  if (show.teller.voice.story.empty() || other.kiosk) return false;
  const Visitor* asked = who_asked(show);
  return asked && asked->kiosk;
}

// What is wrong with this visitor's order; empty: nothing.
Refusal check_order(const Show& show, const Visitor& visitor, const StorytellerOrder& order) {
  if (show.figures.empty()) return WireError{"no_storyteller", "this exhibit has no storyteller"};
  if (show.exhibit.shared_storyteller && belongs_to_a_kiosk(show, visitor))
    return WireError{"storyteller_busy", "somebody at the kiosk is being told a story"};
  if (!hears_storyteller(show, visitor))
    return WireError{"storyteller_busy", "the storyteller is with somebody at another kiosk"};
  if (!order.teller.empty() && find_storyteller(show.exhibit, order.teller) < 0)
    return WireError{"unknown_storyteller", "there is no storyteller '" + order.teller + "'"};
  if (!order.story.empty() && !find_story(show.exhibit, order.story))
    return WireError{"unknown_story", "there is no story '" + order.story + "'"};
  return {};
}

// Who orders something gets a storyteller of their own, who stands there as the house's did.
Teller& teller_for_orders(Show& show, Visitor& visitor) {
  if (visitor.kiosk || show.exhibit.shared_storyteller) return show.teller;
  if (!visitor.own_teller) {
    if (show.teller.voice.started && listens_to(show, visitor, show.teller))
      clear_subtitle(visitor);
    visitor.own_teller = std::make_unique<Teller>(show.teller);
    visitor.own_teller->number = visitor.link->id;
    visitor.own_teller->voice = {};
    visitor.own_teller->sounding = {};
  }
  return *visitor.own_teller;
}

}  // namespace

std::optional<WireError> handle_storyteller(Show& show, Visitor& visitor,
                                            const StorytellerOrder& order) {
  if (Refusal wrong = check_not_following(show, visitor)) return wrong;
  if (Refusal wrong = check_order(show, visitor, order)) return wrong;
  Teller& teller = teller_for_orders(show, visitor);
  Voice& voice = teller.voice;
  if (!order.teller.empty())
    call_storyteller(show, teller, size_t(find_storyteller(show.exhibit, order.teller)));
  if (order.visible) teller.visible = *order.visible;
  if (order.humanlike) teller.humanlike = *order.humanlike;
  if (!order.story.empty()) {
    const StoryText& story = *find_story(show.exhibit, order.story);
    if (story.storyteller_index >= 0)
      call_storyteller(show, teller, size_t(story.storyteller_index));
    tell(voice, story);
    pause_tour(visitor.place.tour, visitor.hearing.narration.voice);
    voice.asked_by = visitor.link->id;
    show.totals.stories++;
    count(show, "stories_begun", story.id);
  }
  const StoryText* telling = find_story(show.exhibit, voice.story);
  uint64_t asked_by = voice.asked_by;
  if (order.action == "pause") pause_voice(voice);
  else if (order.action == "play") resume_voice(voice);
  else if (order.action == "stop") fall_silent(show, teller);
  else if (order.action == "restart" && telling) tell(voice, *telling);
  else if (order.action == "skip" && telling) tell(voice, *telling, voice.sentence + 1);
  if (!voice.queue.empty()) voice.asked_by = asked_by;
  teller.agent_sent_at = -1e9;  // all who share her hear of the change with the next tick
  return {};
}

std::optional<WireError> ask(Show& show, Visitor& visitor, const Ask& question) {
  if (Refusal wrong = check_not_following(show, visitor)) return wrong;
  const bool speaks = !show.figures.empty();
  if (speaks)
    if (Refusal wrong = check_order(show, visitor, {})) return wrong;
  const FoundAnswer found = find_answer(show.questions, show.exhibit, question.text, visitor.lang);
  const LocalScript said = words_for(show.questions, found);
  visitor.link->send_text(reply_message(show, visitor, question.text, found, said));
  if (!speaks) return {};
  Teller& teller = teller_for_orders(show, visitor);
  fall_silent(show, teller);
  pause_tour(visitor.place.tour, visitor.hearing.narration.voice);
  say_all(teller.voice, said);
  teller.voice.asked_by = visitor.link->id;
  teller.agent_sent_at = -1e9;
  return {};
}

void clear_subtitle(Visitor& visitor) {
  visitor.link->send_text(subtitle_message("", visitor.lang, "", 0));
}

void fall_silent(Show& show, Teller& teller) {
  bool shown = teller.voice.started;
  hush(teller.voice);
  for (Visitor& visitor : show.visitors) {
    const Voice& own = visitor.hearing.narration.voice;
    const bool reads = listens_to(show, visitor, teller);
    if (shown && reads && (own.queue.empty() || own.paused)) clear_subtitle(visitor);
  }
}

void forget_absent_listeners(Show& show) {
  Teller& teller = show.teller;
  if (teller.voice.queue.empty()) return;
  bool nobody = show.visitors.empty();
  bool abandoned = teller.voice.paused && teller.voice.asked_by != 0 && !who_asked(show);
  if (!nobody && !abandoned) return;
  fall_silent(show, teller);
  teller.agent_sent_at = -1e9;
}

}  // namespace wellspring::show
