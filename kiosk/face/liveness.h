// SPDX-License-Identifier: Apache-2.0
// Tells faces from pictures of faces by how their points move from one frame to another. Points of
// a print, a poster or a screen keep the homography of a plane; those of a head do not, as a nose
// is nearer than cheeks, and lips and lids move (after Bao, Li, Li, Jiang, "A liveness detection
// method for face recognition based on optical flow field", IASP 2009). Who does not stir at all is
// a picture on the wall. Networks trained for this could not tell well made prints
// (docs/tried.md). Nothing is kept but one small picture a face, for 0.3 s.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "kiosk/frame/head.h"

namespace wellspring::kiosk {

// Says how the points of a face went from one frame to another, in shares of the face's width. It
// takes about 4 ms to measure.
struct FaceFlow {
  float motion = 0;         // median path
  float plane_error = 0;    // the best homography leaves this, of three quarters of the points
  float similar_error = 0;  // the same of the best turn, shift and change of size
  float noise = 0;          // error of a point that is at rest
  // Median path against what is around the face and moves as one, if that is seen; at how many of
  // its four sides.
  std::optional<float> against;
  int sides = 0;
};

enum class FaceMotion : uint8_t {
  unclear,
  none,   // nothing moves
  plane,  // it moves as a picture does
  solid,  // it moves as a head does
};
FaceMotion classify(const FaceFlow& flow);

struct LivenessSettings {
  double every = 0.3;  // seconds between two frames that are compared
  double wait = 1.5;   // seconds after which somebody counts who stirs and is no picture for sure
  double still = 20;   // seconds without any motion; then it is a picture
};

struct LivenessState {
  bool started = false;
  double first_time = 0, last_time = 0, stirred_time = 0;  // seconds
  bool stirred = false;
  float evidence = 0;  // logarithm of the odds that it lives, within +-5
};

// Takes what two frames said; nothing: they could not be compared. A time that runs backwards
// counts as no time.
void step_liveness(LivenessState& state, const LivenessSettings& settings, double time,
                   std::optional<FaceMotion> motion);
// Returns how sure it is that this lives, 0..1.
float liveness(const LivenessState& state);
// Returns whether this is to be taken for a visitor.
bool counts_as_visitor(const LivenessState& state, const LivenessSettings& settings);

// Watches faces under their numbers (People).
class LivenessWatch {
 public:
  explicit LivenessWatch(const LivenessSettings& settings = {});
  ~LivenessWatch();
  // Takes a frame in which the face is seen.
  const LivenessState& step(const GrayFrame& frame, uint32_t id, const Box& face);
  void forget(uint32_t id);
  bool counts(const LivenessState& state) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
