// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/codebook.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <string_view>
#include <unordered_set>

#include "base/parallel.h"
#include "base/rng.h"
#include "base/simd.h"
#include "base/worker.h"

namespace wellspring::volume {

namespace {

constexpr int rows_at_once = 6, panel_width = 2 * lane_count;
constexpr int rows_a_piece = 96;
constexpr int pieces_at_once = 32;  // between two looks whether the work is cancelled

// Returns the products of six rows with the sixteen codevectors of a panel, minus half their
// squares: the greatest one belongs to the nearest codevector.
inline void score_panel(Lanes (&score)[rows_at_once][2], const float* const (&row)[rows_at_once],
                        const float* panel, const float* halves, int dimensions) {
  Lanes sum[rows_at_once][2];
  for (int i = 0; i < rows_at_once; i++)
    sum[i][0] = -load_lanes(halves), sum[i][1] = -load_lanes(halves + lane_count);
  for (int d = 0; d < dimensions; d++) {
    const Lanes low = load_lanes(panel + d * panel_width),
                high = load_lanes(panel + d * panel_width + lane_count);
#pragma GCC unroll 6
    for (int i = 0; i < rows_at_once; i++) {
      const Lanes x = all_lanes(row[i][d]);
      sum[i][0] += x * low, sum[i][1] += x * high;
    }
  }
  std::memcpy(score, sum, sizeof sum);
}

struct BestLanes {
  Lanes score[2] = {all_lanes(-std::numeric_limits<float>::infinity()),
                    all_lanes(-std::numeric_limits<float>::infinity())};
  LaneMask panel[2] = {};

  void look_at(const Lanes (&other)[2], int number) {
    for (int i = 0; i < 2; i++) {
      const LaneMask better = other[i] > score[i];
      score[i] = better ? other[i] : score[i];
      panel[i] = better ? LaneMask{} + number : panel[i];
    }
  }
  int index() const {
    int best = -1;
    float most = 0;
    for (int lane = 0; lane < panel_width; lane++) {
      const float here = score[lane / lane_count][lane % lane_count];
      const int at = panel[lane / lane_count][lane % lane_count] * panel_width + lane;
      if (best < 0 || here > most || (here == most && at < best)) best = at, most = here;
    }
    return best;
  }
};

// Looks again among all codevectors if one nearer than `found` could have escaped by rounding.
int look_closely(const Codebook& codebook, const float* row, int found) {
  const int dimensions = codebook.dimensions;
  const auto vector = [&](int i) { return &codebook.vectors[size_t(i) * size_t(dimensions)]; };
  double least = squared_distance(row, vector(found), dimensions);
  if (least == 0) return found;
  if (least > 2e-6 * (least + 2 * double(codebook.halves[size_t(found)]))) return found;
  for (int i = 0; i < codebook.count; i++) {
    double sum = 0;
    for (int d = 0; d < dimensions && sum < least; d += 16)
      sum += squared_distance(row + d, vector(i) + d, 16);
    if (sum < least || (sum == least && i < found)) least = sum, found = i;
  }
  return found;
}

void find_nearest_all(std::vector<int>& nearest, const Codebook& codebook, const float* rows,
                      const std::function<void(double)>& progress) {
  const int count = int(nearest.size()), pieces = (count + rows_a_piece - 1) / rows_a_piece;
  for (int first = 0; first < pieces; first += pieces_at_once) {
    check_cancelled();
    parallel_each(std::min(pieces_at_once, pieces - first), [&](int i) {
      const int begin = (first + i) * rows_a_piece, end = std::min(begin + rows_a_piece, count);
      find_nearest(std::span(nearest).subspan(size_t(begin), size_t(end - begin)), codebook,
                   rows + size_t(begin) * size_t(codebook.dimensions));
    });
    if (progress) progress(double(first) / pieces);
  }
}

// Rows that are distinct from one another, in the order of `order`.
class DistinctRows {
 public:
  DistinctRows(const float* rows, int dimensions) : rows_(rows), dimensions_(dimensions) {}
  bool add(const float* row) {
    return seen_.insert({reinterpret_cast<const char*>(row), size_t(dimensions_) * sizeof(float)})
        .second;
  }
  bool add(int row) { return add(rows_ + size_t(row) * size_t(dimensions_)); }

