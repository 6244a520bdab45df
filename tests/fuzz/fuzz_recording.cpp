// SPDX-License-Identifier: Apache-2.0
// Recordings of narrators: WAV, FLAC, OGG, MP3.
#include <cmath>

#include "avatar/speech/sound_file.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

void fuzz_recording(Bytes bytes) {
  const std::string file = write_file("fuzz.wav", bytes);
  load([&] {
    const Sound sound = load_sound(file);
    require(!sound.samples.empty() && sound.rate >= 4000 && sound.rate <= 192000,
            "a recording has samples and a rate");
    for (float sample : sound.samples) require(std::isfinite(sample), "samples are finite");
  });
}

}  // namespace wellspring::fuzz
