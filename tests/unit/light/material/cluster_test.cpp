// SPDX-License-Identifier: Apache-2.0
// Clusters of wavelengths as estimators: a toy of one dimension whose means and deviations are
// known, weights that sum up to 1, no lobe for which one wavelength alone is better, and products
// along long paths.
#include <random>

#include "light/material/dispersion.h"
#include "light/walk/walk.h"
#include "scenes/lit_world.h"
#include "unit/light/material/bsdf_cases.h"
#include "unit/light/statistics.h"
#include "world/load/scene_spectra.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Wavelengths are drawn evenly, from 0 to 1, and bring light twice their own number.
SpectralTables make_toy_tables() {
  SpectralTables tables;
  for (size_t i = 0; i <= spectrum_size; i++) tables.below[i] = float(i) / float(spectrum_size);
  for (size_t i = 0; i < spectrum_size; i++)
    tables.response[i] = tables.shown[i] = vec3(2 * (float(i) + 0.5f) / float(spectrum_size));
  return tables;
}
const SpectralTables& toy_tables() {
  static const SpectralTables tables = make_toy_tables();
  return tables;
}
double length_of(float nm) { return (double(nm) - first_nm + 0.5) / double(spectrum_size); }

enum class Estimator { single, naive, mis };

// A direction x is drawn from a bell of width `width` about half the first wavelength, and meets
// light of 1 below a quarter, of 0.2 above it.
double estimate(Estimator how, double width, std::mt19937& random) {
  std::uniform_real_distribution<float> place(0, 1);
  std::normal_distribution<double> bell(0, width);
  Wavelengths w;
  begin_cluster(toy_tables(), std::min(place(random), 0.999999f), w);
  const double off = bell(random), x = length_of(w.nm[0]) / 2 + off;
  for (int i = 1; i < wavelength_count; i++) {
    const double other = x - length_of(w.nm[i]) / 2;
    const double ratio = std::exp((off * off - other * other) / (2 * width * width));
    // A lobe is drawn as it scatters: its value is its density.
    w.value[i] *= how == Estimator::single ? 0.0f : float(ratio);
    w.density[i] *= how == Estimator::naive ? 1.0f : w.value[i];
  }
  return double(tint_of(toy_tables(), w).x) * (x < 0.25 ? 1 : 0.2);
}

Mean estimate_many(Estimator how, double width, int count = 40000) {
  std::mt19937 random(5);
  Mean mean;
  for (int i = 0; i < count; i++) mean.add(estimate(how, width, random));
  return mean;
}
double deviation(const Mean& mean) { return mean.error() * std::sqrt(mean.count - 1); }

double toy_truth(double width) {
  constexpr int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; i++) {
    const double nm = (i + 0.5) / steps, below = 0.25 - nm / 2;
    sum += 2 * nm * (0.2 + 0.4 * (1 + std::erf(below / width / std::sqrt(2.0)))) / steps;
  }
  return sum;
}

TEST(Cluster, AToyOfOneDimensionHasItsMeansAndDeviations) {
  constexpr struct {
    double width, single, mis;  // width, standard deviations of one cluster
  } cases[] = {{1, 0.551, 0.366}, {0.3, 0.480, 0.298}, {0.1, 0.321, 0.224}, {0.02, 0.234, 0.229}};
  for (const auto& c : cases) {
    const double truth = toy_truth(c.width);
    const Mean single = estimate_many(Estimator::single, c.width),
               mis = estimate_many(Estimator::mis, c.width);
    expect_mean(single, truth, "single");
    expect_mean(mis, truth, "mis");
    EXPECT_NEAR(deviation(single), c.single, 0.02) << c.width;
    EXPECT_NEAR(deviation(mis), c.mis, 0.02) << c.width;
  }
}

// The estimator without multiple importance sampling is right for wide lobes; for narrow ones few
// samples have nearly all of the light, and it is worse than one wavelength alone.
TEST(Cluster, WithoutMisNarrowLobesAreNoisy) {
  const Mean wide = estimate_many(Estimator::naive, 1);
  expect_mean(wide, toy_truth(1), "naive, wide");
  EXPECT_NEAR(deviation(wide), 0.378, 0.02);
  EXPECT_GT(deviation(estimate_many(Estimator::naive, 0.1)),
            5 * deviation(estimate_many(Estimator::single, 0.1)));
}

TEST(Cluster, NoLobeIsBetterForOneWavelengthAlone) {
  for (double width : {3.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.003, 0.001})
    EXPECT_LE(deviation(estimate_many(Estimator::mis, width)),
              1.005 * deviation(estimate_many(Estimator::single, width)))
        << width;
}

