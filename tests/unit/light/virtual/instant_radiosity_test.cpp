// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/instant_radiosity.h"

#include <cstring>
#include <set>

#include "unit/light/judge.h"
#include "light/sample/emission.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

// The set of a pixel's place in the pattern.
int set_of_pixel(const InstantPass& pass, uint32_t pixel) {
  int x = int(pixel % uint32_t(pass.width)), y = int(pixel / uint32_t(pass.width));
  return y % pass.rows * pass.columns + x % pass.columns;
}

const Technique& instant() { return *find_technique("instant_radiosity"); }

InstantPass draw(const World& world, const Lights& lights, const TransportSettings& settings,
                 uint64_t seed, uint32_t index = 0) {
  return draw_instant_pass({world, *lights.tables}, settings, 8, seed, index);
}

// Irradiance by the lights of every set, shadows and clipping apart, at a place that faces up.
double irradiance(const InstantPass& pass, vec3 place) {
  double sum = 0;
  for (const PointLight& light : pass.lights) {
    vec3 line = light.position - place;
    float d2 = dot(line, line), d = std::sqrt(d2);
    float here = line.y / d, there = -dot(line, light.normal) / d;
    if (here > 0 && there > 0) sum += double(light.radiance.x * here * there / d2);
  }
  return sum / pass.sets();
}

void expect_dark_and_finite(const Scene& scene, const View& view, const char* what,
                            bool dark = true) {
  World world(scene);
  Lights lights = make_lights(world);
  StillSettings settings;
  settings.spp = 2;
  settings.transport.instant.photons = 200;
  Frame frame = render_still(instant(), world, lights, view, settings);
  for (vec3 c : frame.color) {
    ASSERT_TRUE(is_finite(c)) << what;
    if (dark) {
      ASSERT_EQ(c, vec3(0)) << what;
    }
  }
  EXPECT_EQ(lights.bad_samples->load(), 0u) << what;
}

}  // namespace

// In a closed box every walk goes on until it is absorbed: the flux that arrives after d edges is
// the power of the light times albedo^(d - 1).
TEST(InstantRadiosity, PointLightsCarryTheLightsPowerAndItsSeries) {
  const float albedo = 0.6f;
  Scene scene = make_furnace(albedo);
  World world(scene);
  Lights lights = make_lights(world);
  TransportSettings settings;
  settings.max_depth = 7;  // walks of up to five edges
  const double power = double(pi) * 24;
  Mean places, arrived[6];
  for (uint64_t seed = 0; seed < 40; seed++) {
    InstantPass pass = draw(world, lights, settings, seed);
    double emitted = 0, sum[6] = {};
    for (const PointLight& light : pass.lights) {
      ASSERT_EQ(light.kind, PointLightKind::lambertian);
      ASSERT_LE(light.depth, 5);
      if (light.depth == 0) emitted += double(light.radiance.x * pi);
      else sum[light.depth] += double(light.radiance.x * pi / albedo);
    }
    places.add(emitted / pass.sets());
    for (int d = 1; d < 6; d++) arrived[d].add(sum[d] / pass.sets());
  }
  expect_mean(places, power, "places on the light");
  double expected = power;
  for (int d = 1; d < 6; d++, expected *= double(albedo))
    expect_mean(arrived[d], expected, "arriving light", 0.05);
}

TEST(InstantRadiosity, QuasiRandomLightsVaryLessThanRandomOnes) {
  Scene scene = make_cornell_box();
  World world(scene);
  Lights lights = make_lights(world);
  const vec3 place(0.05f, 0, -0.2f);
  TransportSettings together, alone;
  together.instant.places = together.instant.walks = 16;
  together.instant.columns = together.instant.rows = alone.instant.columns = alone.instant.rows = 1;
  alone.instant.places = alone.instant.walks = 1;
  Mean quasi, random;
  for (uint64_t seed = 0; seed < 100; seed++) {
    quasi.add(irradiance(draw(world, lights, together, seed), place));
    double sum = 0;
    for (uint64_t k = 0; k < 16; k++)
      sum += irradiance(draw(world, lights, alone, mix64(seed * 16 + k)), place) / 16;
    random.add(sum);
  }
  expect_same_mean(quasi, random, "randomisation is unbiased");
  // F-test: a ratio of variances of equal estimators below 0.47 has probability 1e-4 at 99 degrees.
  double ratio = quasi.error() * quasi.error() / (random.error() * random.error());
  EXPECT_LT(ratio, 0.47);
}

