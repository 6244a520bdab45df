// SPDX-License-Identifier: Apache-2.0
// What the house says on all screens.
#pragma once
#include <cstdint>

#include "show/exhibit/exhibit.h"

namespace wellspring::show {

struct Announcement {
  uint32_t id = 0;     // grows with each
  LocalText text;      // empty: the last is taken back
  double seconds = 0;  // that it stays
  bool urgent = false;
};

}  // namespace wellspring::show
