// SPDX-License-Identifier: Apache-2.0
// volume.reconstruct: what values and gradients between samples cost, and how good they are
// (server/volume/reconstruct).
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "base/clock.h"
#include "judge/marschner_lobb.h"
#include "reports.h"
#include "volume/reconstruct/spline.h"
#include "volume/reconstruct/trilinear.h"

namespace wellspring::test {
namespace {

struct NamedScheme {
  const char* name;
  GradientScheme scheme;
};
constexpr NamedScheme named_schemes[] = {{"c*b", GradientScheme::central},
                                         {"d*b", GradientScheme::wide},
                                         {"b'", GradientScheme::analytic},
                                         {"p*b'", GradientScheme::prefiltered},
                                         {"d*b, p across", GradientScheme::wide_across},
                                         {"interpolating b'", GradientScheme::interpolating}};

constexpr int brick_side = 34, place_count = 4096;

// Says in which order places of a brick are asked for.
enum class Places {
  marching,  // eight rays beside each other go through it in steps of half a sample
  random
};

std::vector<Lanes3> make_places(Places order) {
  constexpr float last = brick_side - 1;
  std::mt19937 random(1);
  auto next = [&] { return float(random()) / 4294967296.0f; };
  std::vector<Lanes3> places;
  while (int(places.size()) < place_count / lane_count) {
    Lanes3 eight;
    for (int l = 0; l < lane_count; l++) eight.set(l, vec3(next(), next(), next()) * last);
    if (order == Places::random) {
      places.push_back(eight);
      continue;
    }
    const vec3 step = 0.5f * glm::normalize(vec3(next(), next(), next()) - 0.5f);
    const vec3 side = glm::normalize(glm::cross(step, vec3(0.3f, 0.5f, 0.8f)));
    const vec3 up = glm::normalize(glm::cross(step, side)), begin = eight.at(0);
    for (int l = 0; l < lane_count; l++)
      eight.set(l, begin + 0.7f * (side * float(l % 4) + up * float(l / 4)));
    const vec3 middle = 0.5f * vec3(last);
    while (max_component(glm::abs(eight.at(0) - middle)) <= 0.5f * last &&
           int(places.size()) < place_count / lane_count) {
      places.push_back(eight);
      eight = eight + all_lanes(step);
    }
  }
  return places;
}

// Returns millions of places a second of the quickest of some rounds. `ask` goes through all
// places and returns something that depends on all it found.
double measure_rate(const BenchOptions& options, const std::function<float()>& ask) {
  double best = 0;
  [[maybe_unused]] volatile float seen = ask();
  const double until = thread_seconds_now() + (options.quick ? 0.2 : 1);
  while (thread_seconds_now() < until) {
    const double begin = thread_seconds_now();
    for (int i = 0; i < 8; i++) seen = ask();
    best = std::max(best, 8e-6 * place_count / (thread_seconds_now() - begin));
  }
  return best;
}

void add_rates(BenchReport& report, const std::string& what, double one, double eight) {
  const nlohmann::json where = {{"what", what}};
  report.add("volume.reconstruct.one", one, "M/s", where);
  report.add("volume.reconstruct.eight", eight, "M/s", where);
  report.add("volume.reconstruct.times", eight / one, "", where);
}

template <class Sample>
void measure_trilinear(BenchReport& report, const BenchOptions& options, const char* what,
                       Places order = Places::marching) {
  std::mt19937 random(2);
  std::vector<Sample> samples(brick_side * brick_side * brick_side);
  for (Sample& sample : samples) sample = Sample(random() % 251);
  const SampleBox<Sample> box = whole_box(samples.data(), glm::ivec3(brick_side));
  const std::vector<Lanes3> places = make_places(order);
  const double one = measure_rate(options, [&] {
    float sum = 0;
    for (const Lanes3& eight : places)
      for (int l = 0; l < lane_count; l++) sum += linear_value(box, eight.at(l));
    return sum;
  });
  const double eight = measure_rate(options, [&] {
    Lanes sum{};
    for (const Lanes3& eight : places) sum += linear_value(box, eight);
    return lanes_sum(sum);
  });
  add_rates(report, what, one, eight);
}

void measure_lit(BenchReport& report, const BenchOptions& options) {
  Grid grid{glm::ivec3(brick_side)};
  grid.values = sample_marschner_lobb<float>(brick_side);
  const NormalGrid normals = make_normals(grid);
  const SampleBox<float> box = whole_box(grid.values.data(), grid.size);
  const std::vector<Lanes3> places = make_places(Places::marching);
  const double rate = measure_rate(options, [&] {
    Lanes sum{};
    for (const Lanes3& eight : places) {
      const LanesLit lit = linear_value_and_normal(box, normals.words.data(), eight);
      sum += lit.value + lit.normal.x + lit.normal.y + lit.normal.z;
    }
    return lanes_sum(sum);
  });
  report.add("volume.reconstruct.eight", rate, "M/s", {{"what", "trilinear, stored normals"}});
}

void measure_spline(BenchReport& report, const BenchOptions& options, const NamedScheme& named) {
  const auto samples = sample_marschner_lobb<float>(brick_side);
  const auto spline = make_spline<float>(samples, glm::ivec3(brick_side), named.scheme);
  const std::vector<Lanes3> places = make_places(Places::marching);
  const double one = measure_rate(options, [&] {
    float sum = 0;
    for (const Lanes3& eight : places)
      for (int l = 0; l < lane_count; l++) {
        const ValueGradient<float> found = gradient_at(spline, eight.at(l));
        sum += found.value + found.gradient.x + found.gradient.y + found.gradient.z;
      }
    return sum;
  });
  const double eight = measure_rate(options, [&] {
    Lanes sum{};
    for (const Lanes3& eight : places) {
      const LanesGradient found = gradient_at(spline, eight);
      sum += found.value + found.gradient.x + found.gradient.y + found.gradient.z;
    }
    return lanes_sum(sum);
  });
  add_rates(report, std::string("tricubic, gradient ") + named.name, one, eight);
}

using GradientAt = std::function<Lanes3(const Lanes3& place)>;

// Returns the mean angle between gradients and the true ones, on the surface of the signal.
double mean_angle(int size, const GradientAt& gradient) {
  const std::vector<glm::dvec3> points = marschner_lobb_surface(20000);
  double sum = 0;
  for (size_t i = 0; i < points.size(); i += lane_count) {
    Lanes3 places;
    for (int l = 0; l < lane_count; l++)
      places.set(l, vec3((points[i + size_t(l)] + 1.0) * ((size - 1) / 2.0)));
    const Lanes3 found = gradient(places);
    for (int l = 0; l < lane_count; l++)
      sum +=
          degrees_between(glm::dvec3(found.at(l)), marschner_lobb_gradient(points[i + size_t(l)]));
  }
  return sum / double(points.size());
}

void measure_angles(BenchReport& report, int size) {
  Grid grid{glm::ivec3(size)};
  grid.values = sample_marschner_lobb<float>(size);
  auto add = [&](const std::string& what, const GradientAt& gradient) {
    report.add("volume.reconstruct.degrees", mean_angle(size, gradient), "degrees",
               {{"what", what}, {"samples", std::to_string(size) + "^3"}});
  };
  const NormalGrid normals = make_normals(grid);
  const SampleBox<float> box = whole_box(grid.values.data(), grid.size);
  add("trilinear, stored normals", [&](const Lanes3& place) {
    return -linear_value_and_normal(box, normals.words.data(), place).normal;
  });
  for (const NamedScheme& named : named_schemes) {
    const Spline<float> spline = make_spline(grid, named.scheme);
    add(std::string("tricubic, gradient ") + named.name,
        [&](const Lanes3& place) { return gradient_at(spline, place).gradient; });
  }
}

// The largest errors of a plane wave's value and gradient, in the middle of [0, 2]^3 or of its
// first edge, in double.
ValueGradient<double> largest_errors(GradientScheme scheme, int intervals, bool line) {
  const glm::dvec3 wave = line ? glm::dvec3(1.1, 0, 0) : glm::dvec3(1.1, 0.8, 0.6);
  const glm::ivec3 size = line ? glm::ivec3(intervals + 1, 1, 1) : glm::ivec3(intervals + 1);
  const double step = 2.0 / intervals;
  std::vector<double> samples;
  for (int z = 0; z < size.z; z++)
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++)
        samples.push_back(std::sin(glm::dot(wave, glm::dvec3(x, y, z) * step)));
  const auto spline = make_spline<double>(samples, size, scheme);
  ValueGradient<double> most;
  for (int i = 0; i < 1000; i++) {
    const glm::dvec3 at = 0.8 + 0.4 * glm::dvec3(i % 10, i / 10 % 10, i / 100) / 9.7;
    const ValueGradient<double> found = gradient_at(spline, at / step);
    most.value = std::max(most.value, std::abs(found.value - std::sin(glm::dot(wave, at))));
    const glm::dvec3 error = found.gradient / step - wave * std::cos(glm::dot(wave, at));
    most.gradient.x = std::max(most.gradient.x, line ? std::abs(error.x) : glm::length(error));
  }
  return most;
}

void measure_orders(BenchReport& report, const NamedScheme& named) {
  for (bool line : {true, false}) {
    const int intervals = line ? 128 : 32;
    const auto coarse = largest_errors(named.scheme, intervals, line),
               fine = largest_errors(named.scheme, 2 * intervals, line);
    auto add = [&](const char* of, double order) {
      report.add("volume.reconstruct.order", order, "",
                 {{"what", named.name}, {"of", std::string(of) + (line ? ", line" : ", space")}});
    };
    add("value", std::log2(coarse.value / fine.value));
    add("gradient", std::log2(coarse.gradient.x / fine.gradient.x));
  }
}

}  // namespace