// Lights chosen by their effect are worth what all candidates are, in every set, whether or not a
// probe sees them; and they are the fewer that they were wanted to be.
TEST(InstantRadiosity, ChosenLightsAreWorthAllCandidates) {
  Scene scene = make_cornell_box();
  World world(scene);
  Lights lights = make_lights(world);
  // A corner of the floor: of most places there is nothing to be seen from it.
  View view =
      make_view_towards(scene, {0.2f, 0.1f, 0.2f}, {0.27f, 0, 0.2f}, {0, 1, 0}, 0.2f, 16, 16);
  TransportSettings settings, all;
  settings.instant.columns = settings.instant.rows = 3;
  settings.instant.places = 2, settings.instant.walks = 2, settings.instant.bounced = 3;
  settings.instant.candidates = 4;
  all = settings;
  all.instant.candidates = 1;
  all.instant.walks = 8;
  auto irradiance_of = [&](const InstantPass& pass, int set, vec3 place) {
    InstantPass one;
    one.columns = one.rows = 1;
    one.lights.assign(pass.lights.begin() + pass.first[size_t(set)],
                      pass.lights.begin() + pass.first[size_t(set) + 1]);
    return irradiance(one, place);
  };
  const vec3 seen(0.25f, 0.001f, 0.2f), elsewhere(-0.1f, 0.3f, -0.1f);
  Mean chosen_seen, chosen_elsewhere, all_seen, all_elsewhere;
  for (uint64_t seed = 0; seed < 300; seed++) {
    InstantPass chosen = draw_instant_pass({world, *lights.tables}, settings, view, seed, 0),
                every = draw_instant_pass({world, *lights.tables}, all, view, seed + 1000, 0);
    size_t wanted = 9 * (2 + 3);  // one more or less of each kind
    EXPECT_LE(chosen.lights.size(), wanted + 2);
    EXPECT_GE(chosen.lights.size(), wanted - 2);
    chosen_seen.add(irradiance_of(chosen, 4, seen));
    chosen_elsewhere.add(irradiance_of(chosen, 4, elsewhere));
    all_seen.add(irradiance_of(every, 4, seen));
    all_elsewhere.add(irradiance_of(every, 4, elsewhere));
  }
  expect_same_mean(chosen_seen, all_seen, "where the view looks");
  expect_same_mean(chosen_elsewhere, all_elsewhere, "where it does not");
}

// Sets and passes are subsequences of one sequence: sixteen sets of one walk stratify the lamp as
// one set of sixteen does.
TEST(InstantRadiosity, SetsAndPassesContinueOneSequence) {
  Scene scene = make_cornell_box();
  World world(scene);
  Lights lights = make_lights(world);
  auto positions = [](const InstantPass& pass) {
    std::vector<vec3> all;
    for (const PointLight& light : pass.lights)
      if (light.depth == 0) all.push_back(light.position);
    return all;
  };
  TransportSettings one, many;
  one.instant.columns = one.instant.rows = 1;
  one.instant.places = 18;
  many.instant.columns = 3;
  many.instant.rows = 3;
  many.instant.places = 1;
  std::vector<vec3> all = positions(draw(world, lights, one, 5)),
                    split = positions(draw(world, lights, many, 5)),
                    next = positions(draw(world, lights, many, 5, 1));
  split.insert(split.end(), next.begin(), next.end());
  EXPECT_EQ(all, split);
  EXPECT_NE(all, positions(draw(world, lights, one, 6)));
}

