// SPDX-License-Identifier: Apache-2.0
#include "show/state/reconstruction.h"

#include "base/memory.h"

namespace wellspring::show {

size_t memory_bytes(const StillPass& pass) {
  return memory_bytes(pass.frame) + memory_bytes(pass.work) + memory_bytes(pass.keyframe) +
         bytes_of(pass.picture.rgb) + (pass.denoiser ? pass.denoiser->memory_bytes() : 0);
}

}  // namespace wellspring::show
