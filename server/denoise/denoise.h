// SPDX-License-Identifier: Apache-2.0
// Reconstructs pictures of few samples by learned networks: those of Intel Open Image Denoise
// (denoise/unet.h) with their published transfer function and input scale, on radiance with two
// guides. Weights are files that the launcher installs; without them, or without AVX2, there is no
// denoiser, and load_denoiser() says why.
#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "denoise/unet.h"

namespace wellspring::denoise {

enum class NetSize : uint8_t { small, base, large };
std::optional<NetSize> find_net_size(std::string_view name);  // "small", "base", "large"
const char* net_name(NetSize size);

// Holds one picture, row after row. All spans are of width x height.
struct DenoiseInput {
  int width = 0, height = 0;
  std::span<const vec3> color;   // linear radiance; NaN counts as 0
  std::span<const vec3> albedo;  // share of the light that leaves towards the eye, 0 to 1
  std::span<const vec3> normal;  // unit, in any space that all of them share; 0: nothing there
  // Factor of the radiance before the network; 0: input_scale().
  float scale = 0;
};

// Returns the factor that brings a picture to the brightness that networks were trained with: 0.18
// over the geometric mean of the luminances of blocks of about 16x16 pixels; 1 for a black picture.
float input_scale(int width, int height, std::span<const vec3> color);

// Holds one network and the memory that it works in. Only one thread at a time may use it.
class Denoiser {
 public:
  // Throws LoadError.
  explicit Denoiser(const std::string& file);

  // Encodes the input, which is not needed afterwards.
  void start(const DenoiseInput& input);
  // Computes for about `seconds`. Returns whether there is more to do; see UNet::advance().
  bool advance(double seconds, const std::atomic<bool>* stop = nullptr);
  // Writes the result after the last advance(): linear radiance, finite and not negative.
  void finish(std::span<vec3> color) const;

  // Does all of it at once.
  void run(const DenoiseInput& input, std::span<vec3> color);

  size_t memory_bytes() const;
  const UNet& net() const { return net_; }

 private:
  UNet net_;
  InputPixels input_;
  float scale_ = 1;
};

// Returns the file of a network within the folder that the launcher installs weights in, by default
// that of the environment variable WELLSPRING_WEIGHTS.
std::string weights_file(NetSize size, std::string folder = {});
// Returns nullptr if there is no denoiser; `problem` then says why in a sentence.
std::unique_ptr<Denoiser> load_denoiser(NetSize size, std::string& problem,
                                        const std::string& folder = {});

}  // namespace wellspring::denoise
