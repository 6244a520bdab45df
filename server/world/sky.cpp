// SPDX-License-Identifier: Apache-2.0
#include "world/sky.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace wellspring::world {
namespace {

// Units are metres and inverse metres.
constexpr double earth = 6.36e6, top = 6.42e6;
constexpr double rayleigh_height = 8000, haze_height = 1200;
const dvec3 rayleigh(5.802e-6, 13.558e-6, 33.1e-6), ozone(0.650e-6, 1.881e-6, 0.085e-6);
const dvec3 haze_color(0.759, 1, 1.336);  // Angstrom exponent 1.3
constexpr double haze_albedo = 0.92, haze_forward = 0.76;
constexpr double sun_outside = 12.8;
constexpr double sun_radius = 0.53 / 2 * 3.14159265358979 / 180;
constexpr double ground_albedo = 0.2, eye_height = 2;
constexpr double pi_ = 3.14159265358979;

struct Air {
  dvec3 rayleigh{0}, haze{0};  // share scattered a metre
  dvec3 lost{0};
};

Air air_at(double height, double turbidity) {
  Air air;
  double h = std::max(height, 0.0);
  air.rayleigh = rayleigh * std::exp(-h / rayleigh_height);
  // Turbidity compares the whole columns at 550 nm.
  double haze = (turbidity - 1) * rayleigh.y * rayleigh_height / haze_height;
  dvec3 haze_lost = haze_color * (haze * std::exp(-h / haze_height));
  air.haze = haze_albedo * haze_lost;
  air.lost = air.rayleigh + haze_lost + ozone * std::max(0.0, 1 - std::abs(h - 25000) / 15000);
  return air;
}

// Returns the distance to a sphere about the Earth's centre from radius r along a direction of this
// cosine to the vertical; negative: it is not met ahead.
double to_sphere(double r, double cosine, double sphere) {
  double b = r * cosine, d = b * b - r * r + sphere * sphere;
  if (d < 0) return -1;
  double root = std::sqrt(d);
  return -b - root > 0 ? -b - root : -b + root;
}
bool meets_ground(double r, double cosine) {
  return cosine < 0 && r * r * (1 - cosine * cosine) < earth * earth;
}

// Holds the share of sunlight that arrives at a height, the sun under this cosine.
class SunTable {
 public:
  explicit SunTable(double turbidity) : values_(size_t(heights) * cosines) {
    parallel_for(heights, [&](int i) {
      double t = double(i) / (heights - 1), r = earth + t * t * (top - earth);
      for (int j = 0; j < cosines; j++)
        values_[size_t(i) * cosines + size_t(j)] = integrate(r, cosine_of(j), turbidity);
    });
  }
  dvec3 operator()(double r, double cosine) const {
    if (meets_ground(r, cosine)) return dvec3(0);
    double y = std::sqrt(std::clamp((r - earth) / (top - earth), 0.0, 1.0)) * (heights - 1);
    double x = std::clamp(std::cbrt(cosine) * 0.5 + 0.5, 0.0, 1.0) * (cosines - 1);
    int i = std::min(int(y), heights - 2), j = std::min(int(x), cosines - 2);
    auto at = [&](int a, int b) { return values_[size_t(a) * cosines + size_t(b)]; };
    dvec3 low = glm::mix(at(i, j), at(i, j + 1), x - j);
    return glm::mix(low, glm::mix(at(i + 1, j), at(i + 1, j + 1), x - j), y - i);
  }

 private:
  static constexpr int heights = 48, cosines = 257;
  std::vector<dvec3> values_;
  static double cosine_of(int j) {  // values are dense about the horizon
    double x = 2.0 * j / (cosines - 1) - 1;
    return x * x * x;
  }
  static dvec3 integrate(double r, double cosine, double turbidity) {
    constexpr int steps = 64;
    double length = to_sphere(r, cosine, top);
    dvec3 depth(0);
    for (int s = 0; s < steps; s++) {
      double t = (s + 0.5) / steps * length;
      double at = std::sqrt(r * r + t * t + 2 * r * t * cosine);
      depth += air_at(at - earth, turbidity).lost * (length / steps);
    }
    return glm::exp(-depth);
  }
};

double rayleigh_phase(double cosine) { return 3 / (16 * pi_) * (1 + cosine * cosine); }
// Returns the phase function of Henyey and Greenstein, as Cornette and Shanks made it physical
// (1992).
double haze_phase(double cosine) {
  double g = haze_forward, g2 = g * g;
  return 3 / (8 * pi_) * (1 - g2) * (1 + cosine * cosine) /
         ((2 + g2) * std::pow(1 + g2 - 2 * g * cosine, 1.5));
}

struct Atmosphere {
  double turbidity;
  dvec3 sun;  // towards the sun; y is up
  const SunTable& sunlight;
  static constexpr int levels = 24;
  // Light that has scattered more than once, the same from all sides, by height.
  dvec3 further[levels];

