// SPDX-License-Identifier: Apache-2.0
// Memory for arrays that are read at random every frame: on pages of 2 MiB where the system has
// them to give (Linux, "madvise" or "always"), because with small pages the look-up of the page
// costs as much as that of the data. Elsewhere, for small arrays and for what does not fill the
// last page, ordinary memory.
#pragma once
#include <cstddef>
#include <new>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace wellspring::cache {

template <class T>
struct BigPages {
  using value_type = T;
  static constexpr size_t page = size_t(2) << 20, least = 3 * page / 2;
  BigPages() = default;
  template <class U>
  BigPages(const BigPages<U>&) {}
  // Throws std::bad_alloc, as ordinary memory does.
  T* allocate(size_t count) {
    size_t bytes = count * sizeof(T);
    if (bytes < least) return static_cast<T*>(::operator new(bytes, std::align_val_t(64)));
    void* memory = ::operator new(bytes, std::align_val_t(page));
#if defined(__linux__)
    madvise(memory, bytes / page * page,
            MADV_HUGEPAGE);  // a wish: that it may fail does not matter
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t count) {
    ::operator delete(memory, std::align_val_t(count * sizeof(T) < least ? 64 : page));
  }
  friend bool operator==(const BigPages&, const BigPages&) { return true; }
};

template <class T>
using BigVector = std::vector<T, BigPages<T>>;

}  // namespace wellspring::cache