void bench_volume_reconstruct(BenchReport& report, const BenchOptions& options) {
  measure_trilinear<float>(report, options, "trilinear, float");
  measure_trilinear<float>(report, options, "trilinear, float, random places", Places::random);
  measure_trilinear<uint16_t>(report, options, "trilinear, 16 bits");
  measure_trilinear<uint8_t>(report, options, "trilinear, 8 bits");
  measure_lit(report, options);
  for (const NamedScheme& named : named_schemes) measure_spline(report, options, named);
  for (int size : {40, 60, 80}) measure_angles(report, size);
  for (const NamedScheme& named : named_schemes) measure_orders(report, named);
}

ReportPage volume_reconstruct_page() {
  return {
      "volume.reconstruct",
      "What do values and gradients between the samples of a volume cost, and how good are "
      "they?",
      {"Places: in a brick of 34^3 samples, in millions a second on one core, one at a time and "
       "eight at a time, as eight rays beside each other march in steps of half a sample. "
       "Wanted: four times as many trilinear ones.",
       "Angles: between a gradient and the true one, mean of 20,000 points on the surface of "
       "Marschner and Lobb's signal.",
       "Orders: the power of the distance of samples by which errors of a plane wave fall, "
       "whose crests lie across a line of samples, or slant through space."},
      {{.caption = "Speed",
        .rows = {{"what", "reconstruction"}},
        .columns = {{"volume.reconstruct.one", "one at a time"},
                    {"volume.reconstruct.eight", "eight at a time"},
                    {"volume.reconstruct.times", "times as many"}},
        .most_rows = 6},
       {.caption = "Angle of gradients, degrees",
        .rows = {{"what", "reconstruction"}},
        .columns = {{"volume.reconstruct.degrees", "angle"}},
        .across = "samples",
        .most_rows = 6},
       {.caption = "Measured orders",
        .rows = {{"what", "scheme"}},
        .columns = {{"volume.reconstruct.order", "order"}},
        .across = "of",
        .most_rows = 6}}};
}

}  // namespace wellspring::test
