// SPDX-License-Identifier: Apache-2.0
#include "collection/layout.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "collection/eigenpairs.h"

namespace wellspring::collection {

namespace {

// Takes each vector's mean off.
void center(std::vector<double>& vectors, size_t n) {
  for (size_t k = 0; k < product_vectors; k++) {
    double mean = 0;
    for (size_t i = 0; i < n; i++) mean += vectors[i * product_vectors + k];
    mean /= double(n);
    for (size_t i = 0; i < n; i++) vectors[i * product_vectors + k] -= mean;
  }
}

}  // namespace

Layout lay_out(const Distances& distances) {
  const size_t n = size_t(distances.count);
  Layout layout;
  layout.places.resize(n);
  layout.item_stress.resize(n);
  std::vector<double> squares(n * n);
  parallel_for(int(n), [&](int i) {
    for (int k = 0; k < int(n); k++)
      squares[size_t(i) * n + size_t(k)] = distances.at(i, k) * distances.at(i, k);
  });
  // -1/2 J D^2 J, with J that takes means off.
  auto product = [&](const double* vectors, double* products) {
    std::vector<double> in(vectors, vectors + n * product_vectors);
    std::vector<double> out(in.size());
    center(in, n);
    parallel_ranges(int(n), 64, [&](int begin, int end) {
      for (size_t i = size_t(begin); i < size_t(end); i++) {
        double sums[product_vectors] = {};
        const double* row = squares.data() + i * n;
        for (size_t j = 0; j < n; j++)
          for (size_t k = 0; k < product_vectors; k++)
            sums[k] += row[j] * in[j * product_vectors + k];
        for (size_t k = 0; k < product_vectors; k++) out[i * product_vectors + k] = -0.5 * sums[k];
      }
    });
    center(out, n);
    std::ranges::copy(out, products);
  };
  const std::vector<EigenPair> pairs = top_eigenpairs(int(n), 2, product);
  for (size_t axis = 0; axis < std::min<size_t>(pairs.size(), 2); axis++) {
    const EigenPair& pair = pairs[axis];
    if (!(pair.value > 0)) continue;
    const auto [low, high] = std::ranges::minmax_element(pair.vector);
    const double sign = -*low > *high ? -1 : 1, length = sign * std::sqrt(pair.value);
    for (size_t i = 0; i < n; i++) layout.places[i][glm::length_t(axis)] = length * pair.vector[i];
  }
  std::vector<double> off(n), whole(n);
  parallel_for(int(n), [&](int i) {
    for (int k = 0; k < int(n); k++) {
      const double truth = distances.at(i, k);
      const double shown = glm::distance(layout.places[size_t(i)], layout.places[size_t(k)]);
      off[size_t(i)] += (shown - truth) * (shown - truth);
      whole[size_t(i)] += truth * truth;
    }
    if (whole[size_t(i)] > 0)
      layout.item_stress[size_t(i)] = std::sqrt(off[size_t(i)] / whole[size_t(i)]);
  });
  double all_off = 0, all = 0;
  for (size_t i = 0; i < n; i++) all_off += off[i], all += whole[i];
  if (all > 0) layout.stress = std::sqrt(all_off / all);
  return layout;
}

}  // namespace wellspring::collection
