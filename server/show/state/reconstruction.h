// SPDX-License-Identifier: Apache-2.0
// Learned reconstruction of pictures at rest as values: the one that is under way, and what of a
// visitor's rest it depends on. What is done with them: show/draw/still_pass.h.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "denoise/denoise.h"
#include "frame/frame.h"
#include "frame/tonemap.h"
#include "picture/keyframe.h"
#include "picture/still/reconstruct_still.h"
#include "show/state/picture_job.h"

namespace wellspring::show {

struct Visitor;

struct StillPass {
  enum class Step : uint8_t { compute, finish, done };
  Visitor* visitor = nullptr;  // whose picture it is; null: none is under way
  PictureJob job;
  bool backdrop = false;  // it is without what moves (show/draw/moving.h)
  Step step = Step::compute;
  bool at_work = false;  // the renderer is at it
  std::atomic<bool> given_up{false};
  double seconds = 0;  // of computing, so far
  Frame frame;         // drawn; then as it is shown
  StillReconstruction work;
  Image8 picture;
  Keyframe keyframe;                   // when it is finished the visitor's old one
  std::unique_ptr<Denoiser> denoiser;  // null: there is none
  std::string problem;                 // why
};
size_t memory_bytes(const StillPass& pass);

// Samples a pixel, on average, beyond which more would be kept no more.
inline constexpr double most_rest_samples = 0.98 * most_still_samples;
inline bool has_all_samples(const RestState& rest) { return rest.samples >= most_rest_samples; }

}  // namespace wellspring::show
