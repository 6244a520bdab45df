// SPDX-License-Identifier: Apache-2.0
// Files of the index of refraction of glass, gems and liquids.
#include <cmath>

#include "fuzz/fuzz.h"
#include "spectrum/read/dispersion_file.h"

namespace wellspring::fuzz {

void fuzz_dispersion(Bytes bytes) {
  using namespace spectrum;
  load([&] {
    const Dispersion glass = read_dispersion_text("a.yml", text_of(bytes));
    require(glass.low_nm < glass.high_nm || glass.formula == 0, "an index has a range");
    for (const double nm : {300.0, 486.0, 588.0, 656.0, 2000.0}) {
      const auto index = index_at(glass, nm);
      require(!index || (std::isfinite(*index) && *index > 0), "an index is a number above 0");
      const auto passed = transmittance_at(glass, nm, 0.01);
      require(!passed || (*passed >= 0 && *passed <= 1), "no more light passes than comes");
    }
  });
}

}  // namespace wellspring::fuzz
