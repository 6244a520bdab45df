// SPDX-License-Identifier: Apache-2.0
// Memory that one stage of a frame borrows and the next may overwrite: the bins of the projection
// and the cells of a picture share it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "cache/big_pages.h"

namespace wellspring::cache {

class Scratch {
 public:
  // Starts a stage that takes at most `bytes` (each taken array rounds up to 64).
  void start(size_t bytes) {
    if (memory_.size() * sizeof(Line) < bytes) {
      memory_.clear();
      memory_.shrink_to_fit();
      memory_.resize((bytes + sizeof(Line) - 1) / sizeof(Line));
    }
    used_ = 0;
  }
  // Contents are whatever was there before. `start` must have asked for enough.
  template <class T>
  std::span<T> take(size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    T* first = reinterpret_cast<T*>(reinterpret_cast<std::byte*>(memory_.data()) + used_);
    used_ += rounded<T>(count);
    return {first, count};
  }
  template <class T>
  static constexpr size_t rounded(size_t count) {
    return (count * sizeof(T) + 63) / 64 * 64;
  }
  void release() {
    memory_.clear();
    memory_.shrink_to_fit();
  }
  size_t bytes() const { return memory_.capacity() * sizeof(Line); }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  BigVector<Line> memory_;
  size_t used_ = 0;
};

}  // namespace wellspring::cache