TEST(InstantRadiosity, EveryWindowHasAPixelOfEverySet) {
  for (int n : {1, 3, 5}) {
    InstantPass pass;
    pass.columns = n;
    pass.rows = n;
    pass.width = 16;
    std::set<int> lists;
    for (uint32_t pixel = 0; pixel < 16 * 16; pixel++) {
      int list = list_of_pixel(pass, pixel);
      ASSERT_EQ(set_of_list(pass, list), set_of_pixel(pass, pixel));
      lists.insert(list);
    }
    EXPECT_EQ(lists.size(), size_t(pass.lists()));
    EXPECT_EQ(*lists.rbegin(), pass.lists() - 1);
    for (int top = 0; top + n <= 12; top++)
      for (int left = 0; left + n <= pass.width; left++) {
        std::set<int> met;
        for (int y = top; y < top + n; y++)
          for (int x = left; x < left + n; x++)
            met.insert(set_of_pixel(pass, uint32_t(y * pass.width + x)));
        ASSERT_EQ(met.size(), size_t(pass.sets()));
        ASSERT_GE(*met.begin(), 0);
        ASSERT_LT(*met.rbegin(), pass.sets());
      }
  }
}

// Clipping takes light away, compensation gives it back, and where nothing is near neither matters.
TEST(InstantRadiosity, ClippedIsDarkerCompensatedIsPath) {
  Scene scene = make_cornell_box();
  World world(scene);
  Lights lights = make_lights(world);
  // The lamp itself is out of sight.
  View view = make_view_towards(scene, {0, 0.25, 0.4}, {0, 0.12, -0.4}, {0, 1, 0}, 0.6f, 24, 18);
  TransportSettings settings, clipped;
  settings.max_depth = clipped.max_depth = 5;
  settings.instant.clip = clipped.instant.clip = 0.15f;
  clipped.instant.compensate = false;
  Estimate path =
      estimate_radiance(*find_technique("path"), world, lights, view, settings, {24, 24, 1});
  Estimate full = estimate_radiance(instant(), world, lights, view, settings, {36, 6, 2});
  Estimate less = estimate_radiance(instant(), world, lights, view, clipped, {24, 3, 3});
  Family same;
  same.add_same("compensated", full, path);
  expect_family(same, 0.02);
  double error = std::hypot(less.error, path.error);
  EXPECT_LT(less.mean, path.mean - significance_z * error);

  // Direct light of a lamp far beyond the clip distance: clipping has nothing to take.
  clipped.max_depth = settings.max_depth = 2;
  view = make_view_towards(scene, {0, 0.3, -0.1}, {0, 0, -0.2}, {0, 1, 0}, 0.3f, 12, 12);
  Family inactive;
  inactive.add_same(
      "clip is inactive", estimate_radiance(instant(), world, lights, view, clipped, {24, 4, 3}),
      estimate_radiance(*find_technique("path"), world, lights, view, settings, {24, 16, 1}));
  expect_family(inactive, 0.02);
}

TEST(InstantRadiosity, SamplesAloneAreTheSameBitsAsTogether) {
  Scene scene = make_cornell_box();
  add_mesh(scene, sphere_mesh(add_material(scene, glass(1.5f, 0, 1)), 0.06f), "glass ball",
           at({0.15f, 0.06f, -0.02f}));
  add_mesh(scene, sphere_mesh(add_material(scene, plastic({0.6f, 0.5f, 0.4f}, 0.4f)), 0.06f),
           "plastic ball", at({-0.15f, 0.06f, -0.02f}));
  add_quad(scene, add_material(scene, glass(1.5f, 0, 0)), {-0.28f, 0, -0.1f}, {0.2f, 0, 0},
           {0, 0.4f, 0}, "pane");
  World world(scene);
  Lights lights = make_lights(world);
  View view = cornell_view(scene, 48, 36);
  StillSettings settings;
  settings.transport.instant.photons = 300;
  settings.seed = 21;
  std::vector<Request> requests;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++)
      requests.push_back(pixel_request(view, settings.seed, x, y, 3));
  std::vector<Sample> samples(requests.size());
  Lights begun = lights;
  instant().begin_pass(world, settings.transport, view, pass_seed(settings.seed), 3, begun);
  trace(instant(), world, begun, settings.transport, requests, samples);
  for (size_t i = 0; i < requests.size(); i += 7) {
    int x = int(i) % view.width, y = int(i) / view.width;
    Sample alone = replay_sample(instant(), world, lights, view, settings, x, y, 3);
    ASSERT_EQ(alone.smooth, samples[i].smooth) << x << "," << y;
    ASSERT_EQ(alone.rest, samples[i].rest) << x << "," << y;
    ASSERT_EQ(alone.albedo, samples[i].albedo) << x << "," << y;
  }
}

