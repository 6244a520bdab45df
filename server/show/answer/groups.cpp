// SPDX-License-Identifier: Apache-2.0
#include "show/answer/groups.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "show/answer/events.h"
#include "show/count/count.h"
#include "show/kiosk/kiosk.h"
#include "show/state/in_view.h"
#include "show/state/make_show.h"

namespace wellspring::show {

namespace {

constexpr float back_seconds = 0.6f;  // in which a view comes back, about
constexpr float farthest_up = 1.45f;  // radians
constexpr size_t code_letters = 6;

// Makes a code of letters and digits that are not taken for one another. Codes are short-lived, and
// tries are as many as a visitor may send messages.
std::string make_code() {
  static constexpr char letters[] = "ABCDEFGHJKLMNPQRSTUVWXYZ23456789";
  std::random_device random;
  std::uniform_int_distribution<size_t> any(0, sizeof(letters) - 2);
  std::string code;
  while (code.size() < code_letters) code += letters[any(random)];
  return code;
}

// As people type it.
std::string normalized(std::string code) {
  std::erase_if(code, [](char c) { return c == ' ' || c == '-'; });
  std::transform(code.begin(), code.end(), code.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
  return code;
}

const Visitor* find_leader(const ShowVisits& visits, const std::string& code) {
  for (const Visitor& visitor : visits.visitors)
    if (!code.empty() && visitor.group.leads == code && !visitor.left) return &visitor;
  return nullptr;
}

void tell(ShowVisits& visits, const std::string& code) {
  size_t followers = 0;
  for (const Visitor& visitor : visits.visitors) followers += visitor.group.follows == code;
  for (Visitor& visitor : visits.visitors) {
    const bool leads = visitor.group.leads == code;
    if (!leads && visitor.group.follows != code) continue;
    visitor.link->send_text(nlohmann::json{
        {"type", "group"},
        {"role", leads ? "leader" : "follower"},
        {"code", code},
        {"followers", followers},
        {"away",
         visitor.group.away}}.dump());
  }
}

void leave(ShowVisits& visits, Visitor& visitor) {
  VisitorGroup& group = visitor.group;
  if (group.leads.empty() && group.follows.empty()) return;
  const std::string code = group.leads.empty() ? group.follows : group.leads;
  group = {};
  visitor.link->send_text(R"({"type":"group","role":"none"})");
  if (find_leader(visits, code))
    tell(visits, code);  // else followers hear of it with the next tick
}

}  // namespace

std::optional<WireError> handle_group(ShowVisits& visits, Visitor& visitor,
                                      const GroupOrder& order) {
  VisitorGroup& group = visitor.group;
  switch (order.action) {
    case GroupAction::lead:
      if (!group.leads.empty()) break;
      leave(visits, visitor);
      do group.leads = make_code();
      while (find_leader(visits, group.leads) != &visitor);
      break;
    case GroupAction::follow: {
      const std::string code = normalized(order.code);
      const Visitor* leader = find_leader(visits, code);
      if (!leader || leader == &visitor)
        return WireError{"unknown_group", "nobody leads a group by the code '" + order.code + "'"};
      leave(visits, visitor);
      group.follows = code;
      stop_tour(visitor.place.tour, visitor.hearing.narration.voice);
      break;
    }
    case GroupAction::rejoin: group.away = false; break;
    case GroupAction::leave: leave(visits, visitor); return {};
  }
  const std::string& code = group.leads.empty() ? group.follows : group.leads;
  if (code.empty()) return WireError{"no_group", "you are in no group"};
  visitor.state_sent_at = -1e9;
  tell(visits, code);
  return {};
}

std::optional<WireError> check_not_following(const ShowVisits& visits, const Visitor& visitor) {
  if (!leader_of(visits, visitor)) return {};
  return WireError{"in_group", "you follow a group; leave it, or walk off, to decide for yourself"};
}

void go_away(Visitor& visitor) {
  VisitorGroup& group = visitor.group;
  if (group.follows.empty() || group.away) return;
  group.away = true;
  group.look = vec2(0);
  visitor.link->send_text(nlohmann::json{
      {"type", "group"},
      {"role", "follower"},
      {"code", group.follows},
      {"away", true}}.dump());
}

void follow_leader(ShowVisits& visits, double time, Visitor& visitor, float dt) {
  VisitorGroup& group = visitor.group;
  const bool comes_back = std::ranges::any_of(visits.kept, [&](const KeptVisit& kept) {
    return kept.visitor.front().group.leads == group.follows;
  });
  if (!group.follows.empty() && !find_leader(visits, group.follows) && !comes_back)
    return leave(visits, visitor);
  const Visitor* leader = leader_of(visits, visitor);
  if (!leader) return;  // the visitor follows nobody, or is away
  if (time - group.looked_at > look_round_seconds) group.look *= std::exp(-dt / back_seconds);
  VisitorPlace& place = visitor.place;
  const Viewpoint& ahead = leader->place.view;
  place.view = ahead;
  place.view.yaw = std::remainder(ahead.yaw + group.look.x, 2 * pi);
  place.view.pitch = std::clamp(ahead.pitch + group.look.y, -farthest_up, farthest_up);
  place.viewpoint = glm::length(group.look) < 0.01f ? leader->place.viewpoint : -1;
  place.velocity = vec3(0);
}

namespace {

constexpr float wall_distance = 0.2f;  // metres that an eye keeps from walls

bool stays(const ExhibitStage& stage, const ShowCast& cast, const Kiosk& kiosk,
           const VisitorPlace& place) {
  return place.viewpoint == kiosk_viewpoint(stage, cast, kiosk.settings.name) &&
         place.move == vec3(0) && place.velocity == vec3(0) &&
         place.tour.state == TourRide::State::none;
}

// So much of a step from there is free.
vec3 free_step(const World& world, vec3 from, vec3 step) {
  const float length = glm::length(step);
  if (!(length > 0)) return step;
  const Hit hit = world.intersect({from, 0, step / length, length + wall_distance});
  return hit.valid() ? step * (std::max(hit.t - wall_distance, 0.0f) / length) : step;
}

}  // namespace

int kiosk_viewpoint(const ExhibitStage& stage, const ShowCast& cast, const std::string& name) {
  const Exhibit& exhibit = stage.exhibit;
  const StorytellerPlace* teller = storyteller_of(stage, cast, cast.teller);
  for (const KioskSettings& kiosk : exhibit.kiosks) {
    if (kiosk.name != name) continue;
    if (const int own = find_viewpoint(exhibit, kiosk.viewpoint); own >= 0) return own;
    const int index = find_storyteller(exhibit, kiosk.teller);
    if (index >= 0) teller = &exhibit.storytellers[size_t(index)];
  }
  return teller ? teller->kiosk_viewpoint : exhibit.start;
}

View kiosk_window(const Show& show, const std::string& kiosk) {
  const Viewpoint& at =
      show.stage.exhibit.viewpoints[size_t(kiosk_viewpoint(show.stage, show.cast, kiosk))].view;
  int width = 1600, height = 900;
  if (const Kiosk* found = find_kiosk(show.kiosks, kiosk);
      found && found->settings.screen.known()) {
    const ScreenSize& screen = found->settings.screen;
    width = int(1000 * screen.width), height = int(1000 * screen.height);
  }
  return make_view(show.stage.exhibit.scene, at, width, height);
}

void look_through(const Show& show, Visitor& page, float dt) {
  const Kiosk* kiosk = kiosk_of(show, page);
  if (!kiosk || !kiosk->settings.screen.known()) return;
  const ScreenSize& screen = kiosk->settings.screen;
  std::vector<vec3> heads;
  if (stays(show.stage, show.cast, *kiosk, page.place) && !turns_pages(kiosk->showing)) {
    const View window = kiosk_window(show, kiosk->settings.name);
    for (const Guest& guest : kiosk->audience.guests) {
      const vec3 off = guest.head - window.position;
      heads.push_back({dot(off, window.right), dot(off, window.up),
                       rest_distance(screen, window) - dot(off, window.forward)});
    }
  }
  const View rest = rest_view(show.stage, page);
  WindowEye& eye = page.window;
  watch_heads(eye, heads, screen, rest, dt);
  const vec3 step = through_window(rest, screen, eye.aim).position - rest.position,
             free = free_step(*show.stage.world, rest.position, step);
  if (free != step) eye.aim *= glm::length(free) / glm::length(step);
  move_eye(eye, dt);
}

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
  change_storyteller(show.stage, show.cast, teller, storyteller_index);
  for (Visitor& visitor : show.visits.visitors) {
    if (!visitor.kiosk || !listens_to(show, visitor, teller)) continue;
    if (visitor.place.tour.state == TourRide::State::none)
      go_to_viewpoint(visitor.place, visitor.hearing.narration.voice, show.stage.exhibit,
                      kiosk_viewpoint(show.stage, show.cast, kiosk_name(show, visitor.name)));
  }
}

const Visitor* who_asked(const ShowCast& cast, const ShowVisits& visits) {
  for (const Visitor& visitor : visits.visitors)
    if (visitor.link->id == cast.teller.voice.asked_by) return &visitor;
  return nullptr;
}

// Visitors who share the storyteller from far away never take it from a person who stands before it
// and is being told a story.
bool belongs_to_a_kiosk(const ShowCast& cast, const ShowVisits& visits, const Visitor& other) {
  if (cast.teller.voice.story.empty() || other.kiosk) return false;
  const Visitor* asked = who_asked(cast, visits);
  return asked && asked->kiosk;
}

// Says why this visitor's order is refused; empty: it is not.
Refusal check_order(const Show& show, const Visitor& visitor, const StorytellerOrder& order) {
  if (show.cast.figures.empty())
    return WireError{"no_storyteller", "this exhibit has no storyteller"};
  if (show.stage.exhibit.shared_storyteller && belongs_to_a_kiosk(show.cast, show.visits, visitor))
    return WireError{"storyteller_busy", "somebody at the kiosk is being told a story"};
  if (!hears_storyteller(show, visitor))
    return WireError{"storyteller_busy", "the storyteller is with somebody at another kiosk"};
  if (!order.teller.empty() && find_storyteller(show.stage.exhibit, order.teller) < 0)
    return WireError{"unknown_storyteller", "there is no storyteller '" + order.teller + "'"};
  if (!order.story.empty() && !find_story(show.stage.exhibit, order.story))
    return WireError{"unknown_story", "there is no story '" + order.story + "'"};
  return {};
}

// Who orders something gets a storyteller of their own, who stands there as the house's did.
Teller& teller_for_orders(Show& show, Visitor& visitor) {
  if (visitor.kiosk || show.stage.exhibit.shared_storyteller) return show.cast.teller;
  if (!visitor.own_teller) {
    if (show.cast.teller.voice.started && listens_to(show, visitor, show.cast.teller))
      clear_subtitle(visitor);
    visitor.own_teller = std::make_unique<Teller>(show.cast.teller);
    visitor.own_teller->number = visitor.link->id;
    visitor.own_teller->voice = {};
    visitor.own_teller->sounding = {};
  }
  return *visitor.own_teller;
}

}  // namespace

