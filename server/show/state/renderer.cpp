// SPDX-License-Identifier: Apache-2.0
#include "show/state/renderer.h"

#include "base/memory.h"
#include "workers/crew.h"

namespace wellspring::show {

ShowCrew::ShowCrew() = default;
ShowCrew::~ShowCrew() = default;

size_t memory_bytes(const StillPass& pass) {
  return memory_bytes(pass.frame) + memory_bytes(pass.work) + memory_bytes(pass.keyframe) +
         bytes_of(pass.picture.rgb) + (pass.denoiser ? pass.denoiser->memory_bytes() : 0);
}

size_t memory_bytes(const DrawingWork& work) {
  return memory_bytes(*work.cache) + memory_bytes(*work.compositor) + memory_bytes(work.frame) +
         memory_bytes(work.keyframe) + memory_bytes(work.around) +
         bytes_of(work.depth, work.picture.rgb, work.requests, work.ahead, work.away,
                  work.samples) +
         memory_bytes(work.dynamic) + memory_bytes(work.backdrop_light) +
         memory_bytes(work.moving_light) + memory_bytes(work.moving);
}

}  // namespace wellspring::show