TEST(InstantRadiosity, WithoutAPassItShowsWhatTheEyeFindsItself) {
  Scene scene = make_cornell_box();
  World world(scene);
  Lights lights = make_lights(world);
  Request request;
  request.ray = ray_towards({0, 0.275f, 0.8f}, {0, 0.1f, -0.5f});
  EXPECT_EQ(instant().trace(world, lights, {}, request).radiance(), vec3(0));
  request.ray = ray_towards({0, 0.275f, 0.8f}, {0, 0.548f, -0.28f});  // the lamp
  EXPECT_GT(instant().trace(world, lights, {}, request).radiance().x, 10);
}

TEST(InstantRadiosity, SurvivesOddScenes) {
  Scene dark = make_cornell_box();
  for (Material& material : dark.materials) {
    material.emission = vec3(0);
    material.base_color = vec4(0, 0, 0, 1);
  }
  expect_dark_and_finite(dark, cornell_view(dark, 9, 7), "black, without lights");
  Scene unlit_by_anything = make_cornell_box();
  for (Material& material : unlit_by_anything.materials) material.emission = vec3(0);
  expect_dark_and_finite(unlit_by_anything, cornell_view(dark, 9, 7), "no lights");
  Scene nothing = empty_scene();
  expect_dark_and_finite(nothing, cornell_view(nothing, 5, 5), "nothing at all");

  Scene crowded = make_cornell_box();
  for (int i = 0; i < 3000; i++) {
    PunctualLight light;
    light.position = {-0.25f + 0.0001f * float(i), 0.3f, -0.2f};
    light.intensity = vec3(1e-4f);
    crowded.lights.push_back(light);
  }
  expect_dark_and_finite(crowded, cornell_view(crowded, 9, 7), "thousands of lights", false);

  Scene inside = make_cornell_box();
  add_mesh(inside, sphere_mesh(add_material(inside, glass(1.5f, 0, 1)), 0.3f), "glass",
           at({0, 0.275f, 0.8f}));
  expect_dark_and_finite(inside, cornell_view(inside, 9, 7), "the eye in glass", false);
}

// Sunlight that a wall throws on the floor in its own shade, of a sun alone and in a plain sky.
TEST(InstantRadiosity, SunlightBetweenSurfacesIsPaths) {
  Family family;
  for (float sky : {0.0f, 0.05f}) {
    Scene scene = empty_scene();
    add_floor(scene, 0.5f);
    Material white = diffuse(vec3(0.8f));
    white.double_sided = true;
    int wall = add_material(scene, white);
    add_quad(scene, wall, {-2, 0, -1}, {4, 0, 0}, {0, 2, 0}, "sunlit wall");
    add_quad(scene, wall, {-2, 0, 1}, {4, 0, 0}, {0, 1, 0}, "wall that throws a shadow");
    scene.environment.radiance = vec3(sky);
    scene.environment.sun = {normalize(vec3(0.1f, 1, 1)), vec3(4e4f), 0.0046f};
    World world(scene);
    Lights lights = make_lights(world);
    View view = make_view_towards(scene, {0, 1.5, 0.6}, {0, 0, 0.6}, {0, 0, -1}, 0.1f, 6, 6);
    TransportSettings settings;
    settings.max_depth = 4;
    family.add_same(
        "sky " + std::to_string(sky),
        estimate_radiance(instant(), world, lights, view, settings, {24, 64, 1}),
        estimate_radiance(*find_technique("path"), world, lights, view, settings, {24, 64, 2}));
  }
  expect_family(family, 0.05);
}
