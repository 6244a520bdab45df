// SPDX-License-Identifier: Apache-2.0
// Counts the frames of a WebSocket on the wire (RFC 6455, section 5.2), of every kind: a library
// that reads messages swallows empty fragments and pongs without a word.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace wellspring::stream {

class FrameCounter {
 public:
  // Returns how many frames' headers end in these bytes, the next ones of the stream.
  size_t count(std::span<const uint8_t> bytes) {
    size_t frames = 0;
    while (!bytes.empty()) {
      if (payload_left_ > 0) {
        const size_t skipped = size_t(std::min<uint64_t>(payload_left_, bytes.size()));
        payload_left_ -= skipped;
        bytes = bytes.subspan(skipped);
        continue;
      }
      header_[size_++] = bytes[0];
      bytes = bytes.subspan(1);
      if (size_ < header_size()) continue;
      payload_left_ = payload_size();
      size_ = 0;
      frames++;
    }
    return frames;
  }

 private:
  size_t length_bytes() const {
    const int length = header_[1] & 0x7f;
    return length == 127 ? 8 : length == 126 ? 2 : 0;
  }
  size_t header_size() const {
    return size_ < 2 ? 2 : 2 + length_bytes() + (header_[1] & 0x80 ? 4 : 0);
  }
  uint64_t payload_size() const {
    const size_t bytes = length_bytes();
    uint64_t length = bytes ? 0 : header_[1] & 0x7f;
    for (size_t i = 0; i < bytes; i++) length = length << 8 | header_[2 + i];
    return length;
  }

  std::array<uint8_t, 14> header_{};
  size_t size_ = 0;            // bytes of header_ so far
  uint64_t payload_left_ = 0;  // bytes of the frame's payload that are still to come
};

}  // namespace wellspring::stream
