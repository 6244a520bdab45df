// SPDX-License-Identifier: Apache-2.0
#include "picture/still/correct_still.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "cache/packing.h"
#include "cache/packing_simd.h"
#include "frame/write_pixels.h"

namespace wellspring {
namespace {

constexpr int block =
    4;  // pixels a side over which a sample's variance is pooled, and 3x3 of those
constexpr float guessed =
    8;  // samples that the picture's own relation of variance to light is worth
constexpr float placed =
    0.1f;  // of the square of what neighbours differ by: of where in it a pixel is seen
constexpr float unsure = 3;  // samples
constexpr float least_variance = 1e-8f;
constexpr float third = 1 / 3.0f;
// Noise of what a square differs by from the next scale: 1 - 2 * 9/64 + (9/16)^2/4 + ..., with
// bilinear weights between the larger squares.
constexpr float detail_noise = 0.8164f;
// Of pixels single means tell, of squares many: how many times the noise counts. One sample more is
// assumed to be as unlike as all were, since of few a bright one may be missing.
constexpr float pixel_prior_variance = 0.8, squared_prior = 0.35;
// Second and later samples of a pixel, of the whole picture's mean, from which on and at which in
// full they correct it: what first samples deviate by nobody knows.
constexpr float first_repeats = 0.5f, enough_repeats = 1.5f;
constexpr int band = 16;  // rows done by one thread

// Rows are computed in whole lanes and have room for that.
size_t padded(int width) { return size_t((width + lane_count - 1) / lane_count * lane_count); }

// A row of sums at the finest scale, or of a level.
struct Row {
  std::vector<float> sum[3], weight, noise;
  void resize(int width) {
    for (auto& s : sum) s.resize(padded(width));
    weight.resize(padded(width)), noise.resize(padded(width));
  }
};

float square_mean(vec3 v) { return dot(v, v) * third; }
Lanes square_mean(const Lanes& r, const Lanes& g, const Lanes& b) {
  return (r * r + g * g + b * b) * third;
}

// Eight numbers in a plane of them, of which those from `count` on are beyond a row's end: 0.
template <class T>
LaneBits read_words(const T* from, int count) {
  T cut[lane_count] = {};
  if (count < lane_count) {
    std::memcpy(cut, from, size_t(count) * sizeof(T));
    from = cut;
  }
  if constexpr (sizeof(T) == 4) return load_lanes<LaneBits>(from);
#ifdef __AVX2__
  else
    return LaneBits(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from))));
#else
  else return LaneBits{from[0], from[1], from[2], from[3], from[4], from[5], from[6], from[7]};
