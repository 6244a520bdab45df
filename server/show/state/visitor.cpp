// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor.h"

namespace wellspring {

size_t picture_memory(const Visitor& visitor) {
  return memory_bytes(visitor.picture) + visitor.shown.encoder->memory_bytes;
}

}  // namespace wellspring
