// SPDX-License-Identifier: Apache-2.0
#include "light/material/bsdf_layers.h"

#include <algorithm>
#include <cmath>

#include "light/material/bsdf_frame.h"
#include "light/material/bsdf_gloss.h"
#include "light/material/microfacet.h"

namespace wellspring::light {
namespace {

constexpr float clearcoat_index = 1.5f;
constexpr float least_sheen_roughness = 0.07f;

vec3 in_frame(const Clearcoat& c, vec3 w) {
  return {dot(w, c.tangent), dot(w, c.bitangent), dot(w, c.normal)};
}
vec3 from_frame(const Clearcoat& c, vec3 w) {
  return c.tangent * w.x + c.bitangent * w.y + c.normal * w.z;
}

float clearcoat_reflects(float cosine, float alpha) {
  if (alpha == 0) return fresnel_dielectric(cosine, clearcoat_index);
  static const DielectricAlbedo& albedo = dielectric_albedo(clearcoat_index, false);
  float t = std::sqrt(cosine);
  float loss = eval_loss(albedo_row(mirror_loss(), alpha), std::sqrt(alpha), t);
  return (1 - loss) * eval_row(albedo_row(albedo.fresnel, alpha), t);
}

void eval_clearcoat(const Bsdf& b, vec3 direction, vec3& value, float& pdf) {
  const Clearcoat& c = b.clearcoat;
  vec3 l = in_frame(c, direction);
  if (l.z <= 1e-6f) return;
  vec3 h = normalize(c.view + l);
  float d = ggx_distribution(h, vec2(c.alpha)) / (4 * c.view.z);
  float masked = ggx_lambda(c.view, vec2(c.alpha)), hidden = ggx_lambda(l, vec2(c.alpha));
  float f = fresnel_dielectric(std::min(dot(c.view, h), 1.0f), clearcoat_index);
  value += vec3(c.strength * f * d / (1 + masked + hidden));
  pdf += c.share * d / (1 + masked);
}

// Equation 3 and table 1 of the paper: the logarithm of the masking function.
float sheen_curve(float x, float blend) {
  auto mixed = [&](float smooth, float rough) { return glm::mix(rough, smooth, blend); };
  float a = mixed(25.3245f, 21.5473f), b = mixed(3.32435f, 3.82987f), c = mixed(0.16801f, 0.19823f);
  float d = mixed(-1.27393f, -1.97760f), e = mixed(-4.85967f, -4.32054f);
  return a / (1 + b * std::pow(x, c)) + d * x + e;
}
float sheen_lambda(float cosine, float alpha) {
  float blend = (1 - alpha) * (1 - alpha);
  if (cosine < 0.5f) return std::exp(sheen_curve(cosine, blend));
  return std::exp(2 * sheen_curve(0.5f, blend) - sheen_curve(1 - cosine, blend));
}

// Both directions with z > 0; with the cosine of l.
float eval_white_sheen(vec3 v, vec3 l, float alpha) {
  vec3 h = normalize(v + l);
  float sine2 = std::max(h.x * h.x + h.y * h.y, 0.0f), power = 1 / alpha;
  float distribution = (2 + power) * std::pow(sine2, 0.5f * power) / (2 * pi);
  float seen =
      1 / (1 + sheen_lambda(std::min(v.z, 1.0f), alpha) + sheen_lambda(std::min(l.z, 1.0f), alpha));
  return distribution * seen / (4 * v.z);
}

// Directional albedo by sqrt(cosine) and the root of the perceptual roughness above the least.
struct SheenTable {
  static constexpr int angles = 32, roughnesses = 24;
  float value[roughnesses][angles];
};

SheenTable make_sheen_table() {
  SheenTable table;
  constexpr int around = 16, down = 48;
  for (int r = 0; r < SheenTable::roughnesses; r++) {
    float y = float(r) / (SheenTable::roughnesses - 1);
    float root = glm::mix(least_sheen_roughness, 1.0f, y * y);
    for (int a = 0; a < SheenTable::angles; a++) {
      float t = float(a) / (SheenTable::angles - 1), cosine = std::max(t * t, 1e-4f);
      vec3 v(std::sqrt(1 - cosine * cosine), 0, cosine);
      double sum = 0;
      for (int i = 0; i < around; i++)
        for (int j = 0; j < down; j++) {
          // Half the azimuths, by symmetry; closely spaced near the horizon and near the viewer's
          // plane, where smooth sheen is bright.
          float x = (float(i) + 0.5f) / around, phi = pi * x * x * (3 - 2 * x);
          float s = (float(j) + 0.5f) / down, z = s * s, radius = std::sqrt(1 - z * z);
          vec3 l(radius * std::cos(phi), radius * std::sin(phi), z);
          sum += double(eval_white_sheen(v, l, root * root) * 2 * pi * 6 * x * (1 - x) * 2 * s);
        }
      table.value[r][a] = float(sum / (around * down));
    }
  }
  return table;
}

}  // namespace

float sheen_albedo(float cosine, float alpha) {
  static const SheenTable table = make_sheen_table();
  constexpr int rows = SheenTable::roughnesses, columns = SheenTable::angles;
  float above = (std::sqrt(alpha) - least_sheen_roughness) / (1 - least_sheen_roughness);
  float y = std::sqrt(glm::clamp(above, 0.0f, 1.0f)) * (rows - 1);
  float x = std::sqrt(glm::clamp(cosine, 0.0f, 1.0f)) * (columns - 1);
  int row = glm::clamp(int(y), 0, rows - 2), column = std::min(int(x), columns - 2);
  float down = glm::clamp(y - float(row), 0.0f, 1.0f), along = x - float(column);
  auto at = [&](int i) {
    return glm::mix(table.value[i][column], table.value[i][column + 1], along);
  };
  return glm::mix(at(row), at(row + 1), down);
}

void set_layers(Bsdf& b, const Surface& surface, vec3 view) {
  vec3 color = clean(surface.sheen_color);
  float brightest = max_component(color);
  float sheen = 0;
  if (brightest > 0) {
    b.sheen.color = color;
    float root = surface.sheen_roughness > least_sheen_roughness ? surface.sheen_roughness
                                                                 : least_sheen_roughness;
    b.sheen.alpha = std::min(root * root, 1.0f);
    sheen = brightest * sheen_albedo(b.view.z, b.sheen.alpha);
    if (sheen > 1) b.sheen.color /= sheen;
    sheen = std::min(sheen, 1.0f);
    b.beneath = 1 - sheen;
  }
  Clearcoat& c = b.clearcoat;
  float coat = 0;
  if (surface.clearcoat > 0) {
    c.strength = std::min(surface.clearcoat, 1.0f);
    c.alpha = alpha_of(surface.clearcoat_roughness);
    c.normal = usable_normal(surface.clearcoat_normal, surface.geometric_normal, view);
    make_frame_axes(c.normal, c.tangent, c.bitangent);
    c.view = in_frame(c, view);
    c.view.z = glm::clamp(c.view.z, 1e-4f, 1.0f);
    coat = c.strength * clearcoat_reflects(c.view.z, c.alpha);
    c.reflected = coat;
    b.sheen.color *= 1 - coat;
    b.beneath *= 1 - coat;
  }
  // Chances by what each reflects, of what the specular lobes reflect in all.
  float base = 0;
  if (has_gloss(b)) {
    bool strong = b.metallic > 0 || max_component(b.transmit) > 0;
    base = b.beneath * (strong ? 1 : std::max(1 - b.coat_passes, 0.05f));
  }
  float sum = coat + sheen * (1 - coat) + base;
  if (!(sum > 0)) return;
  c.share = coat / sum;
  b.sheen.share = sheen * (1 - coat) / sum;
}

void eval_layers(const Bsdf& b, vec3 direction, vec3& value, float& pdf) {
  if (has_clearcoat(b) && b.clearcoat.alpha > 0) eval_clearcoat(b, direction, value, pdf);
  if (!has_sheen(b)) return;
  vec3 l(dot(direction, b.tangent), dot(direction, b.bitangent), dot(direction, b.normal));
  if (l.z <= 1e-6f) return;
  value += b.sheen.color * eval_white_sheen(b.view, l, b.sheen.alpha);
  pdf += b.sheen.share / (4 * pi * std::sqrt(l.z));
}

BsdfSample eval_clearcoat_mirror(const Bsdf& b) {
  const Clearcoat& c = b.clearcoat;
  BsdfSample s;
  s.direction = from_frame(c, {-c.view.x, -c.view.y, c.view.z});
  if (dot(s.direction, b.geometric_normal) > 0) s.weight = vec3(c.reflected);
  return s;
}

vec3 sample_clearcoat(const Bsdf& b, Sampler& sampler) {
  const Clearcoat& c = b.clearcoat;
  vec3 h = sample_visible_normal(c.view, vec2(c.alpha), sampler.next2());
  float cosine = dot(c.view, h);
  vec3 l = 2 * cosine * h - c.view;
  return cosine > 0 && l.z > 0 ? from_frame(c, l) : vec3(0);
}

vec3 sample_sheen(const Bsdf& b, Sampler& sampler) {
  vec2 u = sampler.next2();
  float z = u.x * u.x, radius = std::sqrt(1 - z * z), phi = 2 * pi * u.y;
  vec3 l(radius * std::cos(phi), radius * std::sin(phi), z);
  return b.tangent * l.x + b.bitangent * l.y + b.normal * l.z;
}

}  // namespace wellspring::light
