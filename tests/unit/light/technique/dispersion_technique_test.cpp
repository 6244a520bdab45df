// SPDX-License-Identifier: Apache-2.0
// Colours parted by glass, technique by technique: point lights and photons of instant_radiosity,
// whose walks carry wavelengths from the lamp, and its rays from the eye bring what `path` does,
// channel by channel, wherever the hues fall.
#include <array>
#include <optional>

#include "unit/light/judge.h"
#include "light/virtual/caustic_photons.h"
#include "light/material/microfacet.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

const SpectralTables& tables = *plain_spectral_tables();

Material flint(float roughness) {
  Material m = glass(1.6f, roughness, 1);
  m.dispersion = 2;  // an Abbe number of 10
  return m;
}

Mesh prism_mesh(int material) {
  const float half = 0.22f, side = 0.2f, height = 0.35f;
  vec3 a[3], b[3];
  for (int end = 0; end < 2; end++) {
    vec3* p = end ? b : a;
    float z = end ? -half : half;
    p[0] = {-side, 0, z}, p[1] = {side, 0, z}, p[2] = {0, height, z};
  }
  Mesh mesh{.material = material};
  for (int i = 0; i < 3; i++) {
    int k = (i + 1) % 3;
    append_quad(mesh, a[i], b[i] - a[i], a[k] - a[i]);
  }
  for (vec3* p : {a, b}) {
    vec3 normal(0, 0, p == a ? 1 : -1);
    uint32_t first = uint32_t(mesh.positions.size());
    for (int i = 0; i < 3; i++) {
      mesh.positions.push_back(p[i]);
      mesh.normals.push_back(normal);
    }
    if (p == a) mesh.triangles.push_back({first, first + 1, first + 2});
    else mesh.triangles.push_back({first, first + 2, first + 1});
  }
  return mesh;
}

// A prism above a floor, and a strip of a lamp that emits light through it onto a wall.
Scene make_prism_scene(Material prism, Material wall = diffuse(vec3(0.7f))) {
  Scene scene = empty_scene();
  int white = add_material(scene, diffuse(vec3(0.6f)));
  add_quad(scene, white, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, "floor");
  add_quad(scene, std::move(wall), {0.9f, 0, 1}, {0, 0, -2}, {0, 1.4f, 0}, "wall");
  add_mesh(scene, prism_mesh(add_material(scene, std::move(prism))), "prism", at({0, 0.35f, 0}));
  add_quad(scene, emitter(vec3(6)), {-0.9f, 0.2f, 0.5f}, {0, 0, -1}, {-0.15f, 0.45f, 0}, "lamp");
  return scene;
}

// Channels of the left and the right half of a picture: what glass parts lies on one side or the
// other.
using Colors = std::array<Estimate, 6>;
Colors estimate_colors(const char* name, const World& world, const Lights& lights, const View& view,
                       const TransportSettings& transport, const Effort& effort) {
  std::array<std::vector<double>, 6> replicates;
  for (auto& r : replicates) r.resize(size_t(effort.replicates));
  parallel_for(effort.replicates, [&](int i) {
    Frame frame = render_still(*find_technique(name), world, lights, view,
                               {.spp = effort.spp,
                                .seed = mix64(effort.seed * 1000003 + uint64_t(i)),
                                .transport = transport});
    for (int c = 0; c < 6; c++) {
      double sum = 0;
      for (size_t p = 0; p < frame.color.size(); p++) {
        bool right = int(p) % view.width >= view.width / 2;
        if (right == (c >= 3)) sum += double(frame.color[p][c % 3]);
      }
      replicates[size_t(c)][size_t(i)] = 2 * sum / double(frame.color.size());
    }
  });
  Colors colors;
  for (size_t c = 0; c < 6; c++) colors[c] = make_estimate(replicates[c]);
  return colors;
}

// The wall alone, with a spectrum on it; the prism before it, with what is seen through it; both
// again in a mirror, and through rough glass. Photons only move light about, which between the
// halves of a picture and across its border is stated as 1 %.
TEST(Dispersion, EveryTechniqueBringsTheSameColors) {
  constexpr double moved = 0.01;
  struct {
    const char* name;
    Scene scene;
    dvec3 eye, target;
  } cases[] = {
      {"a spectrum on the wall", make_prism_scene(flint(0)), {0.3, 0.7, 0}, {0.9, 0.4, 0}},
      {"through the prism", make_prism_scene(flint(0)), {-0.4, 0.8, 1.2}, {0.1, 0.4, 0}},
      {"in a mirror", make_prism_scene(flint(0), metal(vec3(0.9f), 0)), {0, 0.6, 1}, {0.9, 0.4, 0}},
      {"frosted", make_prism_scene(flint(0.6f)), {-0.3, 0.8, 1.2}, {0.2, 0.4, 0}},
  };
  TransportSettings settings{.max_depth = 6};
  settings.instant.photons = 300;
  settings.instant.photon_radius = 0.02f;
  for (auto& c : cases) {
    World world(c.scene);
    Lights lights = make_lights(world);
    View view = make_view_towards(c.scene, c.eye, c.target, {0, 1, 0}, 0.9f, 24, 18);
    Colors path = estimate_colors("path", world, lights, view, settings, {16, 64, 1});
    Colors ours = estimate_colors("instant_radiosity", world, lights, view, settings, {16, 16, 2});
    double brightest = 0;
    for (const Estimate& e : path) brightest = std::max(brightest, e.mean);
    for (size_t i = 0; i < 6; i++) {
      double error = std::hypot(path[i].error, ours[i].error);
      EXPECT_LE(std::abs(path[i].mean - ours[i].mean),
                significance_z * error + moved * path[i].mean)
          << c.name << ", half " << i / 3 << ", channel " << i % 3 << ": " << ours[i].mean << " +- "
          << ours[i].error << " against " << path[i].mean << " +- " << path[i].error;
      EXPECT_LT(error, 0.025 * brightest) << c.name;  // a wrong hue would be noticed
    }
    EXPECT_EQ(lights.bad_samples->load(), 0u) << c.name;
  }
}

