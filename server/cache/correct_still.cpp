// SPDX-License-Identifier: Apache-2.0
#include "cache/correct_still.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "cache/lanes.h"
#include "cache/packing.h"

namespace wellspring {
namespace {

constexpr int block =
    4;  // pixels a side over which a sample's variance is pooled, and 3x3 of those
constexpr float guessed =
    8;  // samples that the picture's own relation of variance to light is worth
constexpr float placed =
    0.1f;  // of the square of what neighbours differ by: of where in it a pixel is seen
constexpr float unsure = 3;      // samples
constexpr float least_variance = 1e-8f;
constexpr float third = 1 / 3.0f;
// Noise of what a square differs by from the next scale: 1 - 2 * 9/64 + (9/16)^2/4 + ..., with
// bilinear weights between the larger squares.
constexpr float detail_noise = 0.8164f;
// Of pixels single means tell, of squares many: how many times the noise counts. One sample more is
// assumed to be as unlike as all were, since of few a bright one may be missing.
constexpr float pixel_doubt = 0.8, square_doubt = 0.35;
// Second and later samples of a pixel, of the whole picture's mean, from which on and at which in
// full they correct it: what first samples deviate by nobody knows.
constexpr float first_repeats = 0.5f, enough_repeats = 1.5f;
constexpr int band = 16;  // rows done by one thread

// A row of sums at the finest scale, or of a level.
struct Row {
  std::vector<float> sum[3], weight, noise;
  void resize(int width) {
    for (auto& s : sum) s.resize(size_t(width));
    weight.resize(size_t(width)), noise.resize(size_t(width));
  }
};

float square_mean(vec3 v) { return dot(v, v) * third; }

// How one sample's variance relates to the square of the light in all of the picture, and how many
// second and later samples a pixel has.
struct Known {
  float relative = 1, repeats = 0;
};
// Sums over each block of what its pixels know of one sample's variance.
Known pool_spread(const StillSamples& samples, const Frame& frame, StillCorrection& work) {
  int width = frame.width, height = frame.height;
  work.columns = (width + block - 1) / block, work.rows = (height + block - 1) / block;
  size_t blocks = size_t(work.columns) * size_t(work.rows);
  for (auto* plane : {&work.block_spread, &work.block_samples, &work.spread, &work.samples})
    plane->resize(blocks);
  std::vector<double> spread(size_t(work.rows), 0), light(size_t(work.rows), 0),
      repeats(size_t(work.rows), 0);
  parallel_ranges(work.rows, 4, [&](int begin, int end) {
    for (int by = begin; by < end; by++)
      for (int bx = 0; bx < work.columns; bx++) {
        float sum = 0, count = 0, bright = 0;
        for (int y = by * block; y < std::min((by + 1) * block, height); y++)
          for (int x = bx * block; x < std::min((bx + 1) * block, width); x++) {
            size_t i = size_t(y) * size_t(width) + size_t(x);
            float more = float(std::max(int(samples.count[i]) - 1, 0));
            float deviation = unpack_deviation(samples.deviation[i]);
            sum += more * deviation * deviation, count += more;
            bright += more * std::min(square_mean(frame.color[i]), 1.0f);
          }
        size_t b = size_t(by) * size_t(work.columns) + size_t(bx);
        work.block_spread[b] = sum, work.block_samples[b] = count;
        spread[size_t(by)] += double(std::min(sum, count)), light[size_t(by)] += double(bright);
        repeats[size_t(by)] += double(count);
      }
  });
  auto over_nine = [&](const std::vector<float>& from, std::vector<float>& to) {
    parallel_ranges(work.rows, 8, [&](int begin, int end) {
      for (int by = begin; by < end; by++)
        for (int bx = 0; bx < work.columns; bx++) {
          float sum = 0;
          for (int v = std::max(by - 1, 0); v <= std::min(by + 1, work.rows - 1); v++)
            for (int u = std::max(bx - 1, 0); u <= std::min(bx + 1, work.columns - 1); u++)
              sum += from[size_t(v) * size_t(work.columns) + size_t(u)];
          to[size_t(by) * size_t(work.columns) + size_t(bx)] = sum;
        }
    });
  };
  over_nine(work.block_spread, work.spread);
  over_nine(work.block_samples, work.samples);
  double all_spread = 0, all_light = 0, all_repeats = 0;
  for (size_t i = 0; i < spread.size(); i++)
    all_spread += spread[i], all_light += light[i], all_repeats += repeats[i];
  return {all_light > 0 ? float(all_spread / all_light) : 1.0f,
          float(all_repeats / (double(width) * double(height)))};
}

// Reads rows of the picture, of which the last three are kept, for those above and below.
class Residuals {
 public:
  Residuals(const StillSamples& samples, const StillImage& still, const StillCorrection& work,
            float relative, const Frame& frame)
      : samples_(samples), still_(still), work_(work), relative_(relative), frame_(frame) {}

