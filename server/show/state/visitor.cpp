// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor.h"

#include "base/memory.h"
#include "show/state/visitor_picture.h"

namespace wellspring::show {

Visitor::Visitor() : picture(std::make_unique<VisitorPicture>()) {}
Visitor::~Visitor() = default;

size_t picture_memory(const Visitor& visitor) {
  const SeenPicture* seen = visitor.looks.seen.get();
  return memory_bytes(*visitor.picture) + visitor.shown.encoder->memory_bytes +
         (seen ? bytes_of(seen->picture.rgb, seen->object) : 0);
}

}  // namespace wellspring::show
