// SPDX-License-Identifier: Apache-2.0
// What browsers order, read and carried out once a tick. What one visitor may make others wait for
// is bounded here and by what is drawn at once (show/draw/decide.h):
//
// - of the orders of one kind that are not carried out yet, the newest wins: an older one is left
//   out, or what the newer one says anew of it. Two lamps are two kinds, and so are two animations;
// - of each kind so many a second are carried out; further ones wait, and the newest of them is
//   carried out when it is due. So the last order always wins.
//
// Orders keep their order as far as they are carried out in one tick. Inputs are all carried out as
// they come: their turns add up.
#pragma once
#include <cstddef>
#include <span>

#include "show/state/show.h"

namespace wellspring::show {

// How many orders of a kind are carried out: a second, and at once after a pause.
struct OrderBound {
  const char* type;  // of the message
  double rate, burst;
};
// Kinds that are not listed cost no more than reading them.
std::span<const OrderBound> order_bounds();

// More that wait are forgotten, the oldest first.
inline constexpr size_t most_waiting_orders = 32;

// Carries out what is due of what the visitor has ordered; what is wrong is answered.
void follow_orders(Show& show, Visitor& visitor);

}  // namespace wellspring::show
