// SPDX-License-Identifier: Apache-2.0
// Holds the mean light of each pixel's samples while the view stands still, over all of the pixel,
// whatever surfaces it shows: with more and more samples it becomes the reference. It takes 6 bytes
// a pixel.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/memory.h"
#include "base/vec.h"
#include "cache/packing.h"
#include "frame/frame.h"

namespace wellspring::picture {

// Holds the mean over the last drawn pictures of a view that stands still, each seen at another
// place of its pixels: the antialiased picture. It takes 7 bytes a pixel.

struct StillImage {
  std::array<std::vector<uint16_t>, 3> mean;  // pack_half
  std::vector<uint8_t> count;                 // number of pictures in the mean; 0: begins anew
};

// Number of pictures, each seen at another place of the pixels (base/rng.h), that antialias well
// enough.
inline constexpr int still_places = 16;

// Averages a drawn picture into `still` and shows the average, except at pixels of objects for
// which `moves` returns true. `changes`: the light does, and the mean is over few pictures.
void accumulate_drawn(const std::function<bool(uint32_t)>& moves, bool changes, uint32_t seed,
                      StillImage& still, Frame& frame);

struct StillSamples {
  std::vector<uint32_t> mean;  // pack_rgb9e5
  // pack_deviation: one sample's standard deviation, root mean square over the channels.
  std::vector<uint8_t> deviation;
  std::vector<uint8_t> count;  // at most most_still_samples, over which the mean then looks back
};
inline constexpr int most_still_samples = 254;

// Makes room for the pixels, all without a sample.
void resize_samples(StillSamples& samples, size_t pixels);
// Drops samples of pixels at which `still` is to begin anew, as the light has changed or something
// moves there.
void invalidate_samples(const StillImage& still, StillSamples& samples);
// Adds a sample. `light`: finite, of a place anywhere in the pixel. `random` decides roundings.
void add_sample(StillSamples& samples, size_t pixel, vec3 light, uint32_t random);

// Returns the mean light of a pixel's samples; 0 without any.
inline vec3 mean_of(const StillSamples& samples, size_t pixel) {
  return unpack_rgb9e5(samples.mean[pixel]);
}
// Mixes the means into `color`, a picture of `size` pixels; those without a sample stay. The more
// samples there are, the more of their plain mean the picture is: each region takes the share that
// has the least error by their noise (James and Stein 1961), so that the picture becomes the
// reference. `shares`: scratch.
void mix_in_means(const StillSamples& samples, ivec2 size, std::vector<float>& shares,
                  std::vector<vec3>& color);

inline size_t samples_bytes(const StillSamples& samples) {
  return bytes_of(samples.mean, samples.deviation, samples.count);
}

}  // namespace wellspring::picture
