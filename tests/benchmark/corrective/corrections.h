// SPDX-License-Identifier: Apache-2.0
// Corrects the light of shining objects, which depends on the view (Haber, Myszkowski, Yamauchi,
// Seidel 2001, section 4): each such object's samples are kept by themselves, dropped when the
// object is seen from too different an angle, warped and splatted over its own pixels, and asked
// for from coarse to fine in the order in which objects are attended to. Pixels that these samples
// leave out show the cache's points. Each visitor has corrections of their own. Moving things have
// none.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "correction_queue.h"
#include "warp_and_splat.h"
#include "frame/frame.h"
#include "light/sample.h"
#include "light/visible/visibility.h"

namespace wellspring::test {

// Returns for each object, by its number, how far the cosine to the eye may change until its
// samples are invalid (delta_of()); 0: the object is matte and is not corrected.
std::vector<float> find_shining(const Scene& scene);

// Finds the first object of each object's group: those of one material that stand close together
// (section 4.1).
std::vector<uint32_t> group_shining(const Scene& scene, std::span<const float> shining);

struct CorrectionCounts {
  uint64_t pictures = 0;                      // in which something that shines was seen
  uint64_t asked = 0, kept = 0, dropped = 0;  // samples
};

class Corrections {
 public:
  // `groups`: group_shining(); empty: each object is one by itself.
  explicit Corrections(std::vector<uint32_t> groups = {}) : groups_(std::move(groups)) {}
  // Finds what of `shining` the view shows, drops samples that no longer hold, and warps the
  // others. Nothing is done where nothing shines.
  void begin(const View& view, const VisibilityPass& visibility, std::span<const float> shining);
  // Appends requests for pixels of that view that no sample as fine is splatted on, at most `most`.
  // `weights`: of objects, see RenderCache::set_weights().
  void request(std::span<const float> weights, int most, uint64_t seed,
               std::vector<Request>& requests);
  // The same in no order, of pixels without a sample of their own.
  void request_evenly(int most, uint64_t seed, std::vector<Request>& requests);
  // Keeps answers to requests of `view`, whoever asked, as far as they show what shines.
  void remember(const View& view, std::span<const Request> requests,
                std::span<const Sample> samples);
  // Puts samples into the light of `lit`, packed as read_surface() leaves it, if that view was
  // begun.
  void show(const View& lit, Frame& light);

  // Pixels of the view that show what shines.
  int pixels() const { return pixels_; }
  const CorrectionCounts& counts() const { return counts_; }

 private:
  void find_regions(std::span<const float> weights);
  void splat();
  Request request_at(ivec2 place, uint64_t seed);

  std::vector<uint32_t> groups_;  // each object's group
  SampleStore store_;
  CorrectionQueue queue_;
  SplatScratch scratch_;
  std::vector<CorrectiveSample> found_;
  std::vector<float> shining_;
  View view_;
  uint32_t age_ = 0;
  // These describe the view's pixels.
  int pixels_ = 0;
  std::vector<uint32_t> object_, group_;
  uint32_t group_of(uint32_t object) const {
    return object < groups_.size() ? groups_[object] : object;
  }
  std::vector<float> depth_;
  std::vector<SampleWords> words_;
  std::vector<uint8_t> level_;
  CorrectionCounts counts_;
};

}  // namespace wellspring::test
