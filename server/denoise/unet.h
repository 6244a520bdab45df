// SPDX-License-Identifier: Apache-2.0
// The U-Net of Intel Open Image Denoise (Ronneberger, Fischer, Brox 2015 for the form): 3x3
// convolutions with ReLU, four times 2x2 max pooling, four times nearest upsampling joined with the
// features of that level. Which of the two published forms it is, and how many channels each layer
// has, the weights' names and shapes tell.
//
// It is computed tile by tile, level by level: a tile reads its surroundings and computes them
// again, so that the features of full resolution never exist as a whole and pieces are
// independent. The same bits whatever the number of threads. Convolutions are oneDNN's, each on one
// thread; the pieces are oneTBB's.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "base/raw_vector.h"
#include "base/vec.h"
#include "denoise/weights.h"

namespace wellspring::denoise {

// Nine numbers of a pixel, each a share of 65535: encoded colour, albedo, encoded normal.
inline constexpr int input_channels = 9;
using InputPixels = RawVector<uint16_t>;

// Why networks cannot run on this processor; nullptr: they can.
const char* unet_problem();

class UNet {
 public:
  // Throws LoadError naming the tensor that is missing, left over or of another shape than the
  // network's. `path` is only for messages.
  UNet(const Weights& weights, const std::string& path);
  ~UNet();
  UNet(UNet&&) noexcept;
  UNet& operator=(UNet&&) noexcept;

  // Sets out for a picture of this size (any from 1x1). Borrows `input` (input_channels a pixel)
  // until the last advance().
  void start(int width, int height, const InputPixels& input);
  // Computes for about `seconds`, at least one piece a core. Returns whether there is more to do.
  // Where `stop` becomes true it returns soon, and what was done is kept.
  bool advance(double seconds, const std::atomic<bool>* stop = nullptr);
  // After the last advance(): encoded colour, 3 numbers a pixel.
  const RawVector<vec3>& output() const;

  // Features, weights as oneDNN has them, and each thread's tiles.
  size_t memory_bytes() const;
  // Multiplications and additions for a picture of the size started, without what tiles repeat.
  double operations() const;
  // What oneDNN runs, for the report: "jit:avx2" and the like, one name for all layers or several.
  std::string implementation() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::denoise
