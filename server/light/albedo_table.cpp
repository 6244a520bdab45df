// SPDX-License-Identifier: Apache-2.0
#include "light/albedo_table.h"

#include <array>
#include <memory>
#include <mutex>

#include "light/microfacet.h"

namespace wellspring {
namespace {

constexpr int index_steps = 128;  // over (n - 1) / (n + 1) in [0, 1]; the last is a mirror

enum class Kind { mirror, coat, glass };

// Mean over the visible normals, on a Fibonacci lattice of numbers, of what is reflected (and for
// glass refracted) times its shadowing.
float integrate(float cosine, float alpha, float eta, Kind kind) {
  if (alpha <= 0) return kind == Kind::coat ? fresnel_dielectric(cosine, eta) : 1;
  constexpr int points = 610, generator = 377;
  vec3 v(std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine);
  double sum = 0;
  for (int i = 0; i < points; i++) {
    vec2 u(float(i * generator % points) / points, (float(i) + 0.5f) / points);
    vec3 h = sample_visible_normal(v, alpha, u);
    float c = std::min(dot(v, h), 1.0f), f = kind == Kind::mirror ? 1 : fresnel_dielectric(c, eta);
    vec3 reflected = 2 * c * h - v;
    float kept = reflected.z > 0 ? f * ggx_shadowing(v, reflected, alpha) : 0;
    vec3 refracted;
    if (kind == Kind::glass && refract_at(v, h, eta, refracted) && refracted.z < 0)
      kept += (1 - f) * ggx_shadowing(v, {refracted.x, refracted.y, -refracted.z}, alpha);
    sum += double(kept / ggx_masking(v, alpha));
  }
  return float(sum / points);
}

void fill(AlbedoTable& table, float eta, Kind kind) {
  for (int r = 0; r < AlbedoTable::roughnesses; r++) {
    float root = float(r) / (AlbedoTable::roughnesses - 1);
    for (int a = 0; a < AlbedoTable::angles; a++) {
      float t = float(a) / (AlbedoTable::angles - 1);
      table.reflected[r][a] = integrate(std::max(t * t, 1e-4f), root * root, eta, kind);
    }
    AlbedoRow row{table.reflected[r], table.reflected[r], 0, 0};
    double sum = 0;
    constexpr int steps = 512;
    for (int i = 0; i < steps; i++) {
      float cosine = (float(i) + 0.5f) / steps;
      sum += 2.0 * double(cosine * eval_albedo(row, cosine)) / steps;
    }
    table.average[r] = float(sum);
  }
}

std::unique_ptr<DielectricAlbedo> make_dielectric(int step) {
  auto tables = std::make_unique<DielectricAlbedo>();
  float root = float(step) / index_steps, eta = (1 + root) / (1 - root);
  bool mirror = step == index_steps;  // an infinite index
  fill(tables->coat, eta, mirror ? Kind::mirror : Kind::coat);
  fill(tables->into, eta, mirror ? Kind::mirror : Kind::glass);
  fill(tables->out_of, 1 / eta, mirror ? Kind::mirror : Kind::glass);
  return tables;
}

}  // namespace

AlbedoRow albedo_row(const AlbedoTable& table, float alpha) {
  float position = std::sqrt(glm::clamp(alpha, 0.0f, 1.0f)) * (AlbedoTable::roughnesses - 1);
  int low = std::min(int(position), AlbedoTable::roughnesses - 2);
  float weight = position - float(low);
  return {table.reflected[low], table.reflected[low + 1], weight,
          glm::mix(table.average[low], table.average[low + 1], weight)};
}

float eval_albedo(const AlbedoRow& row, float cosine) {
  float position = std::sqrt(glm::clamp(cosine, 0.0f, 1.0f)) * (AlbedoTable::angles - 1);
  int low = std::min(int(position), AlbedoTable::angles - 2);
  float weight = position - float(low);
  return glm::mix(glm::mix(row.low[low], row.low[low + 1], weight),
                  glm::mix(row.high[low], row.high[low + 1], weight), row.weight);
}

const DielectricAlbedo& dielectric_albedo(float ior) {
  static std::mutex mutex;
  static std::array<std::unique_ptr<DielectricAlbedo>, index_steps + 1> tables;
  float root = ior > 1 ? (ior - 1) / (ior + 1) : 0;
  int step = std::min(int(root * index_steps + 0.5f), index_steps);
  std::lock_guard lock(mutex);
  auto& entry = tables[size_t(step)];
  if (!entry) entry = make_dielectric(step);
  return *entry;
}

const AlbedoTable& mirror_albedo() {
  static const AlbedoTable table = [] {  // no lock in the shading loop
    AlbedoTable made;
    fill(made, 1, Kind::mirror);
    return made;
  }();
  return table;
}

}  // namespace wellspring
