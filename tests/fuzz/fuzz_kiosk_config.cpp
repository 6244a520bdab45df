// SPDX-License-Identifier: Apache-2.0
// A kiosk's configuration, and addresses of servers.
#include "fuzz/fuzz.h"
#include "kiosk/config.h"
#include "kiosk/process/link.h"

namespace wellspring::fuzz {

void fuzz_kiosk_config(Bytes bytes) {
  parse_address(text_of(bytes));
  const std::string file = write_file("fuzz.json", bytes);
  load([&] {
    KioskConfig config;
    load_config(file, config);
  });
}

}  // namespace wellspring::fuzz
