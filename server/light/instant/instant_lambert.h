// SPDX-License-Identifier: Apache-2.0
// The shortest way through `instant_radiosity`: Lambertian places that the eye sees first, whose
// light is one irradiance, side by side from the eye's ray to the last light.
#pragma once
#include <span>
#include <vector>

#include "light/instant/instant_pass.h"
#include "light/sample.h"

namespace wellspring::light {

// Answers the requests that see something Lambertian, or nothing; returns the numbers of the
// others. Not for passes with caustics, where more may be seen from a Lambertian place than point
// lights.
std::vector<uint32_t> trace_lambert_hits(const Transport& transport, const InstantPass& pass,
                                         int max_depth, std::span<const Request> requests,
                                         std::span<Sample> samples);

// Pixels of a pass that ask the same lights.
struct PixelGroup {
  int region = -1, list = 0;
};
PixelGroup group_of_pixel(const InstantPass& pass, uint32_t pixel);
// Order of items by group; within one as they were.
class GroupOrder {
 public:
  void add(PixelGroup group, uint32_t item);
  void sort();
  size_t size() const { return keys_.size(); }
  // From `begin` on, items of one group, at most `most`; returns how many.
  size_t take(size_t begin, size_t most, uint32_t* items, PixelGroup& group) const;

 private:
  std::vector<uint64_t> keys_;
};

}  // namespace wellspring::light