  void read(int y, Row& row) {
    int width = frame_.width;
    row.resize(width);
    for (int v = y - 1; v <= y + 1; v++) measure(std::clamp(v, 0, frame_.height - 1));
    find_range(light(y - 1), light(y), light(y + 1));
    unpack(y);
    const float *own = light(y), *range = range_.data(), *spread = spread_.data(),
                *samples = samples_near_.data(), *count = count_.data(),
                *deviation = deviation_.data();
    float *weight = row.weight.data(), *noise = row.noise.data(), relative = relative_;
    for (int x = 0; x < width; x++) {
      float variance = (spread[x] + guessed * relative * own[x] * own[x]) / (samples[x] + guessed) +
                       placed * range[x] * range[x] + least_variance;
      float n = count[x], some = std::max(n, 1.0f);
      // Around the picture, not around the mean: of few samples none is sure of what it says
      // (self-normalised).
      float told = deviation[x] * deviation[x] * (some - 1) / some + square_[size_t(x)];
      weight[x] = n / variance;
      noise[x] = weight[x] * std::max(told / variance, 1.0f) * (1 + unsure / some);
    }
    for (int c = 0; c < 3; c++) {
      float* sum = row.sum[c].data();
      const float* residual = residual_[c].data();
      for (int x = 0; x < width; x++) sum[x] = weight[x] * residual[x];
    }
  }

