// SPDX-License-Identifier: Apache-2.0
// Holds which point shows at each pixel (Walter 1999, figure 4: the point image), the priorities of
// the pixels, and where the light was seen to change.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace wellspring::cache {

// Holds arrays that are read at random every frame on pages of 2 MiB if the system has them to give
// (Linux, "madvise" or "always"), because with small pages the look-up of the page costs as much as
// that of the data. Other systems, small arrays and the rest beyond the last full page get ordinary
// memory.

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
            MADV_HUGEPAGE);  // only a hint: it may fail
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

inline constexpr uint32_t no_point = 0xffffffffu;
// Depth of points at infinity; Frame::depth has infinity.
inline constexpr float infinite_depth = 1e18f;
inline constexpr int change_tile = 16;  // pixels a side of one cell of `changed`
inline constexpr int weight_cell = 4;   // pixels a side of one cell of `weight`
inline constexpr int weight_one = 16;   // `weight` of a pixel that counts as it is

// Holds how one sample differs from a known point's light.
struct ChangeSample {
  uint32_t point = 0;
  // Change of the luminance over the mean that includes the new sample: 0 on average if nothing has
  // changed, whatever the samples' distribution, since any of them might as well have been the
  // last.
  float change = 0;
  // Standard deviation of `change` if the light stays the same; 0: unknown.
  float noise = 0;
};
// Holds the sums of a tile's change samples.
struct TileChange {
  float change = 0, square = 0;  // square: sum of the squared change or noise, whichever is more
  int count = 0;
};

struct PointImage {
  int width = 0, height = 0;
  BigVector<uint32_t> point;      // index into the cache, or no_point
  BigVector<float> depth;         // metres along the viewing axis; 0 if there is no point
  std::vector<uint8_t> priority;  // 0: nothing to learn or already asked; 255: most urgent
  // Factor of the priorities of each cell's pixels, times weight_one, row after row. If empty, all
  // pixels count as they are.
  std::vector<uint8_t> weight;
  std::vector<uint8_t> renewed;  // not 0: the light differs from that in the last picture
  std::vector<ChangeSample> change_samples;  // newest ones, oldest first; see age_changed()
  std::vector<TileChange> changed;           // scratch of age_changed()
  int changed_width = 0, changed_height = 0;
  int alarm = 0;  // number of pictures in which smaller changes are looked for, too
};

// Reserves memory for pictures of this size, except for priorities, which mean nothing between
// them.
inline void reserve_image(PointImage& image, int width, int height) {
  size_t pixels = size_t(width) * size_t(height);
  auto tiles = [](int side) { return size_t((side + change_tile - 1) / change_tile); };
  image.point.reserve(pixels);
  image.depth.reserve(pixels);
  image.renewed.reserve(pixels);
  image.changed.reserve(tiles(width) * tiles(height));
}

inline int weight_cells(int side) { return (side + weight_cell - 1) / weight_cell; }

// Returns the most change samples to keep: enough in each tile to tell change from noise.
inline size_t most_change_samples(const PointImage& image) {
  const size_t each = image.alarm > 0 ? 48 : 12, most = image.alarm > 0 ? 1 << 17 : 1 << 15;
  return std::min(each * image.changed.size(), most);
}
// Drops the oldest change samples beyond that number, so that `more` new ones still fit.
inline void keep_newest_change_samples(PointImage& image, size_t more = 0) {
  size_t count = image.change_samples.size(), most = most_change_samples(image),
         kept = std::min(count, most - std::min(more, most));
  image.change_samples.erase(image.change_samples.begin(),
                             image.change_samples.begin() + ptrdiff_t(count - kept));
  if (image.change_samples.capacity() > 2 * most)
    image.change_samples.shrink_to_fit();  // after an alarm
}

// Empties the image when its size changes.
inline void resize_image(PointImage& image, int width, int height) {
  if (width == image.width && height == image.height) return;
  size_t pixels = size_t(width) * size_t(height);
  image.width = width;
  image.height = height;
  image.changed_width = (width + change_tile - 1) / change_tile;
  image.changed_height = (height + change_tile - 1) / change_tile;
  image.point.assign(pixels, no_point);
  image.depth.assign(pixels, 0.0f);
  image.priority.assign(pixels, uint8_t(0));
  image.renewed.assign(pixels, uint8_t(0));
  image.weight.clear();
  image.changed.assign(size_t(image.changed_width) * size_t(image.changed_height), TileChange{});
}

// Holds memory that one stage of a frame borrows and the next may overwrite: the bins of the
// projection and the cells of a picture share it.

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
  // Returns an array whose contents are whatever was there before. `start` must have asked for
  // enough.
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