std::optional<WireError> handle_storyteller(Show& show, Visitor& visitor,
                                            const StorytellerOrder& order) {
  if (Refusal wrong = check_not_following(show.visits, visitor)) return wrong;
  if (Refusal wrong = check_order(show, visitor, order)) return wrong;
  Teller& teller = teller_for_orders(show, visitor);
  Voice& voice = teller.voice;
  if (!order.teller.empty())
    call_storyteller(show, teller, size_t(find_storyteller(show.stage.exhibit, order.teller)));
  if (order.visible) teller.visible = *order.visible;
  if (order.humanlike) teller.humanlike = *order.humanlike;
  if (!order.story.empty()) {
    const StoryText& story = *find_story(show.stage.exhibit, order.story);
    if (story.storyteller_index >= 0)
      call_storyteller(show, teller, size_t(story.storyteller_index));
    tell(voice, story);
    pause_tour(visitor.place.tour, visitor.hearing.narration.voice);
    voice.asked_by = visitor.link->id;
    show.totals.stories++;
    count(show, "stories_begun", story.id);
  }
  const StoryText* telling = find_story(show.stage.exhibit, voice.story);
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
  if (Refusal wrong = check_not_following(show.visits, visitor)) return wrong;
  const bool speaks = !show.cast.figures.empty();
  if (speaks)
    if (Refusal wrong = check_order(show, visitor, {})) return wrong;
  const FoundAnswer found =
      find_answer(show.stage.questions, show.stage.exhibit, question.text, visitor.lang);
  const LocalScript said = words_for(show.stage.questions, found);
  visitor.link->send_text(reply_message(show.stage, visitor, question.text, found, said));
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
  for (Visitor& visitor : show.visits.visitors) {
    const Voice& own = visitor.hearing.narration.voice;
    const bool reads = listens_to(show, visitor, teller);
    if (shown && reads && (own.queue.empty() || own.paused)) clear_subtitle(visitor);
  }
}

void forget_absent_listeners(Show& show) {
  Teller& teller = show.cast.teller;
  if (teller.voice.queue.empty()) return;
  bool nobody = show.visits.visitors.empty();
  bool abandoned =
      teller.voice.paused && teller.voice.asked_by != 0 && !who_asked(show.cast, show.visits);
  if (!nobody && !abandoned) return;
  fall_silent(show, teller);
  teller.agent_sent_at = -1e9;
}

}  // namespace wellspring::show
