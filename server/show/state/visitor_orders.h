// SPDX-License-Identifier: Apache-2.0
// What a visitor has ordered and what is not carried out yet (show/answer/orders.h).
#pragma once
#include <array>
#include <variant>
#include <vector>

#include "base/rate.h"
#include "wire/messages.h"

namespace wellspring::show {

struct WaitingOrder {
  BrowserMessage message;
  bool late = false;  // since an earlier tick
};

struct VisitorOrders {
  std::vector<WaitingOrder> waiting;                                 // oldest first
  std::array<RateBound, std::variant_size_v<BrowserMessage>> spent;  // of each kind
};

}  // namespace wellspring::show
