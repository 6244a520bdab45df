// SPDX-License-Identifier: Apache-2.0
// What a server sends to a kiosk.
#include "fuzz/fuzz.h"
#include "wire/json.h"

namespace wellspring::fuzz {

void fuzz_eye_order(Bytes bytes) {
  const auto read = read_eye_order(text_of(bytes));
  if (std::holds_alternative<WireError>(read)) return;
  require(
      std::holds_alternative<EyeOrder>(read_eye_order(write_eye_order(std::get<EyeOrder>(read)))),
      "what was written can be read");
}

}  // namespace wellspring::fuzz