// Parallel light of a hue through the left and the right face of the prism, by Snell's law and
// Fresnel's formula; nothing where the right face reflects all of it.
struct Passed {
  dvec3 inside, behind;  // its directions
  double share = 1;      // light that both faces let through
};
std::optional<Passed> pass_prism(const Material& glass_of_prism, float hue, dvec3 direction) {
  const double index = double(index_at(tables, glass_of_prism, wavelength_at(tables, hue)));
  Passed passed;
  auto refract = [&](dvec3 d, dvec3 n, double eta) -> std::optional<dvec3> {
    double c = -dot(n, d), k = 1 - eta * eta * (1 - c * c);
    if (k <= 0) return {};
    passed.share *= 1 - double(fresnel_dielectric(float(c), float(1 / eta)));
    return eta * d + (eta * c - std::sqrt(k)) * n;
  };
  const auto inside = refract(direction, normalize(dvec3(-0.35, 0.2, 0)), 1 / index);
  if (!inside) return {};
  const auto behind = refract(*inside, normalize(dvec3(-0.35, -0.2, 0)), index);
  if (!behind) return {};
  passed.inside = *inside, passed.behind = *behind;
  return passed;
}

// Parallel white light that goes through two faces of a prism near the least deviation comes out
// sorted: the shorter the wavelength, the farther it is bent towards the base. The mean direction
// of each channel is what Snell's law makes of the channel's response.
// The mean sine of the angles at which light leaves the prism, each channel by itself.
// In the plane across the prism: in through the left face at each of its places, out through the
// right one unless the base is met first, and what Fresnel's formula lets through.
glm::dvec3 expected_sines(const Material& glass_of_prism, vec3 sun_direction) {
  const dvec3 apex(0, 0.35, 0), left(-0.2, 0, 0), right(0.2, 0, 0);
  glm::dvec3 expected(0), weight(0);
  constexpr int wavelengths = 1024, places = 64;
  for (int i = 0; i < wavelengths; i++) {
    float hue = (float(i) + 0.5f) / wavelengths;
    const auto passed = pass_prism(glass_of_prism, hue, dvec3(sun_direction));
    if (!passed) continue;
    const dvec3& inside = passed->inside;
    int reach = 0;
    for (int k = 0; k < places; k++) {
      dvec3 from = glm::mix(left, apex, (k + 0.5) / places), along = apex - right;
      // from + t inside = right + s along
      double t = ((right.x - from.x) * along.y - (right.y - from.y) * along.x) /
                 (inside.x * along.y - inside.y * along.x);
      reach += from.y + t * inside.y > 0;
    }
    glm::dvec3 share = glm::dvec3(tables.shown[nanometre_of(wavelength_at(tables, hue))]) *
                       (passed->share * reach);
    expected += share * -passed->behind.y;
    weight += share;
  }
  return expected / weight;
}

TEST(Dispersion, PhotonsLeaveThePrismSortedByHue) {
  Material glass_of_prism = flint(0);
  Scene scene = make_prism_scene(glass_of_prism);
  scene.instances.pop_back();  // the lamp
  PunctualLight sun{.type = PunctualType::directional,
                    .direction = normalize(vec3(1, 0.35f, 0)),
                    .intensity = vec3(3)};
  scene.lights.push_back(sun);
  World world(scene);
  Lights lights = make_lights(world);
  std::vector<Photon> photons = shoot_caustic_photons(
      {world, *lights.tables}, lights.tables->casters, 8, 1, 0, 40000, 1.0f / 40000);
  // Photons that a face reflected are left out: they leave elsewhere.
  std::erase_if(photons, [&](const Photon& p) {
    const auto passed = pass_prism(glass_of_prism, p.hue, dvec3(sun.direction));
    return !passed || glm::length(dvec3(p.direction) + passed->behind) > 1e-3;
  });
  ASSERT_GT(photons.size(), 5000u);
  glm::dvec3 flux(0), sine(0), square(0);
  for (const Photon& p : photons) {
    flux += glm::dvec3(p.flux);
    sine += glm::dvec3(p.flux) * double(p.direction.y);
  }
  sine /= flux;
  for (const Photon& p : photons) {
    glm::dvec3 off = glm::dvec3(p.flux) * (double(p.direction.y) - sine) / flux;
    square += off * off;
  }
  const glm::dvec3 expected = expected_sines(glass_of_prism, sun.direction);
  for (int c = 0; c < 3; c++) {
    EXPECT_NEAR(sine[c], expected[c], significance_z * std::sqrt(square[c])) << "channel " << c;
    EXPECT_LT(std::sqrt(square[c]), 0.003) << "channel " << c;
  }
  EXPECT_LT(sine.x + 0.02, sine.y);
  EXPECT_LT(sine.y + 0.02, sine.z);
}

}  // namespace
}  // namespace wellspring::test
