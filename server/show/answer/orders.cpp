// SPDX-License-Identifier: Apache-2.0
#include "show/answer/orders.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/log.h"
#include "show/answer/cameras.h"
#include "show/answer/commands.h"
#include "show/answer/events.h"
#include "show/answer/groups.h"
#include "show/answer/holding.h"
#include "show/state/visitor_world.h"
#include "wire/json.h"

namespace wellspring::show {

namespace {

constexpr OrderBound bounds[] = {
    {Hello::type, 1, 4},             // the whole exhibit is described in answer
    {ViewpointTo::type, 10, 10},     // a place that nothing is known of
    {GoTo::type, 5, 5},              // a way is looked for
    {Tour::type, 5, 5},              // a way, and words
    {StorytellerOrder::type, 5, 8},  // another figure, and words that are spoken for them
    {LampOrder::type, 10, 10},       // other light
    {HourOrder::type, 10, 10},       // other light
    {PieceOrder::type, 20, 20},      // another picture
    {LensOrder::type, 60, 60},       // another glass
    {MeasureOrder::type, 10, 10},    // rays
    {PlayOrder::type, 10, 10},       // moves things
    {GroupOrder::type, 2, 5},        // codes are not to be guessed
    {Ask::type, 2, 4},               // an answer is looked for and spoken
    {Settings::type, 5, 8},          // another size: nothing is known of it
};

constexpr double within_reach = 2.5;  // metres at which a swipe turns a volume
constexpr float swiped_turn = 30;     // degrees

// ---- overrule(newer, older): takes from the older order what the newer one says anew. True:
// nothing is left of it.

template <class Value>
void take_back(const std::optional<Value>& newer, std::optional<Value>& older) {
  if (newer) older.reset();
}

bool overrule(const Settings& newer, Settings& older) {
  take_back(newer.fps, older.fps);
  take_back(newer.attention, older.attention);
  take_back(newer.sound, older.sound);
  take_back(newer.comfort, older.comfort);
  take_back(newer.quality, older.quality);
  take_back(newer.max_quality, older.max_quality);
  take_back(newer.width, older.width);
  take_back(newer.height, older.height);
  if (!newer.lang.empty()) older.lang.clear();
  if (!newer.display.empty()) older.display.clear();
  return older == Settings{};
}

// Another storyteller says nothing yet, and another story begins by itself.
bool overrule(const StorytellerOrder& newer, StorytellerOrder& older) {
  take_back(newer.visible, older.visible);
  take_back(newer.humanlike, older.humanlike);
  if (!newer.teller.empty()) older.teller.clear();
  if (!newer.teller.empty() || !newer.story.empty()) older.story.clear(), older.action.clear();
  if (!newer.action.empty()) older.action.clear();
  return older == StorytellerOrder{};
}

bool overrule(const Tour& newer, const Tour& older) {
  const bool begins = newer.action == TourAction::play && !newer.name.empty();
  return begins || newer.action == TourAction::stop || newer.action == older.action;
}

bool overrule(const GroupOrder& newer, const GroupOrder& older) {
  return newer.action != GroupAction::rejoin || older.action == GroupAction::rejoin;
}

bool overrule(const LampOrder& newer, const LampOrder& older) { return newer.name == older.name; }
bool overrule(const PieceOrder& newer, const PieceOrder& older) { return newer.name == older.name; }
bool overrule(const PlayOrder& newer, const PlayOrder& older) { return newer.name == older.name; }

// Others: the newest is all that matters, or each is carried out.
template <class Order>
bool overrule(const Order&, const Order&) {
  return std::is_same_v<Order, Hello> || std::is_same_v<Order, CameraTo> ||
         std::is_same_v<Order, ViewpointTo> || std::is_same_v<Order, GoTo> ||
         std::is_same_v<Order, Ask> || std::is_same_v<Order, HourOrder> ||
         std::is_same_v<Order, LensOrder>;
}

// How many were left out for it.
size_t put(BrowserMessage newer, std::vector<WaitingOrder>& waiting) {
  const size_t left_out = std::erase_if(waiting, [&](WaitingOrder& older) {
    if (newer.index() != older.message.index()) return false;
    return std::visit(
        [&](const auto& order) {
          return overrule(order, std::get<std::decay_t<decltype(order)>>(older.message));
        },
        newer);
  });
  waiting.push_back({std::move(newer)});
  return left_out;
}

const OrderBound* bound_of(const BrowserMessage& order) {
  const char* type = std::visit([](const auto& one) { return one.type; }, order);
  auto found = std::ranges::find_if(
      order_bounds(), [&](const OrderBound& bound) { return std::strcmp(bound.type, type) == 0; });
  return found == order_bounds().end() ? nullptr : &*found;
}

bool is_due(double time, VisitorOrders& orders, const BrowserMessage& order) {
  const OrderBound* bound = bound_of(order);
  if (!bound) return true;
  RateBound& spent = orders.spent[order.index()];
  spent.rate = bound->rate, spent.burst = bound->burst;
  return spent.take(1, time);
}

void refuse(ShowTotals& totals, Visitor& visitor, const WireError& error) {
  totals.refused_messages++;
  visitor.link->send_text(write_error(error));
}

bool is_later(uint32_t seq, uint32_t than) { return int32_t(seq - than) > 0; }

void carry_out(Show& show, Visitor& visitor, const WaitingOrder& order) {
  const uint32_t seq = visitor.place.seq;
  const std::optional<WireError> error = handle(show, visitor, order.message);
  // Inputs that came after a late one have been carried out.
  if (order.late && is_later(seq, visitor.place.seq)) visitor.place.seq = seq;
  if (error) refuse(show.totals, visitor, *error);
  else note_touch(visitor, order.message);
}

}  // namespace

std::span<const OrderBound> order_bounds() { return bounds; }

void follow_orders(Show& show, Visitor& visitor) {
  if (visitor.left) return;  // its picture may be drawn yet, and what it says counts no more
  VisitorOrders& orders = visitor.orders;
  for (Heard& heard : visitor.link->take_heard()) {
    show.totals.messages++;
    if (auto* message = std::get_if<BrowserMessage>(&heard.said))
      show.totals.orders_left_out += put(std::move(*message), orders.waiting);
    else if (const WireError* wrong = std::get_if<WireError>(&heard.said))
      refuse(show.totals, visitor, *wrong);
  }
  for (WaitingOrder& order : std::exchange(orders.waiting, {})) {
    if (is_due(show.time, orders, order.message)) {
      carry_out(show, visitor, order);
    } else {
      order.late = true;
      orders.waiting.push_back(std::move(order));
    }
  }
  if (orders.waiting.size() <= most_waiting_orders) return;
  const size_t most = orders.waiting.size() - most_waiting_orders;
  show.totals.orders_left_out += most;
  orders.waiting.erase(orders.waiting.begin(), orders.waiting.begin() + long(most));
}

namespace {

bool is_page_of(const Show& show, const Visitor& visitor, const Kiosk& kiosk) {
  return visitor.welcomed && kiosk_of(show, visitor) == &kiosk;
}

// Those that are named or connected, no others.
void keep_kiosks(Show& show) {
  std::vector<std::string> names;
  for (Eye& eye : show.kiosks.eyes) {
    eye.kiosk = kiosk_name(show, eye.seen.kiosk);
    if (!is_lost(eye)) names.push_back(eye.kiosk);
  }
  for (const Visitor& visitor : show.visits.visitors)
    if (visitor.welcomed && visitor.kiosk) names.push_back(kiosk_name(show, visitor.name));
  std::vector<KioskSettings> wanted = show.stage.exhibit.kiosks;
  for (const std::string& name : names) {
    auto is_it = [&](const KioskSettings& one) { return one.name == name; };
    if (std::any_of(wanted.begin(), wanted.end(), is_it)) continue;
    wanted.emplace_back().name = name;
  }
  std::erase_if(show.kiosks.all, [&](const Kiosk& kiosk) {
    return std::none_of(wanted.begin(), wanted.end(),
                        [&](const KioskSettings& one) { return one.name == kiosk.settings.name; });
  });
  for (const KioskSettings& one : wanted)
    if (!find_kiosk(show.kiosks, one.name)) show.kiosks.all.emplace_back().settings = one;
}

// Whether the storyteller tells something that this page asked for.
bool is_told(const ShowCast& cast, const Visitor& page) {
  return cast.teller.voice.asked_by == page.link->id && !cast.teller.voice.queue.empty();
}

KioskInput read_pages(Show& show, const Kiosk& kiosk) {
  KioskInput input;
  input.closed = !show.house.state.open;
  for (Visitor& page : show.visits.visitors) {
    if (!is_page_of(show, page, kiosk)) continue;
    const bool told = is_told(show.cast, page);
    const TourRide::State tour = page.place.tour.state;
    input.touched |= std::exchange(page.screen.touched, false);
    input.showing = std::max(input.showing, page.screen.showing);
    input.busy |= page.screen.showing != Showing::well || told || tour != TourRide::State::none;
    input.playing |= page.screen.playing || (told && !show.cast.teller.voice.paused) ||
                     tour == TourRide::State::playing;
  }
  return input;
}

// Nobody is told a story who has left; lamps and hour are the house's, the screen is a window
// again.
void see_off(Show& show, const Kiosk& kiosk) {
  for (Visitor& page : show.visits.visitors) {
    if (!is_page_of(show, page, kiosk)) continue;
    page.lamps.own.clear();
    page.lamps.wish.clear();
    page.lamps.hour.reset();
    page.pieces.wish.clear();
    page.lens = {};
    if (is_told(show.cast, page)) fall_silent(show, show.cast.teller);
    if (page.place.tour.state != TourRide::State::none)
      handle(show, page, Tour{TourAction::stop, ""});
    go_to_viewpoint(page.place, page.hearing.narration.voice, show.stage.exhibit,
                    kiosk_viewpoint(show.stage, show.cast, kiosk.settings.name));
  }
}

void note_story(Show& show, Kiosk& kiosk) {
  const std::string& story = show.cast.teller.voice.story;
  std::vector<std::string>& heard = kiosk.visit.heard;
  if (story.empty() || !is_visit(kiosk.stage.now)) return;
  if (std::find(heard.begin(), heard.end(), story) != heard.end()) return;
  for (const Visitor& page : show.visits.visitors)
    if (is_page_of(show, page, kiosk) && is_told(show.cast, page)) return heard.push_back(story);
}

// A kiosk's own storyteller comes there with its guest.
void call_teller(Show& show, const Kiosk& kiosk) {
  if (kiosk.settings.teller.empty()) return;
  StorytellerOrder order;
  order.teller = kiosk.settings.teller;
  for (Visitor& page : show.visits.visitors)
    if (is_page_of(show, page, kiosk)) {
      handle(show, page, order);
      return;
    }
}

void find_her_kiosk(Show& show) {
  if (!storyteller_of(show.stage, show.cast, show.cast.teller)) return;
  const Kiosk* with = her_kiosk(show.kiosks);
  if (with && is_visit(with->stage.now)) return;
  show.kiosks.her_kiosk.reset();
  const Kiosk* first = nullptr;
  for (const Kiosk& kiosk : show.kiosks.all)
    if (has_guest(kiosk.stage.now) && (!first || kiosk.visit.began < first->visit.began))
      first = &kiosk;
  if (!first) return;
  show.kiosks.her_kiosk = first->settings.name;
  show.kiosks.her_visits++;
  call_teller(show, *first);
}

void tell_pages(Show& show) {
  std::string all = kiosk_message(show.kiosks);
  const bool news = all != show.kiosks.message;
  if (news) show.kiosks.message = std::move(all);
  for (Visitor& visitor : show.visits.visitors)
    if (news && visitor.welcomed && !visitor.kiosk) visitor.link->send_text(show.kiosks.message);
  for (Kiosk& kiosk : show.kiosks.all) {
    std::string message = kiosk_message(show, kiosk);
    if (message == kiosk.message) continue;
    kiosk.message = std::move(message);
    for (Visitor& visitor : show.visits.visitors)
      if (is_page_of(show, visitor, kiosk)) visitor.link->send_text(kiosk.message);
  }
}

void tell_eyes(Show& show) {
  for (Eye& eye : show.kiosks.eyes) {
    const Kiosk* kiosk = eye.observations > 0 ? find_kiosk(show.kiosks, eye.kiosk) : nullptr;
    if (!kiosk || is_lost(eye)) continue;
    const bool page = std::any_of(show.visits.visitors.begin(), show.visits.visitors.end(),
                                  [&](auto& visitor) { return is_page_of(show, visitor, *kiosk); });
    const bool here = show.kiosks.her_kiosk == eye.kiosk;
    const Stage stage = kiosk->stage.now;
    const bool idle = !show.house.state.open && stage == Stage::sleep;
    std::string order = write_eye_order({to_string(stage), needs_of(*kiosk, here, page), idle});
    if (order == eye.ordered) continue;
    eye.link->send_text(order);
    eye.ordered = std::move(order);
  }
}

}  // namespace

void follow_kiosks(Show& show) {
  keep_kiosks(show);
  for (Kiosk& kiosk : show.kiosks.all) {
    const Stage before = kiosk.stage.now;
    step_kiosk(kiosk, read_pages(show, kiosk), show.kiosks.eyes,
               kiosk_window(show, kiosk.settings.name), show.time);
    const Stage now = kiosk.stage.now;
    if (kiosk.changed)
      log::info("kiosk '{}': {} -> {}", kiosk.settings.name, to_string(before), to_string(now));
    if (kiosk.changed && now == Stage::farewell) see_off(show, kiosk);
    // Who comes back is not talked to as somebody who goes.
    const bool back = kiosk.changed && before == Stage::farewell && has_guest(now);
    if (back && her_kiosk(show.kiosks) == &kiosk && show.cast.teller.voice.story.empty())
      fall_silent(show, show.cast.teller);
  }
  find_her_kiosk(show);
  for (Kiosk& kiosk : show.kiosks.all) {
    follow_gestures(show, kiosk);
    follow_holding(show, kiosk, her_kiosk(show.kiosks) == &kiosk);
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

Kiosk* her_kiosk(ShowKiosks& kiosks) {
  for (Kiosk& kiosk : kiosks.all)
    if (kiosks.her_kiosk == kiosk.settings.name) return &kiosk;
  return nullptr;
}

namespace {

// The page that its guests stand before.
Visitor* find_page(Show& show, const Kiosk& kiosk) {
  for (Visitor& visitor : show.visits.visitors)
    if (visitor.welcomed && kiosk_of(show, visitor) == &kiosk) return &visitor;
  return nullptr;
}

// A story's number after that of the one told last, or that one again.
size_t next_story(const ExhibitStage& stage, const KioskVisit& visit, bool again) {
  const std::vector<StoryText>& stories = stage.exhibit.stories;
  auto told = std::find_if(stories.begin(), stories.end(), [&](const StoryText& story) {
    return story.id == visit.gestured_story;
  });
  const size_t index = told == stories.end() ? stories.size() - 1 : size_t(told - stories.begin());
  if (again) return told == stories.end() ? 0 : index;
  for (size_t i = 1; i <= stories.size(); i++) {
    const size_t next = (index + i) % stories.size();
    if (std::find(visit.heard.begin(), visit.heard.end(), stories[next].id) == visit.heard.end())
      return next;
  }
  return (index + 1) % stories.size();
}

// Whether there is something that an open palm could stop.
bool speaks(const ShowCast& cast) {
  return !cast.teller.voice.story.empty() || !cast.teller.voice.queue.empty();
}

StorytellerOrder order_of(const ExhibitStage& stage, const ShowCast& cast, const KioskVisit& visit,
                          const std::string& gesture) {
  StorytellerOrder order;
  const std::vector<StoryText>& stories = stage.exhibit.stories;
  const bool telling = !cast.teller.voice.story.empty();
  if (gesture.size() == 1 && gesture[0] >= '1' && gesture[0] <= '9') {
    const size_t number = size_t(gesture[0] - '1');
    if (number < stories.size()) order.story = stories[number].id;
  } else if (gesture == "swipe_left" || gesture == "swipe_right") {
    const bool back = gesture == "swipe_right";
    if (telling) order.action = back ? "restart" : "skip";
    else if (!stories.empty()) order.story = stories[next_story(stage, visit, back)].id;
  } else if ((gesture == "swipe_down" && telling) || (gesture == "stop" && speaks(cast))) {
    order.action = "stop";
  }
  return order;
}

// Returns the volume that is nearest before the visitor's eyes, within reach; -1: none is.
int volume_before(const Exhibit& exhibit, const Viewpoint& eye) {
  int nearest = -1;
  double least = within_reach;
  for (size_t i = 0; i < exhibit.pieces.size(); i++) {
    dvec3 way = exhibit.pieces[i].position - eye.position;
    way.y = 0;
    const dvec3 ahead(-std::sin(eye.yaw), 0, -std::cos(eye.yaw));
    if (!exhibit.pieces[i].volume || glm::length(way) >= least || dot(way, ahead) <= 0) continue;
    nearest = int(i), least = glm::length(way);
  }
  return nearest;
}

// Turns the volume that a guest who walks stands before. Returns false: there is none.
bool turn_volume(const Show& show, const Kiosk& kiosk, const std::string& gesture, Visitor& page) {
  const bool left = gesture == "swipe_left" || gesture == "turn_left";
  const bool right = gesture == "swipe_right" || gesture == "turn_right";
  if (kiosk.showing != Showing::walk || !(left || right)) return false;
  const Exhibit& exhibit = show.stage.exhibit;
  const int piece = volume_before(exhibit, page.place.view);
  if (piece < 0) return false;
  PieceMark mark;
  const float turn = glm::degrees(choice_of(page.pieces.wish, size_t(piece)).turn);
  mark.turn = std::remainder(turn + (left ? -swiped_turn : swiped_turn), 360.0f);
  see_told(exhibit, show.time, exhibit.pieces[size_t(piece)].id, mark, page);
  return true;
}

}  // namespace

void follow_gestures(Show& show, Kiosk& kiosk) {
  std::vector<std::pair<uint64_t, std::string>> now;
  for (const Guest& guest : kiosk.audience.guests)
    if (!guest.gesture.empty()) now.emplace_back(guest.id, guest.gesture);
  const auto before = std::exchange(kiosk.gestures, std::move(now));
  Visitor* page = find_page(show, kiosk);
  if (!page) return;
  for (const auto& one : kiosk.gestures) {
    if (std::find(before.begin(), before.end(), one) != before.end()) continue;  // still told
    const bool stops = one.second == "stop" && speaks(show.cast);
    if (turns_pages(kiosk.showing) && !stops) {
      kiosk.gesture = one.second;
      kiosk.gesture_number++;
      show.totals.gestures++;
      continue;
    }
    if (turn_volume(show, kiosk, one.second, *page)) {
      show.totals.gestures++;
      continue;
    }
    const StorytellerOrder order = order_of(show.stage, show.cast, kiosk.visit, one.second);
    if (order == StorytellerOrder{}) continue;
    if (handle(show, *page, order)) continue;
    if (!order.story.empty()) kiosk.visit.gestured_story = order.story;
    show.totals.gestures++;
  }
}

}  // namespace wellspring::show
