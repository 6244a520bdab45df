// SPDX-License-Identifier: Apache-2.0
// A std::vector whose new items hold anything: for large arrays that many threads fill at once.
// Memory is first touched by who fills it, and nobody waits while one thread writes zeros.
#pragma once
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace wellspring {

template <class T>
struct RawAllocator : std::allocator<T> {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  RawAllocator() = default;
  template <class U>
  RawAllocator(const RawAllocator<U>&) {}
  template <class U>
  struct rebind {
    using other = RawAllocator<U>;
  };
  // What resize() calls. T comes into being when it is assigned to, as trivially copied types do.
  template <class U>
  void construct(U*) noexcept {}
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

// Read no item before it is written.
template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace wellspring
