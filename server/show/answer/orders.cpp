// SPDX-License-Identifier: Apache-2.0
#include "show/answer/orders.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include "show/answer/commands.h"
#include "show/answer/kiosks.h"
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
    {PlayOrder::type, 10, 10},       // what moves
    {GroupOrder::type, 2, 5},        // codes are not to be guessed
    {Ask::type, 2, 4},               // an answer is looked for and spoken
    {Settings::type, 5, 8},          // another size: nothing is known of it
};

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
bool overrule(const PlayOrder& newer, const PlayOrder& older) { return newer.name == older.name; }

// Others: the newest is all that matters, or each is carried out.
template <class Order>
bool overrule(const Order&, const Order&) {
  return std::is_same_v<Order, Hello> || std::is_same_v<Order, CameraTo> ||
         std::is_same_v<Order, ViewpointTo> || std::is_same_v<Order, GoTo> ||
         std::is_same_v<Order, Ask> || std::is_same_v<Order, HourOrder>;
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

bool is_due(const Show& show, VisitorOrders& orders, const BrowserMessage& order) {
  const OrderBound* bound = bound_of(order);
  if (!bound) return true;
  RateBound& spent = orders.spent[order.index()];
  spent.rate = bound->rate, spent.burst = bound->burst;
  return spent.take(1, show.time);
}

void refuse(Show& show, Visitor& visitor, const WireError& error) {
  show.totals.refused_messages++;
  visitor.link->send_text(write_error(error));
}

bool is_later(uint32_t seq, uint32_t than) { return int32_t(seq - than) > 0; }

void carry_out(Show& show, Visitor& visitor, const WaitingOrder& order) {
  const uint32_t seq = visitor.place.seq;
  const std::optional<WireError> error = handle(show, visitor, order.message);
  // Inputs that came after a late one have been carried out.
  if (order.late && is_later(seq, visitor.place.seq)) visitor.place.seq = seq;
  if (error) refuse(show, visitor, *error);
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
      refuse(show, visitor, *wrong);
  }
  for (WaitingOrder& order : std::exchange(orders.waiting, {})) {
    if (is_due(show, orders, order.message)) {
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

}  // namespace wellspring::show
