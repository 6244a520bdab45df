// SPDX-License-Identifier: Apache-2.0
// Computes the U-Net of Intel Open Image Denoise (Ronneberger, Fischer, Brox 2015 for the form):
// 3x3 convolutions with ReLU, four times 2x2 max pooling, four times nearest upsampling joined with
// the features of that level. The weights' names and shapes say which of the two published forms it
// is, and how many channels each layer has.
//
// It is computed tile by tile, level by level: a tile reads its surroundings and computes them
// again, so that the features of full resolution never exist as a whole and pieces are independent.
// The bits are the same whatever the number of threads. Convolutions are oneDNN's, each on one
// thread; the pieces are oneTBB's.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/memory.h"
#include "base/vec.h"
#include "denoise/weights.h"

namespace wellspring::denoise {

// A pixel has nine numbers, each a share of 65535: encoded colour, albedo, encoded normal.
inline constexpr int input_channels = 9;
using InputPixels = RawVector<uint16_t>;

// Returns why networks cannot run on this processor; nullptr if they can.
const char* unet_problem();

class UNet {
 public:
  // Throws LoadError naming the tensor that is missing, left over or of another shape than the
  // network's. `path` is only for messages.
  UNet(const Weights& weights, const std::string& path);
  ~UNet();
  UNet(UNet&&) noexcept;
  UNet& operator=(UNet&&) noexcept;

  // Begins a picture of this size (any from 1x1). Borrows `input` (input_channels a pixel) until
  // the last advance().
  void start(int width, int height, const InputPixels& input);
  // Computes for about `seconds`, at least one piece a core. Returns whether there is more to do.
  // If `stop` becomes true it returns soon, and what was done is kept.
  bool advance(double seconds, const std::atomic<bool>* stop = nullptr);
  // Returns the encoded colour, 3 numbers a pixel, after the last advance().
  const RawVector<vec3>& output() const;

  // Counts features, weights as oneDNN has them, and each thread's tiles.
  size_t memory_bytes() const;
  // Returns the multiplications and additions for a picture of the size started, without those that
  // tiles repeat.
  double operations() const;
  // Returns which implementation oneDNN runs, for the report: "jit:avx2" and the like, one name for
  // all layers or several.
  std::string implementation() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Lists the layers of the two published networks, by level: those of a stage read and leave one
// resolution.

// Names the layers of a stage in turn; level 0 is full resolution.
struct StageForm {
  int level;
  std::vector<std::string> layers;
  bool pools;
};
inline const std::vector<StageForm> plain_form = {
    {0, {"enc_conv0", "enc_conv1"}, true},
    {1, {"enc_conv2"}, true},
    {2, {"enc_conv3"}, true},
    {3, {"enc_conv4"}, true},
    {4, {"enc_conv5a", "enc_conv5b"}, false},
    {3, {"dec_conv4a", "dec_conv4b"}, false},
    {2, {"dec_conv3a", "dec_conv3b"}, false},
    {1, {"dec_conv2a", "dec_conv2b"}, false},
    {0, {"dec_conv1a", "dec_conv1b", "dec_conv0"}, false}};
inline const std::vector<StageForm> large_form = {
    {0, {"enc_conv1a", "enc_conv1b"}, true},
    {1, {"enc_conv2a", "enc_conv2b"}, true},
    {2, {"enc_conv3a", "enc_conv3b"}, true},
    {3, {"enc_conv4a", "enc_conv4b"}, true},
    {4, {"enc_conv5a", "enc_conv5b"}, false},
    {3, {"dec_conv4a", "dec_conv4b"}, false},
    {2, {"dec_conv3a", "dec_conv3b"}, false},
    {1, {"dec_conv2a", "dec_conv2b"}, false},
    {0, {"dec_conv1a", "dec_conv1b", "dec_conv1c"}, false}};

}  // namespace wellspring::denoise
