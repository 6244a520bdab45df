// SPDX-License-Identifier: Apache-2.0
// Marks of a recording, corrected by hand.
#include "avatar/speech/speech_json.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

void fuzz_speech_marks(Bytes bytes) {
  load([&] { write_speech_json(load_speech_marks(text_of(bytes), "fuzz.json")); });
}

}  // namespace wellspring::fuzz
