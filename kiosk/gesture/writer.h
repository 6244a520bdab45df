// SPDX-License-Identifier: Apache-2.0
// People who make gestures, drawn by chance: a stand-in for recordings of visitors, and the set
// that the kiosk's own models are trained on. The same seed gives the same person and the same
// movement.
#pragma once
#include <string>
#include <vector>

#include "kiosk/gesture/strokes.h"

namespace wellspring::kiosk {

// Writers of the test set differ more from each other than those the models have seen, and no seed
// gives the same person in both.
enum class WriterGroup : uint8_t { training, held_out };

struct HandWriter {
  float rotation = 0, slant = 0;  // radians
  float aspect = 1;               // of widths
  float size = 0.7f;              // height of a digit, shoulder widths
  float pace = 1;                 // of all durations
  float overlap = 0.3f;           // share of a stroke during which the next one has begun
  float sigma = 0.3f;             // of strokes
  float looseness = 0.05f;        // how much two of the same gestures differ
  uint64_t habits = 0;            // seed of the own shape of each stroke
  HandCamera camera;
};
HandWriter make_writer(WriterGroup group, uint64_t seed);

// "0" to "9", "wave", "point", "swipe_left", "swipe_right", "swipe_up", "swipe_down".
const std::vector<std::string>& gesture_labels();

struct TrueGesture {
  std::string label;
  double begin = 0, end = 0;  // seconds
};
struct WrittenPath {
  HandPath path;
  std::vector<TrueGesture> gestures;
};

// The hand rises, makes the gestures with curved ways and sometimes short rests in between, and
// sinks.
WrittenPath write_gestures(const HandWriter& writer, const std::vector<std::string>& labels,
                           uint64_t seed);
// One gesture cut out of such a movement; pointing ends with the hand held still.
HandPath write_gesture(const HandWriter& writer, const std::string& label, uint64_t seed);
// Movement without any gesture: shifting hands, scratching the face, talking with the hands,
// reaching for something, going from place to place, raising and lowering them.
HandPath write_other(const HandWriter& writer, double seconds, uint64_t seed);

// `each` gestures of every label and 60 * `each` seconds of other movement from each of `writers`
// persons.
std::vector<HandPath> write_set(WriterGroup group, int writers, int each, uint64_t seed);

}  // namespace wellspring::kiosk
