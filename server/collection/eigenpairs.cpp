// SPDX-License-Identifier: Apache-2.0
#include "collection/eigenpairs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/rng.h"

namespace wellspring::collection {

namespace {

using Vector = std::vector<double>;
constexpr double residual_part = 1e-12;
constexpr size_t most_basis = 48, kept_basis = 8;

double dot(const Vector& a, const Vector& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}
void add(Vector& to, double factor, const Vector& what) {
  for (size_t i = 0; i < to.size(); i++) to[i] += factor * what[i];
}

// Turns rows and columns p and q so that their entry vanishes (Golub, Van Loan, section 8.5).
void rotate(Vector& a, Vector& vectors, size_t n, size_t p, size_t q) {
  const double apq = a[p * n + q];
  if (apq == 0) return;
  const double theta = (a[q * n + q] - a[p * n + p]) / (2 * apq);
  const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  auto turn = [&](Vector& m, size_t i, size_t k) {
    const double x = m[i], y = m[k];
    m[i] = c * x - s * y;
    m[k] = s * x + c * y;
  };
  for (size_t i = 0; i < n; i++) turn(a, i * n + p, i * n + q);
  for (size_t i = 0; i < n; i++) turn(a, p * n + i, q * n + i);
  for (size_t i = 0; i < n; i++) turn(vectors, i * n + p, i * n + q);
}

}  // namespace

std::vector<EigenPair> small_eigenpairs(std::vector<double> a, int rows) {
  const size_t n = size_t(rows);
  Vector vectors(n * n);
  for (size_t i = 0; i < n; i++) vectors[i * n + i] = 1;
  for (int sweep = 0; sweep < 40; sweep++) {
    double off = 0, all = 0;
    for (size_t i = 0; i < n * n; i++) {
      all += a[i] * a[i];
      if (i / n != i % n) off += a[i] * a[i];
    }
    if (off <= 1e-32 * all) break;
    for (size_t p = 0; p < n; p++)
      for (size_t q = p + 1; q < n; q++) rotate(a, vectors, n, p, q);
  }
  std::vector<EigenPair> pairs(n);
  for (size_t k = 0; k < n; k++) {
    pairs[k].value = a[k * n + k];
    for (size_t i = 0; i < n; i++) pairs[k].vector.push_back(vectors[i * n + k]);
  }
  std::ranges::stable_sort(pairs, std::ranges::greater(), &EigenPair::value);
  return pairs;
}

std::vector<EigenPair> top_eigenpairs(int rows, int count, const Product& product,
                                      int most_products) {
  const size_t n = size_t(rows), wide = product_vectors;
  std::vector<Vector> basis, images;  // orthonormal vectors, and the matrix times each
  std::vector<Vector> next(std::min(wide, n), Vector(n));
  Rng random(1);
  for (Vector& one : next)
    for (double& number : one) number = double(random.uniform()) - 0.5;
  Vector in(n * wide), out(n * wide);
  std::vector<EigenPair> found;
  for (int products = 0; products < most_products && basis.size() < n; products++) {
    // Keeps what is new of the next vectors; a second pass mends the rounding of the first.
    const size_t before = basis.size();
    for (Vector& one : next) {
      const double length = std::sqrt(dot(one, one));
      if (length == 0) continue;
      for (double& number : one) number /= length;
      for (int pass = 0; pass < 2; pass++)
        for (const Vector& other : basis) add(one, -dot(one, other), other);
      const double rest = std::sqrt(dot(one, one));
      if (rest < 1e-8) continue;
      for (double& number : one) number /= rest;
      for (const Vector& other : basis) add(one, -dot(one, other), other);
      basis.push_back(std::move(one));
      if (basis.size() == n) break;
    }
    if (basis.size() == before) break;  // the basis holds all that the beginning reaches
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < wide; k++)
        in[i * wide + k] = before + k < basis.size() ? basis[before + k][i] : 0;
    product(in.data(), out.data());
    for (size_t k = before; k < basis.size(); k++) {
      images.emplace_back(n);
      for (size_t i = 0; i < n; i++) images.back()[i] = out[i * wide + k - before];
    }
    // Rayleigh and Ritz: the best pairs within the basis.
    const size_t size = basis.size();
    Vector small(size * size);
    for (size_t i = 0; i < size; i++)
      for (size_t k = 0; k <= i; k++)
        small[i * size + k] = small[k * size + i] = dot(basis[i], images[k]);
    const std::vector<EigenPair> ritz = small_eigenpairs(std::move(small), int(size));
    auto combine = [&](const EigenPair& pair, const std::vector<Vector>& of) {
      Vector sum(n);
      for (size_t i = 0; i < size; i++) add(sum, pair.vector[i], of[i]);
      return sum;
    };
    double largest = 0;
    for (const EigenPair& pair : ritz) largest = std::max(largest, std::abs(pair.value));
    const size_t kept = size + wide > most_basis ? kept_basis : std::min(wide, size);
    std::vector<Vector> best, best_images;
    for (size_t k = 0; k < std::min(kept, size); k++) {
      best.push_back(combine(ritz[k], basis));
      best_images.push_back(combine(ritz[k], images));
    }
    found.clear();
    next.clear();
    bool done = size >= size_t(count);
    for (size_t k = 0; k < std::min(wide, best.size()); k++) {
      Vector residual = best_images[k];
      add(residual, -ritz[k].value, best[k]);
      const bool small_enough = std::sqrt(dot(residual, residual)) <= residual_part * largest;
      if (k < size_t(count)) {
        found.push_back({ritz[k].value, best[k]});
        done = done && small_enough;
      }
      if (!small_enough) next.push_back(std::move(residual));
    }
    if (done) break;
    if (kept == kept_basis) basis = std::move(best), images = std::move(best_images);
  }
  return found;
}

}  // namespace wellspring::collection