 private:
  const float* rows_;
  int dimensions_;
  std::unordered_set<std::string_view> seen_;
};

}  // namespace

double squared_distance(const float* a, const float* b, int dimensions) {
  Lanes sum{};
  for (int d = 0; d < dimensions; d += lane_count) {
    const Lanes apart = load_lanes(a + d) - load_lanes(b + d);
    sum += apart * apart;
  }
  return double(lanes_sum(sum));
}

Codebook make_codebook(int dimensions, std::vector<float> vectors) {
  Codebook codebook;
  codebook.dimensions = dimensions;
  codebook.vectors = std::move(vectors);
  const size_t width = size_t(dimensions), count = codebook.vectors.size() / width;
  codebook.count = int(count);
  const size_t panels = (count + panel_width - 1) / panel_width;
  codebook.panels.assign(panels * width * panel_width, 0);
  codebook.halves.assign(panels * panel_width, std::numeric_limits<float>::infinity());
  for (size_t i = 0; i < count; i++) {
    double square = 0;
    for (size_t d = 0; d < width; d++) {
      const float x = codebook.vectors[i * width + d];
      codebook.panels[(i / panel_width * width + d) * panel_width + i % panel_width] = x;
      square += double(x) * double(x);
    }
    codebook.halves[i] = float(square / 2);
  }
  return codebook;
}

void find_nearest(std::span<int> nearest, const Codebook& codebook, const float* rows) {
  const int dimensions = codebook.dimensions, count = int(nearest.size());
  const int panels = int(codebook.halves.size()) / panel_width;
  for (int begin = 0; begin < count; begin += rows_a_piece) {
    const int end = std::min(begin + rows_a_piece, count);
    BestLanes best[rows_a_piece];
    for (int panel = 0; panel < panels; panel++)
      for (int first = begin; first < end; first += rows_at_once) {
        const float* row[rows_at_once];
        for (int i = 0; i < rows_at_once; i++)
          row[i] = rows + size_t(std::min(first + i, end - 1)) * size_t(dimensions);
        Lanes score[rows_at_once][2];
        score_panel(score, row, &codebook.panels[size_t(panel) * size_t(dimensions) * panel_width],
                    &codebook.halves[size_t(panel) * panel_width], dimensions);
        for (int i = 0; i < rows_at_once; i++) best[first - begin + i].look_at(score[i], panel);
      }
    for (int i = begin; i < end; i++)
      nearest[size_t(i)] =
          look_closely(codebook, rows + size_t(i) * size_t(dimensions), best[i - begin].index());
  }
}

std::vector<float> train_codebook(std::span<const float> rows, int dimensions,
                                  const TrainingSettings& settings,
                                  const std::function<void(double)>& progress) {
  const size_t width = size_t(dimensions), count = rows.size() / width;
  const auto row = [&](size_t i) { return rows.data() + i * width; };
  const size_t fixed = settings.first.empty() ? 0 : 1;
  std::vector<float> vectors = settings.first;
  {  // distinct rows at random
    std::vector<std::pair<uint64_t, int>> order(count);
    for (size_t i = 0; i < count; i++) order[i] = {mix64(mix64(settings.seed) ^ i), int(i)};
    std::ranges::sort(order);
    DistinctRows distinct(rows.data(), dimensions);
    if (fixed) distinct.add(settings.first.data());
    for (size_t i = 0; i < count && vectors.size() < size_t(settings.codevectors) * width; i++)
      if (distinct.add(order[i].second)) {
        const float* from = row(size_t(order[i].second));
        vectors.insert(vectors.end(), from, from + width);
      }
  }
  if (vectors.empty()) vectors.assign(width, 0);
  const size_t codevectors = vectors.size() / width;
  if (codevectors < size_t(settings.codevectors)) return vectors;  // each row has its own

  std::vector<int> nearest(count), members(count);
  std::vector<double> errors(count);
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < settings.most_rounds; round++) {
    const Codebook codebook = make_codebook(dimensions, vectors);
    find_nearest_all(nearest, codebook, rows.data(), [&](double part) {
      if (progress) progress((round + part) / settings.most_rounds);
    });
    parallel_ranges(int(count), 256, [&](int begin, int end) {
      for (size_t i = size_t(begin); i < size_t(end); i++)
        errors[i] =
            squared_distance(row(i), &codebook.vectors[size_t(nearest[i]) * width], dimensions);
    });
    const double error = std::accumulate(errors.begin(), errors.end(), 0.0);
    if (error == 0 || before - error < settings.least_gain * before) break;
    before = error;

    std::vector<int> start(codevectors + 1);  // members of codevector i begin at start[i]
    for (const int i : nearest) start[size_t(i) + 1]++;
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<int> next(start.begin(), start.end() - 1);
    for (size_t i = 0; i < count; i++) members[size_t(next[size_t(nearest[i])]++)] = int(i);
    std::vector<size_t> empty;
    for (size_t i = fixed; i < codevectors; i++)
      if (start[i] == start[i + 1]) empty.push_back(i);
    parallel_ranges(int(codevectors), 16, [&](int begin, int end) {
      std::vector<double> sum(width);
      for (size_t i = std::max(size_t(begin), fixed); i < size_t(end); i++) {
        if (start[i] == start[i + 1]) continue;
        std::ranges::fill(sum, 0);
        for (int m = start[i]; m < start[i + 1]; m++)
          for (size_t d = 0; d < width; d++) sum[d] += double(row(size_t(members[size_t(m)]))[d]);
        for (size_t d = 0; d < width; d++)
          vectors[i * width + d] = float(sum[d] / (start[i + 1] - start[i]));
      }
    });
    if (empty.empty()) continue;
    std::vector<int> worst(count);
    std::iota(worst.begin(), worst.end(), 0);
    std::ranges::sort(worst, [&](int a, int b) {
      const double first = errors[size_t(a)], second = errors[size_t(b)];
      return first != second ? first > second : a < b;
    });
    DistinctRows distinct(rows.data(), dimensions);
    size_t filled = 0;
    for (size_t i = 0; i < count && filled < empty.size() && errors[size_t(worst[i])] > 0; i++)
      if (distinct.add(worst[i]))
        std::copy_n(row(size_t(worst[i])), width, &vectors[empty[filled++] * width]);
  }
  return vectors;
}

}  // namespace wellspring::volume
