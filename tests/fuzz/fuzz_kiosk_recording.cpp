// SPDX-License-Identifier: Apache-2.0
// Recorded observations.
#include "fuzz/fuzz.h"
#include "kiosk/process/recording.h"

namespace wellspring::fuzz {

void fuzz_kiosk_recording(Bytes bytes) {
  const std::string file = write_file("fuzz.jsonl", bytes);
  load([&] {
    Replay replay(file);
    std::string text;
    double time = -1e300;
    for (Observation seen; replay.next(seen, text); time = seen.time)
      require(seen.time >= time, "time does not run back");
  });
}

}  // namespace wellspring::fuzz
