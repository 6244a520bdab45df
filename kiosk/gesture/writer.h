// SPDX-License-Identifier: Apache-2.0
// Makes people who make gestures, by chance: they replace recordings of visitors, and the kiosk's
// own models are trained on them. The same seed gives the same person and the same movement.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/rng.h"
#include "kiosk/gesture/trajectory.h"

namespace wellspring::kiosk {

// Makes hand movements as people do: a sum of strokes that overlap in time, each along an arc with
// a lognormal speed (Plamondon 1995; the sigma-lognormal model of O'Reilly and Plamondon 2009).
// Overlap rounds corners and makes the hand slow where it turns. Units are those of trajectory.h.

struct Stroke {
  vec2 chord{0};       // way from its first to its last place
  float bend = 0;      // radians that the direction turns in between, clockwise on the screen
  double begin = 0;    // seconds
  double seconds = 0;  // for 99.7 % of its way
  float sigma = 0.3f;  // shape of the lognormal: how lopsided the speed is
};

// Returns where the strokes have taken a hand that started at 0.
vec2 eval_strokes(std::span<const Stroke> strokes, double time);

// Describes a camera that watches: frames a second, share of frames without a hand, noise of a
// place.
struct HandCamera {
  float rate = 20, lost = 0.02f;
  float noise = 0.008f;   // standard deviation of each place, shoulder widths
  float tremor = 0.006f;  // the same for a slow part that takes about a fifth of a second to change
};
std::vector<HandPlace> watch_strokes(std::span<const Stroke> strokes, vec2 start, double seconds,
                                     const HandCamera& camera, Rng& rng);

float normal(Rng& rng);                          // mean 0, standard deviation 1
float between(Rng& rng, float low, float high);  // uniform
vec2 turned(vec2 v, float angle);                // clockwise on the screen

// Writers of the test set differ more from each other than writers in training, and no seed gives
// the same person in both.
enum class WriterGroup : uint8_t { training, held_out };

struct HandWriter {
  float rotation = 0, slant = 0;  // radians
  float aspect = 1;               // factor of widths
  float size = 0.7f;              // height of a digit, shoulder widths
  float pace = 1;                 // factor of all durations
  float overlap = 0.3f;           // share of a stroke during which the next one has begun
  float sigma = 0.3f;             // Stroke::sigma
  float looseness = 0.05f;        // difference between two of the same gestures
  uint64_t habits = 0;            // seed for each stroke's own shape
  HandCamera camera;
};
HandWriter make_writer(WriterGroup group, uint64_t seed);

// Returns "0" to "9", "wave", "point", "swipe_left", "swipe_right", "swipe_up", "swipe_down".
const std::vector<std::string>& gesture_labels();

struct TrueGesture {
  std::string label;
  double begin = 0, end = 0;  // seconds
};
struct WrittenPath {
  HandPath path;
  std::vector<TrueGesture> gestures;
};

// Lets the hand rise, make the gestures with curved ways and sometimes short rests in between, and
// sink.
WrittenPath write_gestures(const HandWriter& writer, const std::vector<std::string>& labels,
                           uint64_t seed);
// Cuts one gesture out of such a movement; pointing ends with the hand held still.
HandPath write_gesture(const HandWriter& writer, const std::string& label, uint64_t seed);
// Makes movement without any gesture: shifting hands, scratching the face, talking with the hands,
// reaching for something, going from place to place, raising and lowering them.
HandPath write_other(const HandWriter& writer, double seconds, uint64_t seed);

// Makes `each` gestures of every label and 60 * `each` seconds of other movement from each of
// `writers` persons.
std::vector<HandPath> write_set(WriterGroup group, int writers, int each, uint64_t seed);

}  // namespace wellspring::kiosk
