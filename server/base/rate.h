// SPDX-License-Identifier: Apache-2.0
// A bound on how much a peer may say: `rate` a second on average, in bursts of up to `burst`.
#pragma once
#include <algorithm>

namespace wellspring {

struct RateBound {
  double rate = 1, burst = 1;
  double spent = 0;      // of the burst
  double last_time = 0;  // seconds, any clock that does not run backwards

  // False when this is too much; it is then not counted.
  bool take(double amount, double now) {
    spent = std::max(0.0, spent - rate * std::max(0.0, now - last_time));
    last_time = now;
    if (spent + amount > burst) return false;
    spent += amount;
    return true;
  }
  // Of what was taken; a negative amount is taken besides, whatever there is.
  void give_back(double amount) { spent = std::max(0.0, spent - amount); }
  // Seconds after the last take() until one of `amount` is not too much.
  double wait_for(double amount) const { return std::max(0.0, (spent + amount - burst) / rate); }
};

}  // namespace wellspring
