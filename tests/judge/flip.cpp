// SPDX-License-Identifier: Apache-2.0
#include "judge/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/parallel.h"

namespace wellspring::test {
namespace {

// Holds one number a pixel.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> value;
  Plane(int w, int h) : width(w), height(h), value(size_t(w) * size_t(h)) {}
  float* row(int y) { return value.data() + size_t(y) * size_t(width); }
  const float* row(int y) const { return value.data() + size_t(y) * size_t(width); }
};
// A picture in YCxCz, the linear opponent space the eye's filters are given in (section 4.1).
using Opponent = std::array<Plane, 3>;

// --- Colours ---------------------------------------------------------------------------------

// CIE XYZ of the sRGB primaries and of their white, D65.
constexpr float xyz_of_red[3] = {10135552.0f / 24577794, 2613072.0f / 12288897,
                                 1425312.0f / 73733382};
constexpr float xyz_of_green[3] = {8788810.0f / 24577794, 8788810.0f / 12288897,
                                   8788810.0f / 73733382};
constexpr float xyz_of_blue[3] = {4435075.0f / 24577794, 887015.0f / 12288897,
                                  70074185.0f / 73733382};
const mat3 rgb_to_xyz(xyz_of_red[0], xyz_of_red[1], xyz_of_red[2], xyz_of_green[0], xyz_of_green[1],
                      xyz_of_green[2], xyz_of_blue[0], xyz_of_blue[1], xyz_of_blue[2]);
const mat3 xyz_to_rgb = glm::inverse(rgb_to_xyz);
const vec3 white = rgb_to_xyz * vec3(1);

vec3 opponent_of(vec3 rgb) {
  vec3 c = rgb_to_xyz * rgb / white;
  return {116 * c.y - 16, 500 * (c.x - c.y), 200 * (c.y - c.z)};
}
vec3 rgb_of(vec3 opponent) {
  float y = (opponent.x + 16) / 116;
  return xyz_to_rgb * (vec3(y + opponent.y / 500, y, y - opponent.z / 200) * white);
}

// Returns L*a*b* with a and b shrunk in the dark, where colours are hard to tell (Hunt;
// section 4.1).
vec3 lab_of(vec3 rgb) {
  constexpr float delta = 6.0f / 29;
  vec3 c = rgb_to_xyz * rgb / white;
  for (int i = 0; i < 3; i++)
    c[i] = c[i] > delta * delta * delta ? std::cbrt(c[i]) : c[i] / (3 * delta * delta) + 4.0f / 29;
  float lightness = 116 * c.y - 16;
  return {lightness, 0.01f * lightness * 500 * (c.x - c.y), 0.01f * lightness * 200 * (c.y - c.z)};
}

// Returns the distance for large differences (Abasi, Tehran and Fairchild 2020).
float hyab(vec3 a, vec3 b) {
  vec3 d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// --- Filters ---------------------------------------------------------------------------------

// Holds taps from -radius to radius.
struct Kernel {
  std::vector<float> tap;
  int radius() const { return int(tap.size() / 2); }
};

template <class Shape>
Kernel make_kernel(int radius, const Shape& shape) {
  Kernel kernel;
  for (int i = -radius; i <= radius; i++) kernel.tap.push_back(shape(float(i)));
  return kernel;
}
void scale(Kernel& kernel, float by) {
  for (float& tap : kernel.tap) tap *= by;
}
float sum(const Kernel& kernel) {
  float total = 0;
  for (float tap : kernel.tap) total += tap;
  return total;
}
// Makes positive taps sum to 1 and negative ones to -1, so that a filter's answer lies within [-1,
// 1].
void balance(Kernel& kernel) {
  float positive = 0, negative = 0;
  for (float tap : kernel.tap) (tap > 0 ? positive : negative) += tap;
  for (float& tap : kernel.tap) tap /= tap > 0 ? positive : -negative;
}

// Filters with the product of a row's and a column's kernel, as all the filters are such products.
// The picture's edge pixels go on for ever.
Plane filter(const Plane& in, const Kernel& across, const Kernel& down) {
  Plane rows(in.width, in.height), out(in.width, in.height);
  parallel_ranges(in.height, 8, [&](int begin, int end) {
    int r = across.radius();
    std::vector<float> line(size_t(in.width + 2 * r));
    for (int y = begin; y < end; y++) {
      const float* from = in.row(y);
      std::fill(line.begin(), line.begin() + r, from[0]);
      std::copy(from, from + in.width, line.begin() + r);
      std::fill(line.end() - r, line.end(), from[in.width - 1]);
      float* to = rows.row(y);
      for (int i = 0; i <= 2 * r; i++)
        for (int x = 0; x < in.width; x++) to[x] += across.tap[size_t(i)] * line[size_t(x + i)];
    }
  });
  parallel_ranges(in.height, 8, [&](int begin, int end) {
    int r = down.radius();
    for (int y = begin; y < end; y++) {
      float* to = out.row(y);
      for (int i = -r; i <= r; i++) {
        const float* from = rows.row(std::clamp(y + i, 0, in.height - 1));
        for (int x = 0; x < in.width; x++) to[x] += down.tap[size_t(i + r)] * from[x];
      }
    }
  });
  return out;
}

// The eye's contrast sensitivity is a filter over the picture: a sum of two Gaussians a sqrt(pi /
// b) exp(-pi^2 x^2 / b), x in degrees (equations 2 and 3, table 1).
struct Sensitivity {
  float a[2], b[2];
};
constexpr Sensitivity sensitivities[3] = {
    {{1, 0}, {0.0047f, 1e-5f}}, {{1, 0}, {0.0053f, 1e-5f}}, {{34.1f, 13.5f}, {0.04f, 0.025f}}};

Plane blur_as_seen(const Plane& in, const Sensitivity& s, float pixels_per_degree) {
  constexpr float widest = 0.04f;
  int radius = int(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
  Kernel gaussian[2];
  float weight[2], volume = 0;
  for (int k = 0; k < 2; k++) {
    gaussian[k] = make_kernel(radius, [&](float i) {
      float x = i / pixels_per_degree;
      return std::exp(-pi * pi * x * x / s.b[k]);
    });
    float mass = sum(gaussian[k]);
    scale(gaussian[k], 1 / mass);
    weight[k] = s.a[k] * std::sqrt(pi / s.b[k]) * mass * mass;
    volume += weight[k];
  }
  Plane out = filter(in, gaussian[0], gaussian[0]);
  if (s.a[1] == 0) return out;
  Plane second = filter(in, gaussian[1], gaussian[1]);
  for (size_t i = 0; i < out.value.size(); i++)
    out.value[i] = (weight[0] * out.value[i] + weight[1] * second.value[i]) / volume;
  return out;
}

// --- The two pipelines -----------------------------------------------------------------------

constexpr float color_exponent = 0.7f;    // q_c
constexpr float cutoff = 0.4f;            // p_c: this share of the largest colour difference
constexpr float cutoff_error = 0.95f;     // p_t: is given this much of the error's range
constexpr float feature_width = 0.082f;   // w, degrees
constexpr float feature_exponent = 0.5f;  // q_f

Opponent make_opponent(const Image8& image) {
  std::array<float, 256> linear;
  for (int i = 0; i < 256; i++) {
    float c = float(i) / 255;
    linear[size_t(i)] = c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
  }
  Plane plane(image.width, image.height);
  Opponent out{plane, plane, plane};
  parallel_ranges(image.height, 16, [&](int begin, int end) {
    for (size_t i = size_t(begin) * size_t(image.width); i < size_t(end) * size_t(image.width);
         i++) {
      vec3 c = opponent_of(
          {linear[image.rgb[3 * i]], linear[image.rgb[3 * i + 1]], linear[image.rgb[3 * i + 2]]});
      for (size_t k = 0; k < 3; k++) out[k].value[i] = c[int(k)];
    }
  });
  return out;
}

// Returns colours as the eye makes them out at this distance, in Lab (section 4.1).
Opponent make_seen(const Opponent& picture, float pixels_per_degree) {
  Opponent seen{blur_as_seen(picture[0], sensitivities[0], pixels_per_degree),
                blur_as_seen(picture[1], sensitivities[1], pixels_per_degree),
                blur_as_seen(picture[2], sensitivities[2], pixels_per_degree)};
  parallel_ranges(int(seen[0].value.size()), 4096, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      vec3 rgb = rgb_of({seen[0].value[i], seen[1].value[i], seen[2].value[i]});
      vec3 lab = lab_of(glm::clamp(rgb, vec3(0), vec3(1)));
      for (size_t k = 0; k < 3; k++) seen[k].value[i] = lab[int(k)];
    }
  });
  return seen;
}

// Holds how much of an edge and of a point or line there is at each pixel (section 4.2).
struct Features {
  Plane edge, point;
};

Features make_features(const Plane& lightness, float pixels_per_degree) {
  float deviation = 0.5f * feature_width * pixels_per_degree;
  int radius = int(std::ceil(3 * deviation));
  auto gaussian = [&](float x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  Kernel across = make_kernel(radius, gaussian);
  scale(across, 1 / sum(across));
  Kernel first = make_kernel(radius, [&](float x) { return -x * gaussian(x); });
  Kernel second = make_kernel(
      radius, [&](float x) { return (x * x / (deviation * deviation) - 1) * gaussian(x); });
  balance(first);
  balance(second);
  Plane y = lightness;
  for (float& value : y.value) value = (value + 16) / 116;
  auto magnitude = [&](const Kernel& kernel) {
    Plane along = filter(y, kernel, across), up = filter(y, across, kernel);
    for (size_t i = 0; i < along.value.size(); i++)
      along.value[i] = std::sqrt(along.value[i] * along.value[i] + up.value[i] * up.value[i]);
    return along;
  };
  return {magnitude(first), magnitude(second)};
}

// Maps the colour difference to [0, 1]: differences beyond the cut-off are squeezed (equation 5).
float redistribute(float difference, float largest) {
  float knee = cutoff * largest;
  if (difference < knee) return difference * cutoff_error / knee;
  return cutoff_error + (difference - knee) / (largest - knee) * (1 - cutoff_error);
}

void check(const Image8& image) {
  if (image.width < 1 || image.height < 1 ||
      image.rgb.size() != 3 * size_t(image.width) * size_t(image.height))
    throw std::invalid_argument("flip: a picture is empty");
}

}  // namespace

FlipMap eval_flip(const Image8& test, const Image8& reference, const FlipSettings& settings) {
  check(test);
  check(reference);
  if (test.width != reference.width || test.height != reference.height)
    throw std::invalid_argument("flip: pictures differ in size");
  float density = settings.pixels_per_degree;
  if (!(density > 0) || density > 1000)
    throw std::invalid_argument("flip: between 0 and 1000 pixels a degree");
  Opponent a = make_opponent(test), b = make_opponent(reference);
  Features features_a = make_features(a[0], density), features_b = make_features(b[0], density);
  a = make_seen(a, density);
  b = make_seen(b, density);
  float largest = std::pow(hyab(lab_of(vec3(0, 1, 0)), lab_of(vec3(0, 0, 1))), color_exponent);
  FlipMap map{test.width, test.height, std::vector<float>(a[0].value.size()), 0};
  parallel_ranges(int(map.error.size()), 4096, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      float distance = hyab({a[0].value[i], a[1].value[i], a[2].value[i]},
                            {b[0].value[i], b[1].value[i], b[2].value[i]});
      float color = redistribute(std::pow(distance, color_exponent), largest);
      float feature = std::max(std::abs(features_a.edge.value[i] - features_b.edge.value[i]),
                               std::abs(features_a.point.value[i] - features_b.point.value[i]));
      feature = std::pow(feature / std::sqrt(2.0f), feature_exponent);
      map.error[i] = std::pow(std::clamp(color, 0.0f, 1.0f), 1 - std::clamp(feature, 0.0f, 1.0f));
    }
  });
  for (float error : map.error) map.mean += double(error);
  map.mean /= double(map.error.size());
  return map;
}

FlipMap eval_flip(const Frame& test, const Frame& reference, const Tonemap& display,
                  const FlipSettings& settings) {
  Image8 shown_test, shown_reference;
  tonemap(test, display, shown_test);
  tonemap(reference, display, shown_reference);
  return eval_flip(shown_test, shown_reference, settings);
}

double flip(const Frame& test, const Frame& reference, const Tonemap& display) {
  return eval_flip(test, reference, display).mean;
}

}  // namespace wellspring::test
