// SPDX-License-Identifier: Apache-2.0
// The picture of a view that stands still, from few samples a pixel: learned reconstruction
// (denoise/denoise.h) of their means; a picture that was drawn in remembered light counts as half a
// sample of each pixel, and stands where there is none yet. (Half the resolution while samples are
// fewer than pixels has more error: castle, 0.35 samples a pixel, FLIP 0.177 for 0.161.) Their
// plain mean takes over as samples become many (mix_in_means()).
//
// begin -> Denoiser::advance() until done -> finish. Memory is borrowed from one picture to the
// next.
#pragma once
#include <vector>

#include "denoise/denoise.h"
#include "frame/frame.h"
#include "light/visible/guides.h"
#include "picture/still/still_samples.h"

namespace wellspring::picture {

struct StillReconstruction {
  int width = 0, height = 0;      // of the picture
  GuidePlanes guides;             // of its pixels
  std::vector<uint8_t> followed;  // picture/still/still_guides.h
  std::vector<vec3> color;        // of its pixels: the input, then what was found
  std::vector<float> shares;      // of the mean, for squares of pixels
};
size_t memory_bytes(const StillReconstruction& work);

// Samples a pixel, on average.
double mean_count(const StillSamples& samples);

// `drawn`: only its colour is read. work.guides are of its pixels.
void begin_reconstruction(const StillSamples& samples, const Frame& drawn, Denoiser& denoiser,
                          StillReconstruction& work);
// Overwrites the frame's colours.
void finish_reconstruction(const StillSamples& samples, const Denoiser& denoiser,
                           StillReconstruction& work, Frame& frame);

}  // namespace wellspring::picture