// A surface that scatters, and the direction from which light comes and in which it goes on.
struct Event {
  Material material;
  vec3 from{0}, to{0};
};
std::vector<Event> random_events(int count, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<Event> events;
  for (int k = 0; k < count; k++) {
    Material m = glass(uniform(random) < 0.5f ? 1.3f : 1.6f, 0.3f + 0.7f * uniform(random), 1);
    m.dispersion = 4 * uniform(random);
    const vec3 from = direction_at(80 * uniform(random));
    vec3 to = direction_at(60 * uniform(random));
    if (uniform(random) < 0.7f) to = -to;
    events.push_back({std::move(m), from, to});
  }
  return events;
}

// Lets a cluster take the way that is given.
void scatter(const Event& event, Wavelengths& carried) {
  const SpectralTables& tables = *plain_spectral_tables();
  std::optional<WavelengthSpread> spread;
  Bsdf bsdf;
  spread_wavelengths(tables, surface_of(event.material), event.material, -event.from,
                     dielectric_albedo(event.material.ior), carried, 0, bsdf, spread);
  BsdfSample sample;
  sample.direction = event.to;
  sample.weight = vec3(1);
  sample.pdf = 1;
  carry_wavelengths(*spread, bsdf, Lobes::all, sample, carried);
}

// Whichever wavelength of a cluster had chosen a path, their weights along it sum up to 1.
TEST(Cluster, WeightsOverAllChoicesSumUpToOne) {
  const SpectralTables& tables = *plain_spectral_tables();
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0, 0.124f);
  double lowest = 1, highest = 0;
  for (int round = 0; round < 60; round++) {
    const float place = uniform(random);
    const std::vector<Event> events = random_events(1 + round % 6, random);
    double sum = 0;
    for (int s = 0; s < wavelength_count; s++) {
      Wavelengths w;
      begin_cluster(tables, place + float(s) / wavelength_count, w);
      for (const Event& event : events) scatter(event, w);
      ASSERT_EQ(w.carried, wavelength_count);
      EXPECT_EQ(w.density[0], 1);
      double densities = 0;
      for (int i = 0; i < w.carried; i++) densities += double(w.density[i]);
      sum += 1 / densities;
      lowest = std::min(lowest, 1 / densities);
      highest = std::max(highest, 1 / densities);
    }
    EXPECT_NEAR(sum, 1, 1e-3) << round;
  }
  EXPECT_LT(lowest, 0.05);  // some choices were unlikely, some likely
  EXPECT_GT(highest, 0.3);
}

// Hero by hero the value of a path is the same: the sum of values over that of densities times the
// hero's own is what all of them together have.
TEST(Cluster, APathHasOneValueWhoeverChoseIt) {
  const SpectralTables& tables = *plain_spectral_tables();
  std::mt19937 random(12);
  for (int round = 0; round < 20; round++) {
    const std::vector<Event> events = random_events(3, random);
    float first[wavelength_count], other[wavelength_count];
    for (int s : {0, 3}) {
      Wavelengths w;
      begin_cluster(tables, 0.05f + float(s) / wavelength_count, w);
      for (const Event& event : events) scatter(event, w);
      for (int i = 0; i < wavelength_count; i++)
        (s ? other : first)[(i + s) % wavelength_count] = w.value[i];
    }
    for (int i = 0; i < wavelength_count; i++)
      EXPECT_NEAR(first[i] / first[3], other[i], 2e-3f * other[i]) << round << ", " << i;
  }
}

TEST(Cluster, AHundredEventsKeepTheirLight) {
  const SpectralTables& tables = *plain_spectral_tables();
  for (uint32_t path = 0; path < 20; path++) {
    Wavelengths carried;
    begin_cluster(tables, (float(path) + 0.5f) / 20, carried);
    Sampler sampler(mix64(path), 0);
    int scattered = 0;
    for (int k = 0; k < 200 && scattered < 100; k++) {
      Material m = glass(1.5f, 0.2f + 0.004f * float(k), 1);
      m.dispersion = 2;
      std::optional<WavelengthSpread> spread;
      Bsdf bsdf;
      spread_wavelengths(tables, surface_of(m), m, -direction_at(float(k % 70)),
                         dielectric_albedo(m.ior), carried, 0, bsdf, spread);
      BsdfSample sample = sample_bsdf(bsdf, Lobes::all, sampler);
      if (sample.weight == vec3(0)) continue;
      Wavelengths next = carried;
      carry_wavelengths(*spread, bsdf, Lobes::all, sample, next);
      if (sample.weight == vec3(0)) continue;
      carried = next;
      scattered++;
    }
    ASSERT_EQ(scattered, 100);
    const vec3 tint = tint_of(tables, carried);
    EXPECT_TRUE(is_finite(tint)) << path;
    EXPECT_GT(max_component(tint), 1e-3f) << path;
    EXPECT_EQ(carried.density[0], 1);
  }
}

