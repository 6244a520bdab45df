// SPDX-License-Identifier: Apache-2.0
// Codebooks: finding the codevector that is nearest to a vector, and making codebooks by k-means
// (Lloyd, "Least squares quantization in PCM", 1982). All results are the same for any number of
// threads.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/layers.h"

namespace wellspring::volume {

// Codevectors as searching needs them.
struct Codebook {
  int dimensions = 0, count = 0;
  std::vector<float> vectors;  // one after the other
  std::vector<float> panels;   // sixteen codevectors side by side, dimension after dimension
  std::vector<float> halves;   // half the square of each one's length; infinite where none is
};
Codebook make_codebook(int dimensions, std::vector<float> vectors);

// Sets `nearest` to the index of the codevector nearest to each of the rows, which lie one after
// the other, by the matrix product |x|^2 - 2 x.c + |c|^2; of equally near ones the first. If its
// rounding could hide which of very near ones is nearest, all differences are computed.
void find_nearest(std::span<int> nearest, const Codebook& codebook, const float* rows);

// Returns the square of the distance.
double squared_distance(const float* a, const float* b, int dimensions);

struct TrainingSettings {
  int codevectors = 4096;
  int most_rounds = 12;
  double least_gain = 0.002;  // ends when a round lessens the error by a smaller part
  uint64_t seed = 1;
  std::vector<float> first;  // codevector 0, kept as it is; empty: all are found
};

// Returns codevectors, one after the other, for these rows: as many as asked for, or fewer if there
// are fewer distinct rows, but at least one. Starts from distinct rows at random; a codevector that
// no row is nearest to becomes the row that was farthest from its own.
// `progress` is told the part that is done; may throw (base/worker.h, Cancelled).
std::vector<float> train_codebook(std::span<const float> rows, int dimensions,
                                  const TrainingSettings& settings,
                                  const std::function<void(double)>& progress = {});

}  // namespace wellspring::volume
