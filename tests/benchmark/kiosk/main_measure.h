// SPDX-License-Identifier: Apache-2.0
// What the parts of wellspring_kiosk_measure share.
#pragma once
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "kiosk/observe.h"

namespace wellspring::test {

struct MeasureOptions {
  std::string weights, data;
  bool quick = false;
};

struct Mean {
  double sum = 0;
  int count = 0;
  void add(double value) { sum += value, count++; }
  double value() const { return count ? sum / count : NAN; }
};

// Prints a result; nothing for a value that is no number.
void tell(const std::string& name, double value, const std::string& unit,
          nlohmann::json fields = {});
ObserverSettings settings_of(const MeasureOptions& options, const std::string& finder);

// Pictures of faces before the camera: prints that are moved by hand, that hang on the wall, and a
// book with nothing but printed eyes.
void measure_prints(const MeasureOptions& options);

}  // namespace wellspring::test
