// SPDX-License-Identifier: Apache-2.0
// Something was written to a peer and has arrived there: the answer to a ping behind it came.
#pragma once
#include <cstddef>

namespace wellspring::wire {

struct Delivery {
  size_t bytes = 0;
  double began = 0, ended = 0;  // writing it, and the answer; seconds of one clock
  bool alone = false;           // nothing was under way when writing it began
  bool picture = false;
};

}  // namespace wellspring::wire
