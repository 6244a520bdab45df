// SPDX-License-Identifier: Apache-2.0
#include "store/painting/brush.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/rng.h"
#include "base/simd.h"

namespace wellspring::store {

namespace {

constexpr int stroke_passes = 2;      // strokes that cover a place, about
constexpr float octave_step = 3;      // how much larger the strokes of the next octave are
constexpr float octave_share = 0.8f;  // how much of the last octave's strength it has
constexpr float least_width = 2, full_width = 5;  // texels; strokes fade in between

struct Stroke {
  vec2 middle, along;  // texels of the window; a direction
  float half_length, half_width;
  float tone, warmth, relief, smear, bristle, phase;
};

// Returns a wave of triangles from -1 to 1 with a period of 1; x must not be negative.
Lanes triangle_wave(Lanes x) {
  const Lanes part = x - __builtin_convertvector(__builtin_convertvector(x, LaneMask), Lanes);
  return 4 * lanes_abs(part - 0.5f) - 1;
}

void blend_lanes(float* to, Lanes value, Lanes cover) {
  const Lanes old = load_lanes(to);
  store_lanes(to, old + cover * (value - old));
}

// Puts a stroke over what is there, within a part of the field.
void lay_stroke(StrokeField& field, const Stroke& stroke, ivec2 low, ivec2 high) {
  const vec2 along = stroke.along, across(-along.y, along.x);
  const float reach_x = std::abs(along.x) * stroke.half_length +
                        std::abs(across.x) * stroke.half_width + 1,
              reach_y = std::abs(along.y) * stroke.half_length +
                        std::abs(across.y) * stroke.half_width + 1;
  const auto clamped = [](float x, int least, int most) {
    return int(std::clamp(x, float(least), float(most)));
  };
  const int top = clamped(stroke.middle.y - reach_y, low.y, high.y + 1),
            bottom = clamped(stroke.middle.y + reach_y + 1, low.y, high.y + 1);
  const float soft = std::min(stroke.half_width, 1.f) + 0.15f * stroke.half_width;
  const float by_soft = 1 / soft, by_end = 1 / (soft + 0.05f * stroke.half_length);
  const float by_width = 1 / stroke.half_width, pull_by = -stroke.smear / stroke.half_length;
  const Lanes steps{0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f};
  for (int y = top; y < bottom; y++) {
    // Narrows the row to what lies within the stroke's sides and ends.
    const float dy = float(y) + 0.5f - stroke.middle.y;
    float begin = -reach_x, end = reach_x;
    const auto narrow = [&](float slope, float offset, float most) {
      if (std::abs(slope) < 1e-5f) return;
      const float a = (-most - offset) / slope, b = (most - offset) / slope;
      begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
    };
    narrow(along.x, dy * along.y, stroke.half_length);
    narrow(across.x, dy * across.y, stroke.half_width);
    const int left = clamped(stroke.middle.x + begin, low.x, high.x + 1) / lane_count * lane_count,
              right = clamped(stroke.middle.x + end + 1, low.x, high.x + 1);
    for (int x = left; x < right; x += lane_count) {
      const Lanes dx = float(x) - stroke.middle.x + steps;
      const Lanes s = dx * along.x + dy * along.y, t = dx * across.x + dy * across.y;
      const Lanes side = t * by_width + (8 + stroke.phase);
      const Lanes hair = 0.6f * triangle_wave(3.1f * side) + 0.4f * triangle_wave(7.7f * side);
      // Bristles leave the canvas one after another.
      const Lanes tip = (stroke.half_length * (0.85f + 0.15f * hair) - lanes_abs(s)) * by_end;
      const Lanes edge = lanes_min((stroke.half_width - lanes_abs(t)) * by_soft, tip);
      const Lanes cover = lanes_min(positive_lanes(edge), all_lanes(1));
      const Lanes ridge = 1 - 0.25f * lanes_min(edge, all_lanes(2));
      const size_t i = field.at(x, y);
      blend_lanes(&field.tone[i], stroke.tone + stroke.bristle * hair, cover);
      blend_lanes(&field.warmth[i], all_lanes(stroke.warmth), cover);
      blend_lanes(&field.relief[i], stroke.relief * (ridge + 0.22f * hair), cover);
      const Lanes pull = pull_by * s;
      blend_lanes(&field.smear_x[i], pull * along.x, cover);
      blend_lanes(&field.smear_y[i], pull * along.y, cover);
    }
  }
}

// Returns the direction of strokes at a place, in shares of the picture's width.
float direction_at(const PaintBrush& brush, uint64_t seed, dvec2 place, double picture) {
  double angle = brush.angle;
  if (brush.around) {
    const dvec2 arm = place - brush.middle;
    angle += std::atan2(arm.y, arm.x) + double(pi) / 2;
  }
  if (brush.turn > 0) {
    const double period = 8 * brush.length / picture;
    angle += brush.turn * double(smooth_noise(seed ^ 5, place.x / period, place.y / period));
  }
  return float(angle);
}

struct Octave {
  double width, length, cell;  // metres
  float strength;              // scales tone and warmth
  uint64_t seed;
};

// Tells where in a window a brush has painted: by blocks, and within which corners.
struct Painted {
  static constexpr int block = 8;  // texels a side
  ivec2 low{1 << 30}, high{-1};
  int columns = 0;
  std::vector<char> blocks;
  // Returns whether the brush painted anything near a place.
  bool is_near(vec2 place, float reach) const {
    const auto index = [](float x, int least, int most) {
      return int(std::clamp(x, float(least), float(most))) / block;
    };
    if (place.x + reach < float(low.x) || place.x - reach > float(high.x + 1) ||
        place.y + reach < float(low.y) || place.y - reach > float(high.y + 1))
      return false;
    const int left = index(place.x - reach, low.x, high.x),
              right = index(place.x + reach, low.x, high.x);
    for (int y = index(place.y - reach, low.y, high.y); y <= index(place.y + reach, low.y, high.y);
         y++)
      for (int x = left; x <= right; x++)
        if (blocks[size_t(y * columns + x)]) return true;
    return false;
  }
};

void lay_octave(StrokeField& field, const PaintBrush& brush, const Octave& octave,
                const StrokeWindow& window, const Painted& painted) {
  const ivec2 low = painted.low, high = painted.high;
  const float width = float(octave.width / window.texel);
  const float fade = std::clamp((width - least_width) / (full_width - least_width), 0.f, 1.f);
  const double cell = octave.cell / window.texel, reach = 0.5 * octave.length / window.texel + 2;
  const auto index = [&](double at) { return int64_t(std::floor(at / cell)); };
  for (int pass = 0; pass < stroke_passes; pass++) {
    const double offset = cell * pass / stroke_passes;
    const dvec2 origin = dvec2(window.left, window.top) - offset;
    for (int64_t row = index(origin.y + low.y - reach) - 1;
         row <= index(origin.y + high.y + reach) + 1; row++)
      for (int64_t column = index(origin.x + low.x - reach) - 1;
           column <= index(origin.x + high.x + reach) + 1; column++) {
        uint64_t bits =
            sample_seed(octave.seed + uint64_t(pass), uint32_t(column), uint32_t(row), 0);
        const auto chance = [&] {
          const float x = float(bits & 0xffff) * 0x1p-16f;
          bits = bits >> 16 | bits << 48;
          return x;
        };
        const float jitter_x = chance(), jitter_y = chance(), random = chance(), other = chance();
        const dvec2 at =
            cell * dvec2(double(column) + double(jitter_x), double(row) + double(jitter_y)) -
            origin;
        if (!painted.is_near(vec2(at), 0.65f * float(2 * reach))) continue;
        Stroke stroke;
        stroke.middle = vec2(at);
        const dvec2 place = (at + dvec2(window.left, window.top)) * window.texel / window.picture;
        const float angle =
            direction_at(brush, octave.seed, place, window.picture) + 0.35f * (other - 0.5f);
        stroke.along = vec2(std::cos(angle), std::sin(angle));
        const float size = 0.7f + 0.6f * float((mix64(bits) >> 40) & 255) / 255;
        stroke.half_width = 0.5f * width * size;
        stroke.half_length = 0.5f * float(octave.length / window.texel) * size;
        stroke.tone = fade * octave.strength * brush.tone * (2 * random - 1);
        stroke.warmth = fade * octave.strength * brush.warmth * (4 * std::abs(other - 0.5f) - 1);
        stroke.relief = fade * brush.impasto * width;
        stroke.bristle = fade * 0.38f * octave.strength * brush.tone;
        stroke.smear = fade * float(brush.smear / brush.octaves / window.texel);
        stroke.phase = 8 * jitter_x;
        lay_stroke(field, stroke, low, high);
      }
  }
}

}  // namespace

void StrokeField::resize(int new_width, int new_height) {
  width = new_width, height = new_height;
  stride = (width + lane_count - 1) / lane_count * lane_count;
  for (auto* one : {&tone, &warmth, &relief, &smear_x, &smear_y})
    one->assign(size_t(stride) * size_t(height), 0);
}

namespace {

// Returns where each brush has painted, by its number.
std::vector<Painted> find_painted(const StrokeField& field, const std::vector<uint8_t>& brushes) {
  std::vector<Painted> all(256);
  const int columns = (field.width + Painted::block - 1) / Painted::block,
            rows = (field.height + Painted::block - 1) / Painted::block;
  for (int y = 0; y < field.height; y++)
    for (int x = 0; x < field.width; x++) {
      Painted& one = all[brushes[size_t(y) * size_t(field.width) + size_t(x)]];
      if (one.high.x < 0) one.columns = columns, one.blocks.assign(size_t(columns * rows), 0);
      one.low = glm::min(one.low, ivec2(x, y)), one.high = glm::max(one.high, ivec2(x, y));
      one.blocks[size_t(y / Painted::block * columns + x / Painted::block)] = 1;
    }
  return all;
}

// Adds an octave to the texels of a brush, and leaves `octave` empty.
void take_octave(StrokeField& field, StrokeField& octave, const Painted& painted,
                 const std::vector<uint8_t>& brushes, int mine) {
  const auto arrays = [](StrokeField& one) {
    return std::array{one.tone.data(), one.warmth.data(), one.relief.data(), one.smear_x.data(),
                      one.smear_y.data()};
  };
  const auto to = arrays(field), from = arrays(octave);
  for (int y = painted.low.y; y <= painted.high.y; y++) {
    const uint8_t* brush = &brushes[size_t(y) * size_t(field.width)];
    const size_t row = field.at(0, y);
    for (size_t i = 0; i < to.size(); i++) {
      for (int x = painted.low.x; x <= painted.high.x; x++)
        to[i][row + size_t(x)] += brush[x] == mine ? from[i][row + size_t(x)] : 0.f;
      std::fill_n(from[i] + row, field.stride, 0.f);
    }
  }
}

}  // namespace

void add_strokes(StrokeField& field, const Painting& painting, const StrokeWindow& window,
                 const std::vector<uint8_t>& brushes) {
  const std::vector<Painted> all = find_painted(field, brushes);
  StrokeField octave_field;
  octave_field.resize(field.width, field.height);
  for (size_t i = 0; i < painting.brushes.size(); i++) {
    const Painted& painted = all[i + 1];
    if (painted.high.x < 0) continue;
    const PaintBrush& brush = painting.brushes[i];
    float strength = 1;
    double size = 1;
    for (int k = 0; k < brush.octaves; k++, size *= octave_step, strength *= octave_share) {
      const Octave octave{brush.width * size, brush.length * size,
                          0.85 * std::sqrt(brush.width * brush.length) * size, strength,
                          mix64(painting.seed ^ uint64_t(i + 1) << 8 ^ uint64_t(k) << 16)};
      if (octave.width / window.texel <= double(least_width)) continue;
      lay_octave(octave_field, brush, octave, window, painted);
      take_octave(field, octave_field, painted, brushes, int(i) + 1);
    }
  }
}

double longest_smear(const Painting& painting) {
  double longest = 0;
  for (const PaintBrush& brush : painting.brushes) longest = std::max(longest, brush.smear);
  return longest;
}

float smooth_noise(uint64_t seed, double x, double y) {
  const double left = std::floor(x), top = std::floor(y);
  const auto at = [&](int i, int k) {
    return float(2 * paint_chance(seed, int64_t(left) + i, int64_t(top) + k, 0) - 1);
  };
  const auto ease = [](double t) { return float(t * t * (3 - 2 * t)); };
  const float u = ease(x - left), v = ease(y - top);
  return std::lerp(std::lerp(at(0, 0), at(1, 0), u), std::lerp(at(0, 1), at(1, 1), u), v);
}

}  // namespace wellspring::store
