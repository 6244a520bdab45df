// SPDX-License-Identifier: Apache-2.0
// Places made of a material, and every kind of material that the BSDF knows, for its tests.
#pragma once
#include <string>

#include "light/material/bsdf.h"
#include "scenes/build.h"

namespace wellspring::test {

// Normal +Y; brushed along X.
inline Surface surface_of(const Material& m, bool front = true) {
  Surface s;
  s.front = front;
  s.base_color = vec3(m.base_color);
  s.metallic = m.metallic;
  s.roughness = m.roughness;
  s.transmission = m.transmission;
  s.thickness = m.thickness;
  s.specular = m.specular;
  s.specular_color = m.specular_color;
  s.anisotropy = m.anisotropy;
  s.tangent = {std::cos(m.anisotropy_rotation), 0, -std::sin(m.anisotropy_rotation)};
  s.clearcoat = m.clearcoat;
  s.clearcoat_roughness = m.clearcoat_roughness;
  s.sheen_color = m.sheen_color;
  s.sheen_roughness = m.sheen_roughness;
  return s;
}

// `degrees` off the normal, towards X.
inline vec3 direction_at(float degrees, float azimuth = 0) {
  float a = glm::radians(degrees), b = glm::radians(azimuth);
  return {std::sin(a) * std::cos(b), std::cos(a), -std::sin(a) * std::sin(b)};
}

inline Bsdf bsdf_seen_from(const Material& m, vec3 viewer, bool front = true) {
  return make_bsdf(surface_of(m, front), m, -viewer, dielectric_albedo(m.ior));
}

// A place of that material seen from `degrees` off the normal.
inline Bsdf bsdf_of(const Material& m, float degrees, bool front = true, vec3 shading = {0, 1, 0}) {
  Surface s = surface_of(m, front);
  s.normal = normalize(shading);
  s.clearcoat_normal = s.normal;
  return make_bsdf(s, m, -direction_at(degrees), dielectric_albedo(m.ior));
}

struct Case {
  std::string name;
  Material material;
  bool front = true;
};

inline Material brushed(Material m, float strength, float degrees = 0) {
  m.anisotropy = strength;
  m.anisotropy_rotation = glm::radians(degrees);
  return m;
}
inline Material coated(Material m, float strength, float roughness) {
  m.clearcoat = strength;
  m.clearcoat_roughness = roughness;
  return m;
}
inline Material with_sheen(Material m, vec3 color, float roughness) {
  m.sheen_color = color;
  m.sheen_roughness = roughness;
  return m;
}
inline Material with_specular(Material m, float strength, vec3 color) {
  m.specular = strength;
  m.specular_color = color;
  return m;
}
inline Material half_metal(Material m) {
  m.metallic = 0.5f;
  return m;
}
inline Material half_clear(Material m) {
  m.transmission = 0.5f;
  return m;
}

// Everything that absorbs nothing, at one roughness.
inline std::vector<Case> white_cases(float r) {
  using namespace scenes;
  const vec3 white(1);
  std::vector<Case> cases = {
      {"metal", metal(white, r)},
      {"plastic", plastic(white, r)},
      {"dense plastic", plastic(white, r, 2.4f)},
      {"half metal", half_metal(plastic(white, r))},
      {"reflector of infinite index", plastic(white, r, 0)},
      {"pane", glass(1.5f, r, 0)},
      {"half clear pane", half_clear(glass(1.5f, r, 0))},
      {"glass", glass(1.5f, r, 1)},
      {"glass from inside", glass(1.5f, r, 1), false},
      {"diamond", glass(2.4f, r, 1)},
      {"diamond from inside", glass(2.4f, r, 1), false},
      {"milky glass", half_clear(glass(1.4f, r, 1))},
      {"milky glass from inside", half_clear(glass(1.4f, r, 1)), false},
      {"dull plastic", with_specular(plastic(white, r), 0.3f, white)},
      {"bright plastic", with_specular(plastic(white, r), 1, vec3(6))},
      {"coated metal", coated(metal(white, r), 1, 0)},
      {"rough coat on metal", coated(metal(white, 0.3f), 0.7f, r)},
      {"coated plastic", coated(plastic(white, 0.6f), 1, r)},
      {"coated glass", coated(glass(1.5f, 0.4f, 1), 1, r)},
      {"velvet", with_sheen(diffuse(white), white, r)},
      {"dusty metal", with_sheen(metal(white, 0.4f), vec3(0.5f), r)},
      {"coated velvet", coated(with_sheen(plastic(white, r), white, r), 1, 0.4f)},
      {"brushed metal", brushed(metal(white, r), 0.6f)},
      {"brushed across", brushed(metal(white, r), 1, 90)},
      {"brushed plastic", brushed(plastic(white, r), 0.8f, 30)},
      {"brushed glass", brushed(glass(1.5f, r, 1), 0.5f, 60)},
      {"brushed glass from inside", brushed(glass(1.5f, r, 1), 0.5f, 60), false},
      {"brushed pane", brushed(glass(1.5f, r, 0), 0.7f)},
  };
  for (Case& c : cases) c.name += " of roughness " + std::to_string(r).substr(0, 5);
  return cases;
}

// Energy, not radiance, of a sample: beyond a boundary radiance is eta^2 denser.
inline double energy_of(const Bsdf& bsdf, const BsdfSample& s) {
  return double(s.weight.y * (s.bounce == Bounce::refract ? bsdf.eta * bsdf.eta : 1));
}

}  // namespace wellspring::test
