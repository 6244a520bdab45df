// SPDX-License-Identifier: Apache-2.0
// What the parts of wellspring_kiosk_measure share.
#pragma once
#include <string>

#include "kiosk/observe.h"
#include "tell.h"

namespace wellspring::test {

struct MeasureOptions {
  std::string weights, data;
  bool quick = false;
};

ObserverSettings settings_of(const MeasureOptions& options, const std::string& finder);

// Pictures of faces before the camera: prints that are moved by hand, that hang on the wall, and a
// book with nothing but printed eyes.
void measure_prints(const MeasureOptions& options);

}  // namespace wellspring::test
