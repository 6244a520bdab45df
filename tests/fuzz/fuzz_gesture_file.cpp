// SPDX-License-Identifier: Apache-2.0
// What a kiosk has learned of its gestures, and recordings to learn from.
#include "fuzz/fuzz.h"
#include "kiosk/gesture/gesture_file.h"

namespace wellspring::fuzz {

void fuzz_gesture_file(Bytes bytes) {
  const std::string file = write_file("fuzz.json", bytes);
  load([&] { load_recordings(folder().path.string()); });
  load([&] {
    const GestureModels models = load_gesture_models(file);
    HandPath path;
    for (int i = 0; i < 20; i++) path.places.push_back({0.05 * i, {0.04 * i, 0.02 * i * i}});
    recognise(models, path);
  });
}

}  // namespace wellspring::fuzz
