// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor.h"

#include "base/memory.h"

namespace wellspring::show {

size_t picture_memory(const Visitor& visitor) {
  const SeenPicture* seen = visitor.looks.seen.get();
  return memory_bytes(visitor.picture) + visitor.shown.encoder->memory_bytes +
         (seen ? bytes_of(seen->picture.rgb, seen->object) : 0);
}

}  // namespace wellspring::show
