// SPDX-License-Identifier: Apache-2.0
// What a picture's time is spent on, decided by what was measured. Path `cache`: nearly all goes to
// samples, a little to looks at edges (cache/looks.h). Path `primary`: every pixel is looked at, where
// that leaves enough for light: a quick machine, a small picture, few visitors.
#pragma once
#include <cstddef>

namespace wellspring {

struct DisplayCosts {
  double samples_per_second = 0, looks_per_second = 0;  // all cores
};

struct DisplayPlan {
  bool primary = false;
  int samples = 0, looks = 0;
};

// `seconds`: what there is for both. `primary`: the path of the picture before, which is kept until
// the other is clearly better, so that paths do not alternate.
DisplayPlan plan_display(double seconds, size_t pixels, const DisplayCosts& costs, bool primary);

}  // namespace wellspring