#endif
}
void read_colors(const vec3* from, int count, Lanes (&color)[3]) {
  vec3 cut[lane_count] = {};
  if (count < lane_count) from = std::copy_n(from, count, cut) - count;
  deinterleave(&from->x, color[0], color[1], color[2]);
}

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
      for (int x = 0; x < width; x += lane_count) {
        int here = std::min(lane_count, width - x);
        Lanes sum{}, count{}, bright{};
        for (int y = by * block; y < std::min((by + 1) * block, height); y++) {
          size_t i = size_t(y) * size_t(width) + size_t(x);
          Lanes more = positive_lanes(to_float(read_words(&samples.count[i], here)) - 1.0f);
          Lanes deviation = unpack_deviation(read_words(&samples.deviation[i], here));
          Lanes color[3];
          read_colors(&frame.color[i], here, color);
          sum += more * deviation * deviation, count += more;
          bright += more * lanes_min(square_mean(color[0], color[1], color[2]), all_lanes(1));
        }
        for (int k = 0; k < here; k += block) {
          auto add_four = [k](const Lanes& v) { return (v[k] + v[k + 1]) + (v[k + 2] + v[k + 3]); };
          float own = add_four(sum), samples_here = add_four(count);
          size_t b = size_t(by) * size_t(work.columns) + size_t((x + k) / block);
          work.block_spread[b] = own, work.block_samples[b] = samples_here;
          spread[size_t(by)] += double(std::min(own, samples_here));
          light[size_t(by)] += double(add_four(bright));
          repeats[size_t(by)] += double(samples_here);
        }
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
    find_extremes(light(y - 1), light(y), light(y + 1));
    const float *low = low_.data() + 1, *high = high_.data() + 1, *own = light(y);
    size_t start = size_t(y) * size_t(width), blocks = size_t(y / block) * size_t(work_.columns);
    for (int x = 0; x < width; x += lane_count) {
      int here = std::min(lane_count, width - x);
      size_t i = start + size_t(x), left = blocks + size_t(x / block),
             right = std::min(left + 1, blocks + size_t(work_.columns) - 1);
      auto of_blocks = [&](const std::vector<float>& of) {
        float a = of[left], b = of[right];
        return Lanes{a, a, a, a, b, b, b, b};
      };
      auto around = [x](const float* of, auto choose) {
        return choose(choose(load_lanes(of + x - 1), load_lanes(of + x + 1)), load_lanes(of + x));
      };
      Lanes range = around(high, lanes_max) - around(low, lanes_min), lit = load_lanes(own + x);
      Lanes variance = (of_blocks(work_.spread) + guessed * relative_ * lit * lit) /
                           (of_blocks(work_.samples) + guessed) +
                       placed * range * range + least_variance;
      Lanes mean[3], residual[3], brightest{}, brightest_drawn{};
      unpack_rgb9e5(read_words(&samples_.mean[i], here), mean[0], mean[1], mean[2]);
      for (int c = 0; c < 3; c++) {
        Lanes drawn = load_lanes(&held(y).color[c][size_t(x)]);
        residual[c] = mean[c] - drawn;
        brightest = lanes_max(brightest, mean[c]),
        brightest_drawn = lanes_max(brightest_drawn, drawn);
      }
      // Beyond white differences are not seen, and samples are bounded.
      LaneMask seen = lanes_min(brightest, brightest_drawn) <= 1.0f;
      LaneMask rests = read_words(&still_.count[i], here) != 0u;
      Lanes n = keep_lanes(seen & rests, to_float(read_words(&samples_.count[i], here)));
      Lanes per_sample = 1.0f / lanes_max(n, all_lanes(1)), per_variance = 1.0f / variance;
      // Around the picture, not around the mean: of few samples none is sure of what it says
      // (self-normalised).
      Lanes deviation = unpack_deviation(read_words(&samples_.deviation[i], here));
      Lanes told = deviation * deviation * (1.0f - per_sample) +
                   square_mean(residual[0], residual[1], residual[2]);
      Lanes weight = n * per_variance;
      store_lanes(&row.weight[size_t(x)], weight);
      store_lanes(&row.noise[size_t(x)], weight * lanes_max(told * per_variance, all_lanes(1)) *
                                             (1.0f + unsure * per_sample));
      for (int c = 0; c < 3; c++) store_lanes(&row.sum[c][size_t(x)], weight * residual[c]);
    }
  }

 private:
  // A row of the picture: its light, and its colours in planes.
  struct Line {
    int y = -1;
    std::vector<float> light, color[3];
  };
  const Line& held(int y) const { return lines_[std::clamp(y, 0, frame_.height - 1) % 3]; }
  const float* light(int y) const { return held(y).light.data(); }
  void measure(int y) {
    Line& line = lines_[y % 3];
    if (line.y == y) return;
    line.y = y;
    int width = frame_.width;
    line.light.resize(padded(width));
    for (auto& plane : line.color) plane.resize(padded(width));
    const vec3* from = frame_.color.data() + size_t(y) * size_t(width);
    for (int x = 0; x < width; x += lane_count) {
      Lanes color[3];
      read_colors(from + x, std::min(lane_count, width - x), color);
      for (int c = 0; c < 3; c++) store_lanes(&line.color[c][size_t(x)], color[c]);
      store_lanes(&line.light[size_t(x)], lanes_sqrt(square_mean(color[0], color[1], color[2])));
    }
  }
  // The least and the most light of three rows at each column, and one column more on both sides.
  void find_extremes(const float* above, const float* row, const float* below) {
    int width = frame_.width;
    for (auto* line : {&low_, &high_}) line->resize(padded(width) + lane_count);
    float *low = low_.data() + 1, *high = high_.data() + 1;
    for (int x = 0; x < width; x += lane_count) {
      Lanes a = load_lanes(above + x), b = load_lanes(below + x), own = load_lanes(row + x);
      store_lanes(low + x, lanes_min(lanes_min(a, b), own));
      store_lanes(high + x, lanes_max(lanes_max(a, b), own));
    }
    low[-1] = low[0], high[-1] = high[0], low[width] = low[width - 1],
    high[width] = high[width - 1];
  }
  const StillSamples& samples_;
  const StillImage& still_;
  const StillCorrection& work_;
  float relative_;
  const Frame& frame_;
  Line lines_[3];
  std::vector<float> low_, high_;
};

