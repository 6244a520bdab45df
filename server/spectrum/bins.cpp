// SPDX-License-Identifier: Apache-2.0
#include "spectrum/bins.h"

#include <algorithm>
#include <cmath>

#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "spectrum/wavelength_density.h"

namespace wellspring::spectrum {
namespace {

// Reflectances at wavelengths this far apart have a correlation of 1/e.
constexpr double correlation_nm = 200;
// The variance of what all wavelengths have in common, over that of the rest: how bright a surface
// is says nothing of how its reflectance changes.
constexpr double common_variance = 100;
constexpr double least_response = 0.02;  // so that invisible wavelengths have weight in their bin

// Returns the share of the nanometre around nm that lies between two wavelengths.
double share_between(double nm, double low, double high) {
  return std::clamp(std::min(nm + 0.5, high) - std::max(nm - 0.5, low), 0.0, 1.0);
}

double sum_of(const dvec3& v) { return v.x + v.y + v.z; }

// Returns how reflectances at two wavelengths vary together.
double covariance(size_t i, size_t k) {
  return common_variance + std::exp(-std::abs(double(i) - double(k)) / correlation_nm);
}

// Returns the covariance of each bin's mean with the reflectance at every wavelength.
std::vector<Spectrum> covariances_with(const SpectralBins& bins) {
  std::vector<Spectrum> all;
  for (const Spectrum& weights : bins.weights) {
    Spectrum one = even_spectrum(0);
    for (size_t k = 0; k < spectrum_size; k++) {
      if (weights[k] == 0) continue;
      for (size_t i = 0; i < spectrum_size; i++) one[i] += weights[k] * covariance(i, k);
    }
    all.push_back(one);
  }
  return all;
}

void add_multiple(double factor, const Spectrum& of, Spectrum& to) {
  for (size_t w = 0; w < spectrum_size; w++) to[w] += factor * of[w];
}

// Solves a x = b for a symmetric positive definite matrix by Cholesky's factors.
std::vector<Spectrum> solve(std::vector<std::vector<double>> a, std::vector<Spectrum> b) {
  const size_t n = b.size();
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k <= i; k++) {
      for (size_t j = 0; j < k; j++) a[i][k] -= a[i][j] * a[k][j];
      a[i][k] = i == k ? std::sqrt(a[i][i]) : a[i][k] / a[k][k];
    }
    for (size_t j = 0; j < i; j++) add_multiple(-a[i][j], b[j], b[i]);
    for (double& one : b[i]) one /= a[i][i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t j = i + 1; j < n; j++) add_multiple(-a[j][i], b[j], b[i]);
    for (double& one : b[i]) one /= a[i][i];
  }
  return b;
}

// Returns the covariance of the bins' means, out of covariances_with().
std::vector<std::vector<double>> covariances_among(const SpectralBins& bins,
                                                   const std::vector<Spectrum>& with) {
  const size_t n = bins.count();
  std::vector<std::vector<double>> among(n, std::vector<double>(n, 0.0));
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < n; k++)
      for (size_t w = 0; w < spectrum_size; w++) among[i][k] += with[i][w] * bins.weights[k][w];
  return among;
}

std::vector<Spectrum> estimated_shapes(const SpectralBins& bins) {
  const std::vector<Spectrum> with = covariances_with(bins);
  std::vector<std::vector<double>> among = covariances_among(bins, with);
  for (size_t i = 0; i < among.size(); i++) among[i][i] += 1e-6;  // narrow end bins are nearly one
  return solve(std::move(among), with);
}

Spectrum even_shape(double low_nm, double high_nm) {
  Spectrum shape;
  for (size_t w = 0; w < spectrum_size; w++) shape[w] = share_between(nm_of(w), low_nm, high_nm);
  return shape;
}

}  // namespace

SpectralBins make_bins(int count, BinShapes shapes) {
  const double low = first_nm - 0.5, high = last_nm + 0.5;
  const WavelengthDensity density(low, high);
  SpectralBins bins;
  for (int i = 0; i < count; i++)
    bins.edges_nm.push_back(i == 0 ? low : density.quantile(double(i) / double(count)));
  bins.edges_nm.push_back(high);
  for (size_t i = 0; i < size_t(count); i++) {
    const Spectrum shape = even_shape(bins.edges_nm[i], bins.edges_nm[i + 1]);
    Spectrum weights;
    double sum = 0;
    for (size_t w = 0; w < spectrum_size; w++)
      sum += weights[w] = shape[w] * (sum_of(matching_functions()[w]) + least_response);
    for (double& weight : weights) weight /= sum;
    bins.weights.push_back(weights);
    bins.shapes.push_back(shape);
  }
  if (shapes == BinShapes::estimated) bins.shapes = estimated_shapes(bins);
  return bins;
}

std::vector<double> bin_means(const SpectralBins& bins, const Spectrum& reflectance) {
  std::vector<double> means(bins.count(), 0.0);
  for (size_t i = 0; i < means.size(); i++)
    for (size_t w = 0; w < spectrum_size; w++) means[i] += bins.weights[i][w] * reflectance[w];
  return means;
}

std::vector<dvec3> lamp_matrix(const SpectralBins& bins, const Spectrum& power) {
  const LampObserver lamp(power);
  std::vector<dvec3> matrix;
  dvec3 white(0);
  for (const Spectrum& shape : bins.shapes) {
    matrix.push_back(lamp.xyz(shape));
    white += matrix.back();
  }
  for (dvec3& one : matrix) one *= lamp.white() / white;
  return matrix;
}

std::vector<dvec3> color_means(const SpectralBins& bins) {
  const size_t n = bins.count();
  std::vector<dvec3> colors;  // each bin adds so much to red, green and blue
  dvec3 white(0);
  for (const dvec3& xyz : lamp_matrix(bins, find_lamp("D65")->power))
    white += colors.emplace_back(rgb_of(xyz));
  for (dvec3& color : colors) color /= white;
  const auto among = covariances_among(bins, covariances_with(bins));
  std::vector<dvec3> with(n, dvec3(0));  // covariance of a bin's mean with each channel
  glm::dmat3 channels(0);
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < n; k++) with[i] += among[i][k] * colors[k];
    channels += glm::outerProduct(colors[i], with[i]);
  }
  // White is taken apart first, so that it is exact; the estimate is for the rest.
  const glm::dmat3 estimate = glm::inverse(channels),
                   rest = glm::dmat3(1) - glm::outerProduct(dvec3(1), dvec3(1.0 / 3));
  std::vector<dvec3> means;
  for (size_t i = 0; i < n; i++)
    means.push_back(dvec3(1.0 / 3) + glm::transpose(estimate * rest) * with[i]);
  return means;
}

dvec3 xyz_of_means(const std::vector<dvec3>& matrix, const std::vector<double>& means) {
  dvec3 sum(0);
  for (size_t i = 0; i < means.size(); i++) sum += means[i] * matrix[i];
  return sum;
}

}  // namespace wellspring::spectrum
