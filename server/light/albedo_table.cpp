// SPDX-License-Identifier: Apache-2.0
#include "light/albedo_table.h"

#include <array>
#include <memory>
#include <mutex>

#include "light/microfacet.h"

namespace wellspring {
namespace {

constexpr int index_steps = 128;  // over (n - 1) / (n + 1) in [0, 1]; the last is a mirror

// Mean of reflectance times shadowing over the visible normals, on a fixed grid of numbers.
float integrate(float cosine, float alpha, float eta, bool mirror) {
  if (alpha <= 0) return mirror ? 1 : fresnel_dielectric(cosine, eta);
  constexpr int steps = 24;
  vec3 v(std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine);
  double sum = 0;
  for (int i = 0; i < steps; i++)
    for (int j = 0; j < steps; j++) {
      vec2 u((float(i) + 0.5f) / steps, (float(j) + 0.5f) / steps);
      vec3 h = sample_visible_normal(v, alpha, u);
      float c = dot(v, h);
      vec3 l = 2 * c * h - v;
      if (l.z <= 0) continue;
      float reflectance = mirror ? 1 : fresnel_dielectric(std::min(c, 1.0f), eta);
      sum += double(reflectance * ggx_shadowing(v, l, alpha) / ggx_masking(v, alpha));
    }
  return float(sum / (steps * steps));
}

std::unique_ptr<AlbedoTable> make_table(float eta, bool mirror) {
  auto table = std::make_unique<AlbedoTable>();
  for (int r = 0; r < AlbedoTable::roughnesses; r++) {
    float root = float(r) / (AlbedoTable::roughnesses - 1);
    for (int a = 0; a < AlbedoTable::angles; a++) {
      float t = float(a) / (AlbedoTable::angles - 1);
      table->reflected[r][a] = integrate(std::max(t * t, 1e-4f), root * root, eta, mirror);
    }
    AlbedoRow row{table->reflected[r], table->reflected[r], 0, 0};
    double sum = 0;
    constexpr int steps = 512;
    for (int i = 0; i < steps; i++) {
      float cosine = (float(i) + 0.5f) / steps;
      sum += 2.0 * double(cosine * eval_albedo(row, cosine)) / steps;
    }
    table->average[r] = float(sum);
  }
  return table;
}

const AlbedoTable& table_of(int step) {
  static std::mutex mutex;
  static std::array<std::unique_ptr<AlbedoTable>, index_steps + 1> tables;
  std::lock_guard lock(mutex);
  auto& table = tables[size_t(step)];
  if (!table) {
    float root = float(step) / index_steps;
    bool mirror = step == index_steps;
    table = make_table(mirror ? 1 : (1 + root) / (1 - root), mirror);
  }
  return *table;
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

const AlbedoTable& dielectric_albedo(float ior) {
  float root = ior > 1 ? (ior - 1) / (ior + 1) : 0;
  return table_of(std::min(int(root * index_steps + 0.5f), index_steps));
}

const AlbedoTable& mirror_albedo() {
  static const AlbedoTable& table = table_of(index_steps);  // no lock in the shading loop
  return table;
}

}  // namespace wellspring
