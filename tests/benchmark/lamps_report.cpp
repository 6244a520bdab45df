// SPDX-License-Identifier: Apache-2.0
// lamps: how far colours under another lamp are off where light is kept in few spectral bins, in
// red, green and blue, or drawn at wavelengths (server/spectrum).
#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/rng.h"
#include "reports.h"
#include "spectral/pigments.h"
#include "spectrum/bins.h"
#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "spectrum/upsample.h"
#include "spectrum/wavelength_density.h"

namespace wellspring::test {
namespace {

constexpr int cluster_size = 8;  // wavelengths of a path

// Takes the differences of guesses from the truth.
struct Differences {
  std::vector<double> all;
  void add(const LampObserver& lamp, const dvec3& truth, const dvec3& guess) {
    all.push_back(ciede2000(lab_of(truth, lamp.white()), lab_of(guess, lamp.white())));
  }
  void report(BenchReport& report, const std::string& name, const nlohmann::json& where) const {
    double sum = 0;
    for (const double one : all) sum += one;
    report.add(name + "_mean", sum / double(all.size()), "dE00", where);
    report.add(name + "_max", *std::ranges::max_element(all), "dE00", where);
  }
};

// Calls body(reflectance, another) for each pigment.
template <class Body>
void each_pair(const std::vector<Spectrum>& pigments, const Body& body) {
  for (size_t i = 0; i < pigments.size(); i++)
    body(pigments[i], pigments[(i + 1) % pigments.size()]);
}

void measure_bins(BenchReport& report, const std::vector<Spectrum>& pigments, int count,
                  BinShapes shapes, nlohmann::json where) {
  const SpectralBins bins = make_bins(count, shapes);
  Differences once, twice;
  double seconds = INFINITY;
  for (const char* name : lamp_dial) {
    const Spectrum power = find_lamp(name)->power;
    const LampObserver lamp(power);
    const double began = seconds_now();
    const std::vector<dvec3> matrix = lamp_matrix(bins, power);
    seconds = std::min(seconds, seconds_now() - began);
    each_pair(pigments, [&](const Spectrum& first, const Spectrum& second) {
      std::vector<double> means = bin_means(bins, first);
      once.add(lamp, lamp.xyz(first), xyz_of_means(matrix, means));
      const std::vector<double> more = bin_means(bins, second);
      for (size_t i = 0; i < means.size(); i++) means[i] *= more[i];
      twice.add(lamp, lamp.xyz(product(first, second)), xyz_of_means(matrix, means));
    });
  }
  where["way"] = std::to_string(count) + (shapes == BinShapes::even ? " even bins" : " bins");
  once.report(report, "lamps.de00", where);
  twice.report(report, "lamps.twice_de00", where);
  report.add("lamps.matrix_ms", 1000 * seconds, "ms", where);
}

// Measures products of red, green and blue, and of spectra guessed from these.
void measure_colors(BenchReport& report, const std::vector<Spectrum>& pigments,
                    nlohmann::json where) {
  const LampObserver daylight(find_lamp("D65")->power);
  std::vector<Spectrum> guesses;
  for (const Spectrum& one : pigments)
    guesses.push_back(sample_reflectance(fit_reflectance(rgb_of(daylight.xyz(one)))));
  Differences products, products_twice, guessed, guessed_twice;
  for (const char* name : lamp_dial) {
    const LampObserver lamp(find_lamp(name)->power);
    const dvec3 white = rgb_of(lamp.white());
    each_pair(pigments, [&](const Spectrum& first, const Spectrum& second) {
      const dvec3 one = rgb_of(daylight.xyz(first)), other = rgb_of(daylight.xyz(second));
      products.add(lamp, lamp.xyz(first), xyz_of_rgb(one * white));
      products_twice.add(lamp, lamp.xyz(product(first, second)), xyz_of_rgb(one * other * white));
    });
    for (size_t i = 0; i < pigments.size(); i++) {
      const size_t k = (i + 1) % pigments.size();
      guessed.add(lamp, lamp.xyz(pigments[i]), lamp.xyz(guesses[i]));
      guessed_twice.add(lamp, lamp.xyz(product(pigments[i], pigments[k])),
                        lamp.xyz(product(guesses[i], guesses[k])));
    }
  }
  where["way"] = "red, green, blue";
  products.report(report, "lamps.de00", where);
  products_twice.report(report, "lamps.twice_de00", where);
  where["way"] = "spectra guessed of these";
  guessed.report(report, "lamps.de00", where);
  guessed_twice.report(report, "lamps.twice_de00", where);
}

// Estimates X, Y and Z at wavelengths that are drawn, the same for the surface and for white, whose
// ratio has less noise.
dvec3 draw_color(const WavelengthDensity& density, const LampObserver& lamp,
                 const Spectrum& reflectance, int paths, uint32_t seed) {
  Rng random(sample_seed(seed, 0, 0, 0));
  dvec3 sum(0), white(0);
  for (int i = 0; i < paths; i++) {
    const double place = (double(i) + double(random.uniform())) / paths;
    for (int k = 0; k < cluster_size; k++) {
      const double nm = density.quantile((double(k) + place) / cluster_size);
      const size_t w = size_t(std::clamp(std::lround(nm) - first_nm, 0l, long(spectrum_size) - 1));
      const dvec3 weight = lamp.weights()[w] / density.at(nm);
      sum += reflectance[w] * weight, white += weight;
    }
  }
  return sum * lamp.white() / glm::max(white, dvec3(1e-12));
}

void measure_clusters(BenchReport& report, const std::vector<Spectrum>& pigments,
                      nlohmann::json where) {
  const WavelengthDensity density(first_nm, last_nm);
  for (const int paths : {1, 4, 16, 64}) {
    Differences drawn;
    uint32_t seed = 1;
    for (const char* name : lamp_dial) {
      const LampObserver lamp(find_lamp(name)->power);
      for (const Spectrum& one : pigments)
        drawn.add(lamp, lamp.xyz(one), draw_color(density, lamp, one, paths, seed++));
    }
    where["way"] = std::to_string(paths) + (paths == 1 ? " path" : " paths") + " of 8 wavelengths";
    drawn.report(report, "lamps.de00", where);
  }
}

}  // namespace

void bench_lamps(BenchReport& report, const BenchOptions& options) {
  const auto [pigments, kind] = find_pigments(options);
  const nlohmann::json where = {{"pigments", kind}};
  for (const int count : {usual_bins, 8, 16})
    measure_bins(report, pigments, count, BinShapes::estimated, where);
  for (const int count : {8, 12, 16}) measure_bins(report, pigments, count, BinShapes::even, where);
  measure_colors(report, pigments, where);
  measure_clusters(report, pigments, where);
}

ReportPage lamps_page() {
  return {
      "lamps",
      "How far are the colours of pigments off under another lamp, if light is kept in few "
      "spectral bins and re-weighted, in red, green and blue, or drawn at wavelengths?",
      {"CIEDE2000 against sums over every nanometre, beside the lamp's own white; 1 to 2 is just "
       "seen. 54 pigments (measured historic ones where they are at hand, else made) under candle, "
       "A, north light, LED-B1, LED-B3, LED-V2, FL11 and HP1.",
       "Twice: light that two of them have sent back, one after the other. Bins are re-weighted by "
       "Wiener's estimate; even bins take a reflectance for the same throughout a bin. Scenes are "
       "to "
       "keep within a mean of 0.5 and a maximum of 2.5 when a lamp changes, 0.3 and 1.0 at rest."},
      {{.caption = "Ways to keep light",
        .rows = {{"way", "kept as"}},
        .columns = {{"lamps.de00_mean", "mean", 1, ""},
                    {"lamps.de00_max", "max", 1, ""},
                    {"lamps.twice_de00_mean", "twice, mean", 1, ""},
                    {"lamps.twice_de00_max", "twice, max", 1, ""},
                    {"lamps.matrix_ms", "a lamp's matrix", 1, "ms"}},
        .most_rows = 14}}};
}

}  // namespace wellspring::test
