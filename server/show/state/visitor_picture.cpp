// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor_picture.h"

#include "base/memory.h"

namespace wellspring::show {

size_t memory_bytes(const VisitorPicture& picture) {
  return picture.cache.memory_bytes() + picture.compositor.memory_bytes() +
         picture.broker.memory_bytes() + memory_bytes(picture.keyframe) +
         memory_bytes(picture.around.keyframe) + memory_bytes(picture.moving) +
         memory_bytes(picture.surfaces) + memory_bytes(picture.settled) +
         bytes_of(picture.image.rgb, picture.fade.from.rgb);
}

}  // namespace wellspring::show
