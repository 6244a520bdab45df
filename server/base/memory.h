// SPDX-License-Identifier: Apache-2.0
// Counts the memory that arrays hold, whether they use it or not.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/layers.h"

namespace wellspring {

template <class... Vectors>
size_t bytes_of(const Vectors&... vectors) {
  return (size_t(0) + ... + (vectors.capacity() * sizeof(typename Vectors::value_type)));
}

}  // namespace wellspring

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace wellspring {

// Finds how much memory this process may use, and gives unused memory back.

// Returns the machine's memory in bytes, or less if a control group bounds it (cgroup v2).
double usable_memory();
// Returns the least bound of the groups that `membership` (as /proc/self/cgroup) names below `root`
// (as /sys/fs/cgroup), from the process's own up to the root; 0: none bounds it.
double memory_bound(const std::string& membership, const std::string& root);

// Gives freed memory back to the system. glibc keeps it for later requests, in an arena for each of
// many threads: after many visitors have left, these are hundreds of MiB. Takes milliseconds, in
// which other threads wait for memory; does nothing if there is no glibc.
inline void return_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

// Defines a std::vector whose new items hold anything: for large arrays that many threads fill at
// once. Memory is first touched by the thread that fills it, and nobody waits while one thread
// writes zeros.

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
  // Does nothing: resize() calls it. T comes into being when it is assigned to, as trivially copied
  // types do.
  template <class U>
  void construct(U*) noexcept {}
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

// A vector of such items; read no item before it is written.
template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace wellspring
