// SPDX-License-Identifier: Apache-2.0
// Makes the picture of a view that stands still from few samples a pixel: learned reconstruction
// (denoise/denoise.h) of their means; a picture that was drawn in remembered light counts as half a
// sample of each pixel, and stands where there is none yet. (Half the resolution while samples are
// fewer than pixels has more error: castle, 0.35 samples a pixel, FLIP 0.177 for 0.161.) The plain
// mean of the samples takes over as they become many (mix_in_means()).
//
// begin -> Denoiser::advance() until done -> finish. Memory is borrowed from one picture to the
// next.
#pragma once
#include <cstdint>
#include <vector>

#include "cache/point_image.h"
#include "denoise/denoise.h"
#include "frame/frame.h"
#include "light/sample.h"
#include "light/visible/guides.h"
#include "light/visible/visibility.h"
#include "picture/still/still_samples.h"
#include "world/view.h"

namespace wellspring::picture {

// Finds guides of a picture at rest (light/visible/guides.h) from the visibility pass: the surface
// of every pixel at a few places of it. Only pixels of surfaces that may be polished get a ray, in
// the first pass, as their guides are those of what the surface shows.

inline constexpr int guide_places = 4;  // places in a pixel, enough to antialias well

// Does one visibility pass: adds what it sees at place `place` of the pixels, of guide_places. The
// first pass makes the planes the view's size, begins anew and overwrites `followed`: not 0 at
// pixels whose guides are a ray's, which the other passes leave alone.
void add_still_guides(const World& world, const Lights& lights, const VisibilityPass& visibility,
                      const View& view, RasterShows shows, int place, GuidePlanes& planes,
                      std::vector<uint8_t>& followed);

struct StillReconstruction {
  int width = 0, height = 0;      // size of the picture, pixels
  GuidePlanes guides;             // guides of its pixels
  std::vector<uint8_t> followed;  // as in picture/still/reconstruct_still.h
  std::vector<vec3> color;        // colours of its pixels: the input, then the result
  std::vector<float> shares;      // shares of the mean, for squares of pixels
};
size_t memory_bytes(const StillReconstruction& work);

// Returns the mean number of samples a pixel.
double mean_count(const StillSamples& samples);

// Starts `denoiser` with the means. `drawn`: only its colour is read. work.guides are those of its
// pixels.
void begin_reconstruction(const StillSamples& samples, const Frame& drawn, Denoiser& denoiser,
                          StillReconstruction& work);
// Overwrites the frame's colours with the result.
void finish_reconstruction(const StillSamples& samples, const Denoiser& denoiser,
                           StillReconstruction& work, Frame& frame);

// Chooses which pixels are sampled while the view stands still: all of them in turn, so that any
// number of samples is spread evenly: a quarter of a sample a pixel is one for each square of 2x2
// pixels. The samples of a pixel are those of its sequence (light/technique/technique.h).

// Appends `count` requests for the samples [first, first + count) of the view's sequence.
void plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                std::vector<Request>& requests);

// Does the same if cells of the view count differently (PointImage::weight, of that view, which is
// not empty): each time that its turn comes, a pixel has as many samples as its cell counts, once
// in so many turns if that is less than one; none if `kept` has most_still_samples. A pixel's
// sequence goes on after as many samples as `kept` has. Appends at most `count`, within a round of
// all pixels. Returns which sample would come next.
uint64_t plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                    const PointImage& image, const StillSamples& kept,
                    std::vector<Request>& requests);

}  // namespace wellspring::picture
