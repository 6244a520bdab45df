// SPDX-License-Identifier: Apache-2.0
// Feeds messages of browsers. Accepted messages can be written, and are read back.
#include "fuzz/fuzz.h"
#include "wire/json.h"

namespace wellspring::fuzz {

void fuzz_browser_message(Bytes bytes) {
  const auto message = read_browser_message(text_of(bytes));
  if (const auto* error = std::get_if<WireError>(&message)) {
    require(!error->code.empty() && !error->message.empty(), "an error has code and message");
    write_error(*error);
    return;
  }
  const auto again = read_browser_message(write_message(std::get<BrowserMessage>(message)));
  require(std::holds_alternative<BrowserMessage>(again), "what was written can be read");
}

}  // namespace wellspring::fuzz