void start_level(int width, int height, ResidualLevel& level) {
  level.width = (width + 1) / 2, level.height = (height + 1) / 2;
  size_t count = size_t(level.width) * size_t(level.height);
  for (auto* planes : {&level.sum, &level.added})
    for (auto& plane : *planes) plane.resize(count + lane_count);
  level.weight.resize(count + lane_count), level.noise.resize(count + lane_count);
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

// What a scale's means differ by from those of the next, and by how much more than their noise.
struct Detail {
  std::vector<float> part[3], added[3], power, larger[4], line;
  void resize(int width) {
    size_t count = padded(width) + 2 * lane_count;
    for (auto& p : part) p.resize(count);
    for (auto& a : added) a.resize(count);
    for (auto& l : larger) l.resize(count);
    power.resize(count), line.resize(count);
  }
};

// Row `y` at twice the resolution, bilinear between the squares' centres. `line` is scratch.
void enlarge(const std::vector<float>& from, int columns, int rows, int y, std::vector<float>& line,
             std::vector<float>& to) {
  int near = y / 2, far = std::clamp(near + (y % 2 ? 1 : -1), 0, rows - 1);
  const float *a = from.data() + size_t(near) * size_t(columns),
              *b = from.data() + size_t(far) * size_t(columns);
  float* middle = line.data() + 1;
  for (int x = 0; x < columns; x += lane_count)
    store_lanes(middle + x, 0.75f * load_lanes(a + x) + 0.25f * load_lanes(b + x));
  middle[-1] = middle[0], middle[columns] = middle[columns - 1];
  for (int x = 0; x < columns; x += lane_count) {
    Lanes here = 0.75f * load_lanes(middle + x), even = here + 0.25f * load_lanes(middle + x - 1),
          odd = here + 0.25f * load_lanes(middle + x + 1);
    store_lanes(&to[2 * size_t(x)], __builtin_shufflevector(even, odd, 0, 8, 1, 9, 2, 10, 3, 11));
    store_lanes(&to[2 * size_t(x) + lane_count],
                __builtin_shufflevector(even, odd, 4, 12, 5, 13, 6, 14, 7, 15));
  }
}

void find_detail(const float* const* row, const ResidualLevel& next, int y, int width, Detail& d) {
  d.resize(width);
  for (int c = 0; c < 3; c++) {
    enlarge(next.sum[size_t(c)], next.width, next.height, y, d.line, d.larger[c]);
    enlarge(next.added[size_t(c)], next.width, next.height, y, d.line, d.added[c]);
  }
  enlarge(next.weight, next.width, next.height, y, d.line, d.larger[3]);
  for (int x = 0; x < width; x += lane_count) {
    size_t i = size_t(x);
    Lanes weight = load_lanes(row[3] + x);
    LaneMask known = weight > 0.0f;
    Lanes own_share = 1.0f / (known ? weight : all_lanes(1)),
          share = 1.0f / lanes_max(load_lanes(&d.larger[3][i]), all_lanes(1e-30f)), power{};
    for (int c = 0; c < 3; c++) {
      Lanes part = keep_lanes(
          known, load_lanes(row[c] + x) * own_share - load_lanes(&d.larger[c][i]) * share);
      power += part * part;
      store_lanes(&d.part[c][i], part);
      store_lanes(&d.added[c][i], load_lanes(&d.added[c][i]) * share);
    }
    power *= third * weight * (weight / load_lanes(row[4] + x));
    store_lanes(&d.power[i], keep_lanes(known, power));
  }
}

// Of the middle one of three rows: what is to be added.
void add_detail(const Detail& above, const Detail& row, const Detail& below, int width,
                float prior_variance, std::vector<float>& column, float* const* to) {
  column.resize(size_t(width) + 2);
  for (int x = 0; x < width; x++)
    column[size_t(x) + 1] =
        0.25f * (above.power[size_t(x)] + below.power[size_t(x)]) + 0.5f * row.power[size_t(x)];
  column[0] = column[size_t(width) + 1] = 0;
  for (int x = 0; x < width; x++) {
    size_t i = size_t(x);
    float power = 0.25f * (column[i] + column[i + 2]) + 0.5f * column[i + 1];
    float share = std::max(0.0f, 1 - prior_variance * detail_noise / (power + 1e-12f));
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
                add_detail(above, row, below, level.width, squared_prior, column, to);
                for (float* line : to)
                  for (int x = 0; x < level.width; x++) line[x] *= level.weight[start + size_t(x)];
              });
  });
}

// The largest squares have no others around.
void add_largest(ResidualLevel& level) {
  for (size_t i = 0; i < size_t(level.width) * size_t(level.height); i++) {
    float weight = level.weight[i];
    vec3 mean =
        weight > 0 ? vec3(level.sum[0][i], level.sum[1][i], level.sum[2][i]) / weight : vec3(0);
    float power = weight > 0 ? square_mean(mean) * weight * (weight / level.noise[i]) : 0;
    float share = std::max(0.0f, 1 - squared_prior / (power + 1e-12f));
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
      parallel_ranges(level.height, 32, [&](int begin, int end) {
        for (int y = begin; y < end; y++) {
          const float* above = from[p]->data() + size_t(2 * y) * size_t(fine.width);
          add_squares(above, 2 * y + 1 < fine.height ? above + fine.width : nullptr, fine.width,
                      plane.data() + size_t(y) * size_t(level.width));
        }
      });
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
                add_detail(above, row, below, width, pixel_prior_variance, column, to);
                size_t start = size_t(y) * size_t(width);
                for (size_t x = 0; x < size_t(width); x++) {
                  size_t i = start + x;
                  bool moves = still.count[i] == 0;
                  vec3 more = moves ? vec3(0) : share * vec3(to[0][x], to[1][x], to[2][x]);
                  work.color[i] = max(frame.color[i] + more, vec3(0));
                }
              });
  });
  std::swap(frame.color, work.color);
}

}  // namespace wellspring
