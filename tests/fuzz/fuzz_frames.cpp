// SPDX-License-Identifier: Apache-2.0
// Frames of WebSockets.
#include "fuzz/fuzz.h"
#include "stream/frame_counter.h"

namespace wellspring::fuzz {

// The first byte says how the rest is cut.
void fuzz_frames(Bytes bytes) {
  if (bytes.empty()) return;
  const size_t piece = 1 + bytes[0] % 16;
  bytes = bytes.subspan(1);
  FrameCounter whole, cut;
  const size_t frames = whole.count(bytes);
  require(frames <= bytes.size() / 2, "a header has two bytes");
  size_t counted = 0;
  for (size_t at = 0; at < bytes.size(); at += piece)
    counted += cut.count(bytes.subspan(at, std::min(piece, bytes.size() - at)));
  require(counted == frames, "it does not matter how bytes arrive");
}

}  // namespace wellspring::fuzz