  Atmosphere(double turbidity_, dvec3 sun_, const SunTable& sunlight_)
      : turbidity(turbidity_), sun(sun_), sunlight(sunlight_) {
    std::fill(further, further + levels, dvec3(0));
    dvec3 series[levels];
    parallel_for(levels, [&](int i) { series[i] = sum_series(radius_of(i)); });
    std::copy(series, series + levels, further);
  }
  static double radius_of(int level) {
    double t = (level + 0.5) / levels;
    return earth + t * t * (top - earth);
  }
  dvec3 further_at(double r) const {
    double x = std::sqrt(std::clamp((r - earth) / (top - earth), 0.0, 1.0)) * levels - 0.5;
    x = std::clamp(x, 0.0, levels - 1.001);
    int i = int(x);
    return glm::mix(further[i], further[i + 1], x - i);
  }

  // Returns the light that scatters towards a place on `direction`; `once`: isotropic and without
  // `further`; `passed`: gets what scatters of light that is 1 everywhere.
  dvec3 gather(double r, dvec3 direction, int steps, bool once, dvec3* passed) const {
    bool ground = meets_ground(r, direction.y);
    double length = to_sphere(r, direction.y, ground ? earth : top);
    dvec3 arrives(0), through(1);
    double cosine = dot(direction, sun), before = 0;
    for (int s = 0; s < steps; s++) {
      double end = (s + 1.0) / steps, middle = (s + 0.5) / steps;
      double t = middle * middle * length, step = end * end * length - before;
      before = end * end * length;
      dvec3 place = dvec3(0, r, 0) + direction * t;
      double at = glm::length(place);
      Air air = air_at(at - earth, turbidity);
      dvec3 lit = sunlight(at, dot(place, sun) / at), all = air.rayleigh + air.haze;
      dvec3 scatters =
          once ? all * lit / (4 * pi_)
               : lit * (air.rayleigh * rayleigh_phase(cosine) + air.haze * haze_phase(cosine)) +
                     all * further_at(at);
      dvec3 kept = glm::exp(-air.lost * step);
      // The share counts the step as light thins out in it.
      dvec3 share = (1.0 - kept) / glm::max(air.lost, dvec3(1e-20));
      arrives += through * scatters * share;
      if (passed) *passed += through * all * share;
      through *= kept;
    }
    if (ground && once) {
      dvec3 place = dvec3(0, r, 0) + direction * length;
      double up = dot(place, sun) / glm::length(place);
      arrives += through * sunlight(earth + 1, up) * (std::max(0.0, up) * ground_albedo / pi_);
    }
    return arrives;
  }
  dvec3 sum_series(double r) const {
    constexpr int rows = 8, columns = 8;
    dvec3 second(0), passed(0);
    for (int i = 0; i < rows * columns; i++) {
      double y = 1 - 2 * (i / columns + 0.5) / rows, phi = 2 * pi_ * (i % columns + 0.5) / columns;
      double radius = std::sqrt(1 - y * y);
      dvec3 share(0);
      second += gather(r, {radius * std::cos(phi), y, radius * std::sin(phi)}, 24, true, &share);
      passed += share;
    }
    second /= double(rows * columns);
    passed /= double(rows * columns);
    return second / (1.0 - glm::min(passed, dvec3(0.99)));
  }
};

dvec3 towards_sun(const SkySettings& s) {
  double e = glm::radians(s.elevation), a = glm::radians(s.azimuth);
  return {std::sin(a) * std::cos(e), std::sin(e), -std::cos(a) * std::cos(e)};
}

// Returns the share of the sun's disc above the horizon.
double risen(double elevation) {
  double x = std::clamp(glm::radians(elevation) / sun_radius, -1.0, 1.0);
  return std::max(0.0, 0.5 + (x * std::sqrt(1 - x * x) + std::asin(x)) / pi_);
}

dvec3 sun_irradiance(const SkySettings& s, const SunTable& sunlight) {
  // The part of a setting sun that is left above the horizon is seen just above it.
  double cosine = std::max(std::sin(glm::radians(s.elevation)), 1e-4);
  return sunlight(earth + eye_height, cosine) * (sun_outside * s.strength * risen(s.elevation));
}

}  // namespace