 private:
  const float* light(int y) const { return lines_[std::clamp(y, 0, frame_.height - 1) % 3].data(); }
  void measure(int y) {
    if (held_[y % 3] == y) return;
    held_[y % 3] = y;
    std::vector<float>& line = lines_[y % 3];
    line.resize(size_t(frame_.width));
    const vec3* from = frame_.color.data() + size_t(y) * size_t(frame_.width);
    for (size_t x = 0; x < line.size(); x++) line[x] = std::sqrt(square_mean(from[x]));
  }
  // By how much the picture differs among the pixels around each.
  void find_range(const float* above, const float* row, const float* below) {
    int width = frame_.width;
    for (auto* line : {&low_, &high_, &range_}) line->resize(size_t(width) + 2);
    float *low = low_.data() + 1, *high = high_.data() + 1, *range = range_.data();
    for (int x = 0; x < width; x++) {
      low[x] = std::min(std::min(above[x], below[x]), row[x]);
      high[x] = std::max(std::max(above[x], below[x]), row[x]);
    }
    low[-1] = low[0], high[-1] = high[0], low[width] = low[width - 1],
    high[width] = high[width - 1];
    for (int x = 0; x < width; x++)
      range[x] = std::max(std::max(high[x - 1], high[x + 1]), high[x]) -
                 std::min(std::min(low[x - 1], low[x + 1]), low[x]);
  }
  // What is stored of a row, in arrays of their own.
  void unpack(int y) {
    int width = frame_.width, wide = (width + lanes - 1) / lanes * lanes;
    for (auto* line : {&spread_, &samples_near_, &count_, &deviation_, &square_, &residual_[0],
                       &residual_[1], &residual_[2]})
      line->resize(size_t(wide));
    size_t start = size_t(y) * size_t(width), blocks = size_t(y / block) * size_t(work_.columns);
    for (int b = 0; b < wide / block; b++) {
      size_t from = blocks + size_t(std::min(b, work_.columns - 1));
      std::fill_n(&spread_[size_t(b * block)], block, work_.spread[from]);
      std::fill_n(&samples_near_[size_t(b * block)], block, work_.samples[from]);
    }
    for (int x = 0; x < width; x += lanes) {
      uint32_t words[lanes] = {}, deviations[lanes] = {}, counts[lanes] = {};
      float color[3][lanes] = {};
      int here = std::min(lanes, width - x);
      for (int k = 0; k < here; k++) {
        size_t i = start + size_t(x + k);
        words[k] = samples_.mean[i], deviations[k] = samples_.deviation[i];
        counts[k] = samples_.count[i] & (0u - uint32_t((still_.count[i] & ~still_fresh) != 0));
        for (int c = 0; c < 3; c++) color[c][k] = frame_.color[i][c];
      }
      f8 mean[3], square{}, brightest{}, brightest_drawn{};
      unpack_rgb9e5(load<u8>(words), mean[0], mean[1], mean[2]);
      for (int c = 0; c < 3; c++) {
        f8 drawn = load<f8>(color[c]), residual = mean[c] - drawn;
        brightest = larger(brightest, mean[c]), brightest_drawn = larger(brightest_drawn, drawn);
        square += residual * residual;
        store(&residual_[size_t(c)][size_t(x)], residual);
      }
      // Beyond white differences are not seen, and samples are bounded.
      i8 seen = smaller(brightest, brightest_drawn) <= 1.0f;
      store(&square_[size_t(x)], square * third);
      store(&deviation_[size_t(x)], unpack_deviation(load<u8>(deviations)));
      store(&count_[size_t(x)], keep(seen, to_float(load<u8>(counts))));
    }
  }
  const StillSamples& samples_;
  const StillImage& still_;
  const StillCorrection& work_;
  float relative_;
  const Frame& frame_;
  std::vector<float> lines_[3], low_, high_, range_;
  std::vector<float> spread_, samples_near_, count_, deviation_, square_, residual_[3];
  int held_[3] = {-1, -1, -1};
};

void start_level(int width, int height, ResidualLevel& level) {
  level.width = (width + 1) / 2, level.height = (height + 1) / 2;
  size_t count = size_t(level.width) * size_t(level.height);
  for (auto* planes : {&level.sum, &level.added})
    for (auto& plane : *planes) plane.resize(count);
  level.weight.resize(count), level.noise.resize(count);
}

// Adds up pairs of two rows (the second may be null) of `width`.
void add_squares(const float* above, const float* below, int width, float* to) {
  for (int x = 0; x < width / 2; x++) {
    to[x] = above[2 * x] + above[2 * x + 1];
    if (below) to[x] += below[2 * x] + below[2 * x + 1];
  }
  if (width % 2) to[width / 2] = above[width - 1] + (below ? below[width - 1] : 0);
}

template <class Level>
void for_planes(Level& level, const auto& body) {
  for (int c = 0; c < 3; c++) body(level.sum[size_t(c)], c);
  body(level.weight, 3);
  body(level.noise, 4);
}

// Row `y` at twice the resolution, bilinear between the squares' centres.
void enlarge(const std::vector<float>& from, int columns, int rows, int y, int width, float* to) {
  int near = y / 2, far = std::clamp(near + (y % 2 ? 1 : -1), 0, rows - 1);
  const float *a = from.data() + size_t(near) * size_t(columns),
              *b = from.data() + size_t(far) * size_t(columns);
  auto at = [&](int x) { return 0.75f * a[x] + 0.25f * b[x]; };
  float before = at(0), here = before;
  for (int x = 0; x < columns; x++) {
    float after = at(std::min(x + 1, columns - 1));
    to[2 * x] = 0.75f * here + 0.25f * before;
    if (2 * x + 1 < width) to[2 * x + 1] = 0.75f * here + 0.25f * after;
    before = here, here = after;
  }
}

// What a scale's means differ by from those of the next, and by how much more than their noise.
struct Detail {
  std::vector<float> part[3], added[3], power, larger[4];
  void resize(int width) {
    size_t count = size_t(width) + 1;
    for (auto& p : part) p.resize(count);
    for (auto& a : added) a.resize(count);
    for (auto& l : larger) l.resize(count);
    power.resize(count);
  }
};
void find_detail(const float* const* row, const ResidualLevel& next, int y, int width, Detail& d) {
  d.resize(width);
  for (int c = 0; c < 3; c++) {
    enlarge(next.sum[size_t(c)], next.width, next.height, y, width, d.larger[c].data());
    enlarge(next.added[size_t(c)], next.width, next.height, y, width, d.added[c].data());
  }
  enlarge(next.weight, next.width, next.height, y, width, d.larger[3].data());
  std::fill(d.power.begin(), d.power.end(), 0.0f);
  const float *weight = row[3], *noise = row[4];
  for (int c = 0; c < 3; c++) {
    const float *sum = row[c], *wide = d.larger[c].data(), *wide_weight = d.larger[3].data();
    float *part = d.part[c].data(), *power = d.power.data(), *added = d.added[c].data();
    for (int x = 0; x < width; x++) {
      float per_weight = 1 / std::max(wide_weight[x], 1e-30f);
      float own = keep_if(weight[x] > 0, sum[x] / weight[x]), around = wide[x] * per_weight;
      added[x] *= per_weight;
      part[x] = keep_if(weight[x] > 0, own - around);
      power[x] +=
          keep_if(weight[x] > 0, part[x] * part[x] * third * weight[x] * (weight[x] / noise[x]));
    }
  }
}

// Of the middle one of three rows: what is to be added.
void add_detail(const Detail& above, const Detail& row, const Detail& below, int width, float doubt,
                std::vector<float>& column, float* const* to) {
  column.resize(size_t(width) + 2);
  for (int x = 0; x < width; x++)
    column[size_t(x) + 1] =
        0.25f * (above.power[size_t(x)] + below.power[size_t(x)]) + 0.5f * row.power[size_t(x)];
  column[0] = column[size_t(width) + 1] = 0;
  for (int x = 0; x < width; x++) {
    size_t i = size_t(x);
    float power = 0.25f * (column[i] + column[i + 2]) + 0.5f * column[i + 1];
    float share = std::max(0.0f, 1 - doubt * detail_noise / (power + 1e-12f));
    for (int c = 0; c < 3; c++) to[c][x] = row.added[c][i] + share * row.part[c][i];
  }
}

// read(y, Detail&) over the rows [begin, end) and those beside them; put(y, above, row, below) of
// each.
template <class Read, class Put>
void by_threes(int begin, int end, int height, int width, const Read& read, const Put& put) {
  Detail ring[3], none;
  none.resize(width);
  std::fill(none.power.begin(), none.power.end(), 0.0f);
  for (int y = begin - 1; y <= end; y++) {
    if (y >= 0 && y < height) read(y, ring[(y + 3) % 3]);
    int middle = y - 1;
    if (middle < begin) continue;
    put(middle, middle > 0 ? ring[(middle + 2) % 3] : none, ring[middle % 3],
        middle + 1 < height ? ring[(middle + 1) % 3] : none);
  }
}

void add_level(const ResidualLevel& next, ResidualLevel& level) {
  parallel_ranges(level.height, band, [&](int begin, int end) {
    std::vector<float> column;
    auto read = [&](int y, Detail& d) {
      size_t at = size_t(y) * size_t(level.width);
      const float* row[5];
      for_planes(level, [&](const auto& plane, int k) { row[k] = plane.data() + at; });
      find_detail(row, next, y, level.width, d);
    };
    by_threes(begin, end, level.height, level.width, read,
              [&](int y, const Detail& above, const Detail& row, const Detail& below) {
                float* to[3];
                size_t start = size_t(y) * size_t(level.width);
                for (size_t c = 0; c < 3; c++) to[c] = level.added[c].data() + start;
                add_detail(above, row, below, level.width, square_doubt, column, to);
                for (float* line : to)
                  for (int x = 0; x < level.width; x++) line[x] *= level.weight[start + size_t(x)];
              });
  });
}

// The largest squares have no others around.
void add_largest(ResidualLevel& level) {
  for (size_t i = 0; i < level.weight.size(); i++) {
    float weight = level.weight[i];
    vec3 mean =
        weight > 0 ? vec3(level.sum[0][i], level.sum[1][i], level.sum[2][i]) / weight : vec3(0);
    float power = weight > 0 ? square_mean(mean) * weight * (weight / level.noise[i]) : 0;
    float share = std::max(0.0f, 1 - square_doubt / (power + 1e-12f));
    for (size_t c = 0; c < 3; c++) level.added[c][i] = share * level.sum[c][i];
  }
}

}  // namespace

size_t memory_bytes(const StillCorrection& work) {
  size_t sum =
      bytes_of(work.block_spread, work.block_samples, work.spread, work.samples, work.color);
  for (const ResidualLevel& level : work.levels) {
    for (size_t c = 0; c < 3; c++) sum += bytes_of(level.sum[c], level.added[c]);
    sum += bytes_of(level.weight, level.noise);
  }
  return sum;
}

void correct_still(const StillSamples& samples, const StillImage& still, StillCorrection& work,
                   Frame& frame) {
  int width = frame.width, height = frame.height;
  size_t pixels = size_t(width) * size_t(height);
  if (pixels == 0 || samples.count.size() < pixels || still.count.size() < pixels) return;
  Known known = pool_spread(samples, frame, work);
  float relative = known.relative;
  float share = std::min((known.repeats - first_repeats) / (enough_repeats - first_repeats), 1.0f);
  if (share <= 0) return;
  for (size_t k = 0; k < work.levels.size(); k++)
    if (k == 0) start_level(width, height, work.levels[k]);
    else start_level(work.levels[k - 1].width, work.levels[k - 1].height, work.levels[k]);
  ResidualLevel& finest = work.levels[0];
  parallel_ranges(finest.height, band / 2, [&](int begin, int end) {
    Residuals residuals(samples, still, work, relative, frame);
    Row above, below;
    for (int y = begin; y < end; y++) {
      residuals.read(2 * y, above);
      bool two = 2 * y + 1 < height;
      if (two) residuals.read(2 * y + 1, below);
      const float* lines[2][5];
      for_planes(above, [&](const auto& plane, int k) { lines[0][k] = plane.data(); });
      for_planes(below,
                 [&](const auto& plane, int k) { lines[1][k] = two ? plane.data() : nullptr; });
      for_planes(finest, [&](auto& plane, int k) {
        add_squares(lines[0][k], lines[1][k], width,
                    plane.data() + size_t(y) * size_t(finest.width));
      });
    }
  });
  for (size_t k = 1; k < work.levels.size(); k++) {
    const ResidualLevel& fine = work.levels[k - 1];
    ResidualLevel& level = work.levels[k];
    const std::vector<float>* from[5];
    for_planes(fine, [&](const auto& plane, int p) { from[p] = &plane; });
    for_planes(level, [&](auto& plane, int p) {
      for (int y = 0; y < level.height; y++) {
        const float* above = from[p]->data() + size_t(2 * y) * size_t(fine.width);
        add_squares(above, 2 * y + 1 < fine.height ? above + fine.width : nullptr, fine.width,
                    plane.data() + size_t(y) * size_t(level.width));
      }
    });
  }
  add_largest(work.levels.back());
  for (size_t k = work.levels.size() - 1; k-- > 0;) add_level(work.levels[k + 1], work.levels[k]);
  // Bands read one another's rows, so the corrected ones lie elsewhere until all are done.
  work.color.resize(pixels);
  parallel_ranges(height, band, [&](int begin, int end) {
    Residuals residuals(samples, still, work, relative, frame);
    Row own;
    std::vector<float> column, added[3];
    for (auto& a : added) a.resize(size_t(width));
    float* to[3] = {added[0].data(), added[1].data(), added[2].data()};
    auto read = [&](int y, Detail& d) {
      residuals.read(y, own);
      const float* row[5];
      for_planes(own, [&](const auto& plane, int k) { row[k] = plane.data(); });
      find_detail(row, finest, y, width, d);
    };
    by_threes(begin, end, height, width, read,
              [&](int y, const Detail& above, const Detail& row, const Detail& below) {
                add_detail(above, row, below, width, pixel_doubt, column, to);
                size_t start = size_t(y) * size_t(width);
                for (size_t x = 0; x < size_t(width); x++) {
                  size_t i = start + x;
                  bool moves = (still.count[i] & ~still_fresh) == 0;
                  vec3 more = moves ? vec3(0) : share * vec3(to[0][x], to[1][x], to[2][x]);
                  work.color[i] = max(frame.color[i] + more, vec3(0));
                }
              });
  });
  std::swap(frame.color, work.color);
}

}  // namespace wellspring
