// SPDX-License-Identifier: Apache-2.0
#include "scan/points.h"

namespace wellspring::scan {

void PointBlock::clear() {
  place.clear(), color.clear(), intensity.clear(), classification.clear();
  normal.clear(), time.clear(), station.clear();
}

}  // namespace wellspring::scan