// Draws heroes as walks do, where a second surface is met that is known by wavelength.
struct Heroes {
  LitWorld lit;
  static Scene make() {
    Scene scene = make_furnace(1);
    Material& wall = scene.materials[size_t(scene.meshes[0].material)];
    set_reflectance(scene, wall, add_spectrum(scene, "grey", even_spectrum(0.5)));
    return scene;
  }
  Heroes() : lit(make()) {}
  float draw(uint64_t seed, uint32_t index) const {
    const Transport transport{lit.world, *lit.lights.tables};
    const Material& wall = lit.scene.materials[size_t(lit.scene.meshes[0].material)];
    Wavelengths carried;
    carried.reflected = 0;
    Sampler sampler(seed, index);
    BsdfSample scattered;
    reflect(transport, wall, {}, Lobes::diffuse, Dimensions::first_surface, sampler, scattered,
            carried);
    EXPECT_EQ(carried.carried, wavelength_count);
    return carried.place;
  }
};

// The place of a cluster is well spread; which of it is the hero is even, and owes nothing to that.
TEST(Cluster, HeroesAreChosenEvenlyAndApart) {
  const Heroes heroes;
  constexpr int cells = 8, seeds = 64, samples = 256;
  std::vector<double> choices(wavelength_count), pairs(size_t(cells * wavelength_count)),
      next(size_t(wavelength_count * wavelength_count));
  for (uint64_t seed = 0; seed < seeds; seed++) {
    std::vector<int> strata(samples, 0);
    int last = -1;
    for (uint32_t i = 0; i < samples; i++) {
      const float at = heroes.draw(mix64(seed), i) * wavelength_count;
      const int choice = std::min(int(at), wavelength_count - 1);
      const float u = at - float(choice);
      strata[size_t(std::min(int(u * samples), samples - 1))]++;
      choices[size_t(choice)]++;
      pairs[size_t(int(u * cells) * wavelength_count + choice)]++;
      if (last >= 0) next[size_t(last * wavelength_count + choice)]++;
      last = choice;
    }
    // Adding the choice costs the place a few of its bits.
    EXPECT_LE(std::ranges::count(strata, 0), 2) << seed;
  }
  auto even = [](const std::vector<double>& counts, double all) {
    return std::vector<double>(counts.size(), all / double(counts.size()));
  };
  expect_chi_squared(choices, even(choices, seeds * samples), "choices");
  expect_chi_squared(pairs, even(pairs, seeds * samples), "places and choices");
  expect_chi_squared(next, even(next, seeds * (samples - 1)), "one choice after another");
}

// Nothing comes of wavelengths that are all taken up, and it is nothing rather than no number.
TEST(Cluster, BlackIsBlackWhateverWasDrawn) {
  Scene scene = empty_scene();
  Material black = diffuse(vec3(1)), white = diffuse(vec3(1));
  Spectrum far{};
  far[0] = 1;  // at the end of what is seen; clusters hardly come upon it
  set_reflectance(scene, black, add_spectrum(scene, "far", far));
  set_reflectance(scene, white, add_spectrum(scene, "white", even_spectrum(1)));
  const int number = add_material(scene, black);
  add_material(scene, white);
  const std::shared_ptr<const SpectralTables> tables = make_spectral_tables(scene);
  const int dark = scene.materials[size_t(number)].spectra.reflectance;
  for (float place : {0.1f, 0.3f, 0.52f, 0.7f, 0.9f}) {
    Wavelengths w;
    begin_cluster(*tables, place, w);
    EXPECT_LT(max_component(abs(tint_of(*tables, w) - vec3(1))), 3) << place;
    reflect_wavelengths(*tables, dark, w);
    EXPECT_EQ(tint_of(*tables, w), vec3(0)) << place;
    reflect_wavelengths(*tables, dark + 1, w);
    EXPECT_EQ(tint_of(*tables, w), vec3(0)) << place;
    w.carried = 1;
    EXPECT_EQ(tint_of(*tables, w), vec3(0)) << place;
    w.density = all_lanes(0);
    EXPECT_EQ(tint_of(*tables, w), vec3(0)) << place;
  }
}

// A walk that runs on and on in a gem, which takes up all red, has no red: nothing is divided by
// it.
TEST(Cluster, AGemMaySwallowAChannelWhole) {
  Scene scene = empty_scene();
  Spectrum absorption{};
  for (size_t i = 0; i < spectrum_size; i++) absorption[i] = nm_of(i) > 560 ? 500 : 1;
  const int gem = add_spectrum(scene, "gem", absorption);
  const std::shared_ptr<const SpectralTables> tables = make_spectral_tables(scene);
  Wavelengths w;
  begin_cluster(*tables, 0.5f, w);
  vec3 throughput(1);
  const vec3 tint(1e-6f, 0.8f, 0.9f);
  for (int k = 0; k < 20; k++) {
    absorb_wavelengths(*tables, gem, 0.02f, tint, w);
    throughput *= tint;
    const vec3 seen = throughput * tint_of(*tables, w);
    EXPECT_TRUE(is_finite(seen)) << k;
    EXPECT_TRUE(is_finite(throughput * shown_tint(*tables, w))) << k;
  }
  EXPECT_EQ(throughput.x * tint_of(*tables, w).x, 0);
}

}  // namespace
}  // namespace wellspring::test