const char* sky_problem(const SkySettings& s) {
  if (!(s.elevation >= -18 && s.elevation <= 90))
    return "elevation: degrees from -18 to 90 expected";
  if (!(std::abs(s.azimuth) <= 360)) return "azimuth: degrees from -360 to 360 expected";
  if (!(s.turbidity >= 1 && s.turbidity <= 10))
    return "turbidity: from 1 (pure air) to 10 expected";
  if (!(s.strength >= 0 && s.strength <= 1e6)) return "strength: from 0 to 1000000 expected";
  return nullptr;
}

std::vector<Daylight> eval_daylight(const SkySettings& settings,
                                    std::span<const double> elevations) {
  constexpr int rows = 12, columns = 16;
  const SunTable sunlight(settings.turbidity);
  std::vector<Daylight> daylight(elevations.size());
  parallel_for(int(elevations.size()), [&](int i) {
    SkySettings now = settings;
    now.elevation = elevations[size_t(i)];
    const Atmosphere air(now.turbidity, towards_sun(now), sunlight);
    dvec3 sky(0);
    for (int k = 0; k < rows * columns; k++) {
      // Directions are even over the ground's view of the sky: cosine of the zenith angle, squared.
      const double cosine = std::sqrt((k / columns + 0.5) / rows),
                   flat = std::sqrt(1 - cosine * cosine),
                   phi = 2 * pi_ * (k % columns + 0.5) / columns;
      sky += air.gather(earth + eye_height, {flat * std::sin(phi), cosine, -flat * std::cos(phi)},
                        32, false, nullptr);
    }
    sky *= sun_outside * now.strength * pi_ / (rows * columns);
    daylight[size_t(i)] = {vec3(sun_irradiance(now, sunlight)), vec3(sky)};
  });
  return daylight;
}

void add_sky(const SkySettings& settings, Scene& scene) {
  constexpr int width = 512, height = 256;
  const SunTable sunlight(settings.turbidity);
  const Atmosphere air(settings.turbidity, towards_sun(settings), sunlight);
  Image image;
  image.name = "sky";
  image.width = width;
  image.height = height;
  image.texels.resize(size_t(width) * height);
  double scale = sun_outside * settings.strength;
  std::vector<dvec3> sky_irradiance(height / 2, dvec3(0));  // irradiance on the ground, row by row
  parallel_for(height / 2, [&](int y) {
    double theta = pi_ * (y + 0.5) / height;
    for (int x = 0; x < width; x++) {
      double phi = 2 * pi_ * ((x + 0.5) / width - 0.5);
      dvec3 direction(std::sin(theta) * std::sin(phi), std::cos(theta),
                      -std::sin(theta) * std::cos(phi));
      dvec3 radiance = scale * air.gather(earth + eye_height, direction, 48, false, nullptr);
      image.texels[size_t(y) * width + size_t(x)] = vec4(vec3(radiance), 1);
      sky_irradiance[size_t(y)] +=
          radiance * (std::cos(theta) * std::sin(theta) * pi_ / height * 2 * pi_ / width);
    }
  });
  dvec3 sun = sun_irradiance(settings, sunlight);
  dvec3 ground = sun * std::max(0.0, air.sun.y);
  for (const dvec3& row : sky_irradiance) ground += row;
  ground *= ground_albedo / pi_;
  std::fill(image.texels.begin() + width * height / 2, image.texels.end(), vec4(vec3(ground), 1));
  scene.images.push_back(std::move(image));
  Environment environment;
  environment.radiance = vec3(1);
  environment.image = int(scene.images.size()) - 1;
  double half = std::sin(0.5 * sun_radius);
  environment.sun = {vec3(air.sun), vec3(sun / (4 * pi_ * half * half)), float(sun_radius)};
  if (!(max_component(environment.sun.radiance) > 0)) environment.sun = {};
  scene.environment = environment;
}

bool add_missing_light(Scene& scene) {
  if (has_light(scene)) return false;
  scene.environment = {vec3(1), -1};
  return true;
}

}  // namespace wellspring::world
