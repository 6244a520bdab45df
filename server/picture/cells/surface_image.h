// SPDX-License-Identifier: Apache-2.0
// Holds what the points say about every pixel, before light is put together. A few rows of it lie
// in SurfaceRows while cells are built and holes filled; the whole picture lies packed in the
// planes of a frame.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "cache/project.h"
#include "frame/frame.h"

namespace wellspring::picture {

inline constexpr uint32_t no_object = 0xffffffffu;  // nothing is known here

// Rays through pixel centres in view coordinates (right, up, forward = 1).
struct PixelRays {
  vec2 axis;  // pixels
  float inverse_focal;
  explicit PixelRays(const WindowView& view)
      : axis(axis_place(view) - view.shift),
        inverse_focal(view.tan_half_fov * 2 / float(view.height)) {}
  float x(float column) const { return (column - axis.x) * inverse_focal; }
  float y(float row) const { return (axis.y - row) * inverse_focal; }
};

// Each plane has one word a pixel: the point's albedo, rest and smooth as in PointColor, its
// object, the bits of its depth, and its normal (16 bits), count and noise (8 bits each) together.
enum SurfacePlane { plane_albedo, plane_rest, plane_smooth, plane_object, plane_more, plane_depth };
inline constexpr int surface_planes = 6;

// Holds rows of these planes, each padded by empty pixels on both sides; only one of row y and row
// y + count can be held. Whoever writes beyond a row's end may leave only empty pixels there.
class SurfaceRows {
 public:
  static constexpr int before = 8, after = 40;
  void start(int width, int count) {
    if (count == count_ && stride_ == size_t(width) + before + after) return;
    count_ = count;
    stride_ = size_t(width) + before + after;
    words_.resize(stride_ * size_t(count) * surface_planes);
    for (int y = 0; y < count; y++) clear(y);
  }
  uint32_t* row(SurfacePlane plane, int y) { return words_.data() + at(plane, y); }
  const uint32_t* row(SurfacePlane plane, int y) const { return words_.data() + at(plane, y); }
  // Makes a row empty, with its padding.
  void clear(int y) {
    for (int plane = 0; plane < surface_planes; plane++)
      std::memset(row(SurfacePlane(plane), y) - before, plane == plane_object ? 0xff : 0,
                  stride_ * sizeof(uint32_t));
  }

 private:
  size_t at(SurfacePlane plane, int y) const {
    return (size_t(y + count_) % size_t(count_) * surface_planes + plane) * stride_ + before;
  }
  int count_ = 0;
  size_t stride_ = 0;
  std::vector<uint32_t> words_;
};

// Reads the points of row y of the picture; a row outside becomes empty. Returns how many hold
// `converged_samples` or more.
int read_points(const PointCache& points, const PointImage& image, int y, SurfaceRows& rows);

// Packs row y into the frame, its holes filled from their 3x3 neighbours (weights 2 and 1 for
// reflectance, the nearest for the rest; those of the object with most weight). Rows y - 1 to y + 1
// must have been read. Pixels without neighbours stay no_object. Returns the number of points in
// the row.
int fill_from_neighbours(const SurfaceRows& rows, int y, Frame& frame);

// The surface of a picture lies in its frame like this: depth, object and `more` of a pixel lie in
// its own place of the planes depth, object and confidence. Albedo, rest and smooth share the place
// of the colours four pixels at a time: for the pixels x to x + 3 first four words of albedo, then
// four of rest, then four of smooth. Such fours start two pixels left of the picture, where the
// groups of compose_drawn.cpp do; at the edges a four has fewer pixels.
inline constexpr int packed_four = 4, packed_start = -2;
struct PackedFour {
  int first, count;  // pixels of the four that lie in the picture
  PackedFour(int x, int width)
      : first(std::max(x, 0)), count(std::min(x + packed_four, width) - first) {}
};
inline uint32_t* packed_words(Frame& frame, int x, int y) {
  return reinterpret_cast<uint32_t*>(frame.color.data() + size_t(y) * size_t(frame.width) +
                                     size_t(x));
}

inline const uint32_t* packed_words(const Frame& frame, int x, int y) {
  return packed_words(const_cast<Frame&>(frame), x, y);
}
// Returns the word of one pixel in the plane albedo, rest or smooth.
inline uint32_t& packed_word(Frame& frame, int x, int y, SurfacePlane plane) {
  PackedFour four((x - packed_start) / packed_four * packed_four + packed_start, frame.width);
  return packed_words(frame, four.first, y)[x - four.first + four.count * plane];
}
// Reads the words of one pixel of the packed surface; `words`: surface_planes of them.
inline void read_packed(const Frame& frame, int x, int y, uint32_t* words) {
  size_t at = size_t(y) * size_t(frame.width) + size_t(x);
  for (SurfacePlane plane : {plane_albedo, plane_rest, plane_smooth})
    words[plane] = packed_word(const_cast<Frame&>(frame), x, y, plane);
  words[plane_object] = frame.object[at];
  std::memcpy(&words[plane_more], &frame.confidence[at], sizeof(uint32_t));
  std::memcpy(&words[plane_depth], &frame.depth[at], sizeof(uint32_t));
}

}  // namespace wellspring::picture
