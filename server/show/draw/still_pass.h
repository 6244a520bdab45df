// SPDX-License-Identifier: Apache-2.0
// Learned reconstruction of pictures at rest (picture/still/reconstruct_still.h), of one visitor at a
// time, while nobody waits for a picture. A picture's order says that it is to become one
// (PictureOrder::reconstruct): it is drawn and its guides are found step by step, but it is not
// shown; then the network computes in slices, between which what moves may be drawn and the world
// may change; what it has found is shown instead. From then on the visitor's time goes to samples
// alone, and the next pass comes when there are so many more of them that it pays.
#pragma once
#include <atomic>
#include <memory>
#include <string>

#include "denoise/denoise.h"
#include "frame/frame.h"
#include "picture/keyframe.h"
#include "picture/still/reconstruct_still.h"
#include "show/state/picture_job.h"

namespace wellspring {

struct Show;
struct Visitor;

struct StillPass {
  enum class Step : uint8_t { compute, finish, done };
  Visitor* visitor = nullptr;  // whose picture it is; null: none is under way
  PictureOrder order;
  bool backdrop = false;  // it is without what moves (show/draw/moving.h)
  Step step = Step::compute;
  bool at_work = false;            // the easel is at it
  std::atomic<bool> given_up{false};
  double seconds = 0;              // of computing, so far
  Frame frame;                     // drawn; then as it is shown
  StillReconstruction work;
  Image8 picture;
  Keyframe keyframe;               // when it is finished the visitor's old one
  std::unique_ptr<Denoiser> denoiser;  // null: there is none
  std::string problem;                 // why
};
size_t memory_bytes(const StillPass& pass);

// What of a visitor's rest, since the view or the light last changed, passes depend on.
struct RestState {
  uint64_t asked = 0;          // samples of the view's sequence (picture/still/plan_still.h)
  double samples = 0;          // a pixel, that are kept
  double passed_samples = 0;   // of these, in the last pass
  double passed_at = -1e9, passed_seconds = 0;  // show time of its end; what it took
  bool reconstructed = false;  // its picture is the one shown
};

// More samples of its pixels would be kept no more.
bool has_all_samples(const RestState& rest);
// The next picture is to become a reconstruction.
bool wants_pass(const Show& show, const Visitor& visitor);
// Its picture is one and stays: only samples are wanted.
bool keeps_picture(const Show& show, const Visitor& visitor);

// By the tick, while the easel is idle: the order's picture is drawn, and `pass` begins with it.
void begin_pass(Show& show, const PictureOrder& order, Visitor& visitor);
// On the easel: one slice.
void go_on_with_pass(Show& show);
// By the tick, when a slice is done: takes over what is finished, lets go what was given up.
void take_pass(Show& show);
// By the tick: notes that nobody needs it any more.
void watch_pass(Show& show);

}  // namespace wellspring
