// SPDX-License-Identifier: Apache-2.0
// Finds eigenvalues and eigenvectors of symmetric matrices: all of a small one, the largest of one
// that is known only by its products.
#pragma once
#include <functional>
#include <vector>

#include "base/layers.h"

namespace wellspring::collection {

struct EigenPair {
  double value = 0;
  std::vector<double> vector;  // its length is 1
};

// Returns all pairs of a dense matrix of n rows, the largest value first (Jacobi's rotations).
std::vector<EigenPair> small_eigenpairs(std::vector<double> matrix, int n);

// Products are asked for this many vectors at a time; entry i of vector k lies at i * wide + k.
inline constexpr int product_vectors = 4;
using Product = std::function<void(const double* vectors, double* products)>;

// Returns the `count` (at most product_vectors) pairs with the largest values, which may be
// negative, of a matrix of n rows: block Lanczos that orthogonalises against all it keeps, begun
// anew from the best when these are many. Ends when residuals are below 1e-12 of the largest value,
// or after `most_products` calls. Random beginnings are always the same.
std::vector<EigenPair> top_eigenpairs(int n, int count, const Product& product,
                                      int most_products = 120);

}  // namespace wellspring::collection
