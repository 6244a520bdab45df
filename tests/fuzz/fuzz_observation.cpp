// SPDX-License-Identifier: Apache-2.0
// What kiosks send.
#include <cmath>

#include "fuzz/fuzz.h"
#include "wire/json.h"

namespace wellspring::fuzz {

void fuzz_observation(Bytes bytes) {
  const auto read = read_observation(text_of(bytes));
  if (std::holds_alternative<WireError>(read)) return;
  const Observation& observation = std::get<Observation>(read);
  require(std::isfinite(observation.time), "times are finite");
  require(std::holds_alternative<Observation>(read_observation(write_observation(observation))),
          "what was written can be read");
}

}  // namespace wellspring::fuzz
