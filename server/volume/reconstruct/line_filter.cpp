// SPDX-License-Identifier: Apache-2.0
#include "volume/reconstruct/line_filter.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "base/parallel.h"

namespace wellspring::volume {

namespace {

// Lines are filtered side by side, sample for sample.
constexpr int lines_together = 16;
using LineSamples = double[lines_together];

// Holds some lines of a grid: `in` and `out` have a row for each sample of a line.
struct LineBlock {
  explicit LineBlock(int length)
      : length(length), in(size_t(length)), out(size_t(length)), ratio(size_t(length)) {}
  struct Row {
    LineSamples line{};
  };
  int length;
  std::vector<Row> in, out;
  std::vector<double> ratio;
};

// Adds `weight` times the samples `distance` after each sample.
void add_tap(LineBlock& block, int distance, double weight) {
  for (int i = 0; i < block.length; i++) {
    const LineSamples& from = block.in[size_t(mirrored(i + distance, block.length))].line;
    LineSamples& to = block.out[size_t(i)].line;
    for (int l = 0; l < lines_together; l++) to[l] += weight * from[l];
  }
}

// Solves (c(k - 1) + 4 c(k) + c(k + 1)) / 6 = f(k) with mirrors at both ends, by elimination: all
// is as large as it needs to be, since 4 is more than 1 + 1.
void solve_spline(LineBlock& block) {
  const int last = block.length - 1;
  if (last == 0) return add_tap(block, 0, 1);
  for (int i = 0; i <= last; i++) {
    const double before = i == 0 ? 0 : i == last ? 2 : 1;
    const size_t previous = size_t(std::max(i - 1, 0)), here = size_t(i);
    const double inverse = 1 / (4 - before * block.ratio[previous]);
    block.ratio[here] = inverse * (i == 0 ? 2 : 1);
    for (int l = 0; l < lines_together; l++)
      block.out[here].line[l] =
          (6 * block.in[here].line[l] - before * block.out[previous].line[l]) * inverse;
  }
  for (int i = last - 1; i >= 0; i--)
    for (int l = 0; l < lines_together; l++)
      block.out[size_t(i)].line[l] -= block.ratio[size_t(i)] * block.out[size_t(i) + 1].line[l];
}

void filter_block(LineBlock& block, LineFilter filter) {
  std::fill(block.out.begin(), block.out.end(), LineBlock::Row{});
  std::fill(block.ratio.begin(), block.ratio.end(), 0.0);
  switch (filter) {
    case LineFilter::quasi_interpolating:
      for (int distance = -1; distance <= 1; distance++)
        add_tap(block, distance, distance == 0 ? 8.0 / 6 : -1.0 / 6);
      return;
    case LineFilter::interpolating: return solve_spline(block);
    case LineFilter::central_difference: add_tap(block, 1, 0.5), add_tap(block, -1, -0.5); return;
    case LineFilter::wide_difference:
      add_tap(block, 1, 5.0 / 6), add_tap(block, -1, -5.0 / 6);
      add_tap(block, 2, -1.0 / 6), add_tap(block, -2, 1.0 / 6);
      return;
  }
}

template <class Real>
Real nearest_finite(double value) {
  constexpr double largest = double(std::numeric_limits<Real>::max());
  return Real(std::clamp(value, -largest, largest));
}

}  // namespace

int mirrored(int index, int size) {
  if (size == 1) return 0;
  const int64_t period = 2 * (int64_t(size) - 1);
  const int64_t at = std::abs(int64_t(index)) % period;
  return int(std::min(at, period - at));
}

template <class Real>
void filter_axis(std::vector<Real>& values, glm::ivec3 size, int axis, LineFilter filter) {
  if (values.empty()) return;
  const size_t row = size_t(size.x), slice = row * size_t(size.y);
  const size_t strides[] = {1, row, slice};
  const size_t stride = strides[axis], lines = values.size() / size_t(size[axis]);
  // Returns where a line begins.
  auto begin_of = [&](size_t line) {
    if (axis == 0) return line * row;
    return axis == 1 ? line / row * slice + line % row : line;
  };
  const int blocks = int((lines + lines_together - 1) / lines_together);
  const int grain = 1 + (1 << 16) / (lines_together * size[axis]);
  parallel_ranges(blocks, grain, [&](int begin, int end) {
    LineBlock block(size[axis]);
    for (int b = begin; b < end; b++) {
      const size_t first = size_t(b) * lines_together;
      const int count = int(std::min<size_t>(lines_together, lines - first));
      size_t from[lines_together];
      for (int l = 0; l < count; l++) from[l] = begin_of(first + size_t(l));
      for (int i = 0; i < block.length; i++)
        for (int l = 0; l < count; l++)
          block.in[size_t(i)].line[l] = double(values[from[l] + size_t(i) * stride]);
      filter_block(block, filter);
      for (int i = 0; i < block.length; i++)
        for (int l = 0; l < count; l++)
          values[from[l] + size_t(i) * stride] = nearest_finite<Real>(block.out[size_t(i)].line[l]);
    }
  });
}

template void filter_axis(std::vector<float>&, glm::ivec3, int, LineFilter);
template void filter_axis(std::vector<double>&, glm::ivec3, int, LineFilter);

}  // namespace wellspring::volume
