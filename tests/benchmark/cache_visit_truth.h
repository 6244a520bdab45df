// SPDX-License-Identifier: Apache-2.0
// Converged pictures of wanted views, kept on disk so that later runs need not wait. A picture is
// found again by what it is of (view, samples) and by a probe: a tiny render of the same view whose
// bits tell whether scene, pose, light or renderer are still the same.
#pragma once
#include <string>

#include "light/technique/technique.h"

namespace wellspring::test {

struct TruthSettings {
  int spp = 64;          // samples a pixel in each half
  int max_depth = 6;     // as the show's
  uint64_t content = 0;  // hash of the exhibit's files
  std::string folder;    // made when missing
};

struct Truth {
  Frame picture;  // mean of two halves with samples of their own
  Frame half[2];
  bool kept = false;  // it was found on disk
};

// All cores, seconds. Technique `path`, not clamped. Throws LoadError when the folder cannot be
// written.
Truth find_truth(const World& world, const Lights& lights, const View& view,
                 const TruthSettings& settings);

// Hashes the bytes and names of all files below a folder.
uint64_t hash_files(const std::string& folder);

}  // namespace wellspring::test
