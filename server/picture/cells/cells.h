// SPDX-License-Identifier: Apache-2.0
// Cells are a quarter-resolution picture of surfaces and their light. Smooth light is filtered in
// it, edge-aware and guided by its variance (a-trous: Dammertz et al. 2010; variance: Schied et al.
// 2017), and holes of every size are filled from it by push and pull. A cell stands for one
// surface: the object most of its pixels see.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "picture/cells/surface_image.h"

namespace wellspring::picture {

inline constexpr int cell_size = 4;  // pixels a side
inline constexpr int cell_pad = 8;   // empty cells around, so that filters need no bounds
inline constexpr int cell_run = 8;   // cells read at once, maybe beyond the last row

// Holds planes of stride * (height + 2 * pad); cell (x, y) lies at index(x, y).
struct Cells {
  int width = 0, height = 0, stride = 0;
  std::array<std::span<float>, 3> albedo, rest, smooth;
  std::array<std::span<float>, 3> spare, rest_spare;  // the other side of the a-trous steps
  std::array<std::span<float>, 3> normal;             // world coordinates, unit
  // Inverse depth along the cell's plane is dot(plane, (ray x, ray y, 1)).
  std::array<std::span<float>, 3> plane;
  std::span<float> depth;    // depth of the plane at the cell's centre, metres
  std::span<float> samples;  // samples behind `smooth`; 0: no point fell here
  // Pixels averaged, without those whose light was forgotten; later the other side of rest_known.
  std::span<float> points;
  // Luminance moments of smooth over samples; later the variance of its mean, and the other side of
  // that.
  std::span<float> sum, sum2;
  // Pairs of neighbouring pixels that both have a point: their number, and the sum of the variances
  // of one sample that the differences of their smooth light show.
  std::span<float> pairs, pair_sum;
  std::span<float> prior_weight;  // samples a pixel needs before its own light counts for half
  // `rest` is sharp where it repeats itself and noise where it does not (glossy reflections).
  std::span<float> rest_sum;    // sum of its luminance over samples
  std::span<float> rest_sum2;   // second moment likewise; then variance of its detail
  std::span<float> rest_noise;  // sum of known variances of one sample; then variance of one sample
  std::span<float> rest_known;  // points with a known variance; then variance of the cell's mean
  std::span<uint32_t> object;   // no_object: nothing known here
  // Sums over nine cells, while variances are estimated: samples, points, sum, sum2, rest_sum,
  // rest_sum2, rest_noise, rest_known, pairs and pair_sum.
  std::array<std::span<float>, 10> pooled;
  int index(int x, int y) const { return (y + cell_pad) * stride + x + cell_pad; }
};

size_t cells_bytes(int width, int height);
// Carves the planes out of `scratch` for a picture of this size and empties the padding around it.
void take_cells(Cells& cells, int width, int height, Scratch& scratch);
// Overwrites row cy of the cells with the means over the pixels that see each cell's object. `rows`
// hold the rows of the picture that it covers.
void build_cells(const WindowView& view, const SurfaceRows& rows, int cy, Cells& cells);
// Fills cells that know nothing with what their surroundings know, the nearer the better; their
// samples stay 0. Returns false if nothing is known anywhere.
bool fill_cells(const WindowView& view, Cells& cells);
// Filters smooth light and the noisy part of the rest as widely as their noise asks for, never
// across objects, creases or steps; cells weigh as much as their samples, so that filled ones take
// and do not give (normalised convolution: Knutsson and Westin 1993).
void filter_cells(const WindowView& view, Cells& cells);

}  // namespace wellspring::picture
