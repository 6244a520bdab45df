// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "unit/light/judge.h"
#include "light/virtual/caustic_photons.h"
#include "light/sample/caustic_casters.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

// A glass ball between a lamp and a floor.
Scene make_ball_scene(Material ball, float lamp = 0.5f) {
  Scene scene = empty_scene();
  add_quad(scene, add_material(scene, diffuse(vec3(0.6f))), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2},
           "floor");
  add_mesh(scene, sphere_mesh(add_material(scene, std::move(ball)), 0.25f, 24), "ball",
           at({0, 0.4f, 0}));
  add_quad(scene, add_material(scene, emitter(vec3(6))), {-lamp, 1.5f, -lamp}, {2 * lamp, 0, 0},
           {0, 0, 2 * lamp}, "lamp");
  return scene;
}

std::vector<Photon> shoot(const Transport& transport, int count, uint64_t seed, int max_depth = 8) {
  return shoot_caustic_photons(transport, transport.tables.casters, max_depth, seed, 0, count,
                               1 / float(count));
}

}  // namespace

TEST(PhotonGrid, FindsWhatAnExactSearchFinds) {
  Rng rng(5);
  for (float radius : {0.01f, 0.1f, 3.0f}) {
    std::vector<Photon> photons;
    for (int i = 0; i < 3000; i++) {
      Photon p;
      p.position = {2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
      if (i % 3 == 0) p.position *= 0.05f;                                    // a dense place
      if (i % 5 == 0) p.position = glm::round(p.position / radius) * radius;  // on cells' edges
      p.flux = vec3(float(i));                                                // its name
      photons.push_back(p);
    }
    PhotonCells cells;  // kept from query to query
    photons[7].position.x = std::numeric_limits<float>::quiet_NaN();
    PhotonGrid grid = make_photon_grid(photons, radius);
    EXPECT_EQ(grid.size(), photons.size() - 1);
    for (int q = 0; q < 300; q++) {
      if (q % 7 == 0) cells = {};
      vec3 place = q % 2 ? photons[size_t(q + 8)].position
                         : vec3(rng.uniform(), -rng.uniform(), rng.uniform());
      std::multiset<int> found, exact;
      for_each_photon(grid, place, cells, [&](const Photon& p) { found.insert(int(p.flux.x)); });
      for (const Photon& p : photons) {
        vec3 d = p.position - place;
        if (dot(d, d) <= radius * radius) exact.insert(int(p.flux.x));
      }
      ASSERT_EQ(found, exact);
    }
  }
  PhotonGrid empty = make_photon_grid({}, 1);
  PhotonCells none;
  for_each_photon(empty, vec3(0), none, [](const Photon&) { FAIL(); });
}

TEST(CausticPhotons, CastersHoldWhatIsSharpAndNothingElse) {
  Scene scene = make_ball_scene(glass(1.5f, 0, 1));
  World world(scene);
  Lights lights = make_lights(world);
  ASSERT_FALSE(lights.tables->casters.empty());
  for (vec3 p : scene.meshes[1].positions) {
    p += vec3(0, 0.4f, 0);
    bool held = false;
    for (const CasterSphere& c : lights.tables->casters) held |= length(p - c.center) <= c.radius;
    ASSERT_TRUE(held);
  }
  for (const CasterSphere& c : lights.tables->casters) EXPECT_LT(c.radius, 0.5f);
  Scene lambertian = make_ball_scene(diffuse(vec3(0.5f)));
  World lambert_world(lambertian);
  Lights lambert_lights = make_lights(lambert_world);
  EXPECT_TRUE(lambert_lights.tables->casters.empty());
  EXPECT_TRUE(shoot({lambert_world, *lambert_lights.tables}, 1000, 1).empty());
}

// The density of directions is that of their choice: the mean of 1 / density over chosen directions
// is the solid angle of the spheres together, which overlap, and one of which holds the place.
TEST(CausticPhotons, DirectionsHaveTheirDensity) {
  std::vector<CasterSphere> casters{
      {{0, 0, -3}, 1, 1}, {{0.8f, 0, -3}, 1, 0.2f}, {{0, 4, 0}, 0.3f, 1}};
  for (bool inside : {false, true}) {
    if (inside) casters.push_back({{0, 0, 0.5f}, 1, 0.1f});
    Rng rng(3);
    Mean solid, uniform;
    for (int i = 0; i < 40000; i++) {
      vec3 d = sample_caster(casters, vec3(0), {rng.uniform(), rng.uniform()});
      float pdf = sample_caster_pdf(casters, vec3(0), d);
      ASSERT_GT(pdf, 0);
      ASSERT_NEAR(length(d), 1, 1e-4);
      solid.add(1 / double(pdf));
      float z = 2 * rng.uniform() - 1, phi = 2 * pi * rng.uniform(), r = std::sqrt(1 - z * z);
      uniform.add(sample_caster_pdf(casters, vec3(0), {r * std::cos(phi), r * std::sin(phi), z}) > 0
                      ? 4 * double(pi)
                      : 0.0);
    }
    expect_same_mean(solid, uniform, "solid angle of all spheres");
    EXPECT_LT(solid.error(), 0.02 * solid.mean());
  }
}

TEST(CausticPhotons, ArriveFromSharpThingsOnRoughOnes) {
  Scene scene = make_ball_scene(glass(1.5f, 0, 1));
  World world(scene);
  Lights lights = make_lights(world);
  std::vector<Photon> photons = shoot({world, *lights.tables}, 5000, 1);
  ASSERT_GT(photons.size(), 500u);
  for (const Photon& p : photons) {
    ASSERT_NEAR(p.position.y, 0, 1e-4);  // on the floor: the lamp is black, the ball is not rough
    ASSERT_EQ(p.depth, 1u);              // solid glass adds no edge to its path
    Ray back;
    back.origin = p.position + 1e-4f * p.direction;
    back.direction = p.direction;
    Hit hit = world.intersect(back);
    ASSERT_TRUE(hit.valid());
    ASSERT_EQ(hit.instance, 1u);  // the ball
  }
  for (const Photon& p : shoot({world, *lights.tables}, 2000, 1, 3))
    ASSERT_LE(p.depth, 2u);  // with the eye's edge three: reflected only
}

// All ways of light together are what `path` finds: no path is missing, none counts twice. The
// floor's mean, because that is where the density estimate, which only moves light about, has no
// bias but for what it moves across the picture's border: stated as 0.5 %.
TEST(CausticPhotons, WithEverythingElseTheyArePath) {
  constexpr double border_bias = 0.005;
  struct {
    const char* name;
    Material ball;
  } cases[] = {{"glass", glass(1.5f, 0, 1)},
               {"mirror", metal({0.9f, 0.8f, 0.7f}, 0)},
               {"polished", metal({0.9f, 0.8f, 0.7f}, 0.2f)},
               {"varnish", plastic({0.2f, 0.5f, 0.3f}, 0.1f)}};
  for (const auto& c : cases) {
    Scene scene = make_ball_scene(c.ball);
    World world(scene);
    Lights lights = make_lights(world);
    View view = make_view_towards(scene, {0, 1.4, 1.2}, {0, 0.1, 0}, {0, 1, 0}, 0.8f, 24, 18);
    TransportSettings settings;
    settings.max_depth = 6;
    settings.instant.photons = 300;
    settings.instant.photon_radius = 0.02f;
    Estimate path =
        estimate_radiance(*find_technique("path"), world, lights, view, settings, {16, 48, 1});
    Estimate ours = estimate_radiance(*find_technique("instant_radiosity"), world, lights, view,
                                      settings, {16, 6, 2});
    double error = std::hypot(path.error, ours.error);
    EXPECT_LE(std::abs(path.mean - ours.mean), significance_z * error + border_bias * path.mean)
        << c.name << ": " << ours.mean << " +- " << ours.error << " against " << path.mean << " +- "
        << path.error;
    EXPECT_LT(error, 0.01 * path.mean) << c.name;
    // The caustic is a part that would be missed.
    settings.instant.photons = 0;
    if (c.ball.transmission > 0) {
      Estimate without = estimate_radiance(*find_technique("instant_radiosity"), world, lights,
                                           view, settings, {24, 2, 3});
      EXPECT_LT(without.mean, path.mean * (1 - 2 * border_bias) - significance_z * without.error);
    }
  }
}

TEST(CausticPhotons, RadiusShrinksAsItMust) {
  EXPECT_FLOAT_EQ(shrunk_radius(0.1f, 0), 0.1f);
  for (uint32_t i : {0u, 1u, 10u, 1000u}) {
    float a = shrunk_radius(0.1f, i), b = shrunk_radius(0.1f, i + 1);
    EXPECT_NEAR(double(b * b) / double(a * a), (i + 1 + 2.0 / 3) / (i + 2), 1e-3);
  }
}
