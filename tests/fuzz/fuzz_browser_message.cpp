// SPDX-License-Identifier: Apache-2.0
// What browsers send. What is accepted can be written, and is read back.
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
