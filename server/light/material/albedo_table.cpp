// SPDX-License-Identifier: Apache-2.0
#include "light/material/albedo_table.h"

#include <array>
#include <atomic>
#include <mutex>
#include <utility>

#include "light/material/microfacet.h"

namespace wellspring::light {
namespace {

constexpr int index_steps = 512;  // over (n - 1) / (n + 1) in [0, 1]; the last is a mirror
constexpr int angles = AlbedoTable::angles, roughnesses = AlbedoTable::roughnesses;
constexpr int table_points = 610, glass_points = 987;

float root_of_row(float row) {
  float least = std::sqrt(smooth_alpha);
  return least + (1 - least) * row / (roughnesses - 1);
}

vec3 tilted(float cosine) { return {std::sqrt(std::max(0.0f, 1 - cosine * cosine)), 0, cosine}; }

// Returns 2 * integral of value(cosine) * cosine, closely spaced near the horizon.
template <class Value>
float hemisphere_average(const Value& value) {
  constexpr int steps = 256;
  double sum = 0;
  for (int i = 0; i < steps; i++) {
    double t = (i + 0.5) / steps;
    sum += 4 * t * t * t * double(value(float(t * t))) / steps;
  }
  return float(sum);
}

// Sets the averages. `value`(row, root of alpha, root of cosine) returns the table's value.
template <class Value>
void set_averages(AlbedoTable& table, const Value& value) {
  for (int i = 0; i < AlbedoTable::averages; i++) {
    float root = root_of_row(float(i) * (roughnesses - 1) / (AlbedoTable::averages - 1));
    AlbedoRow row = albedo_row(table, root * root);
    table.average[i] =
        hemisphere_average([&](float cosine) { return value(row, root, std::sqrt(cosine)); });
  }
}

// Makes a table over t / (t + r). Columns of cosines beyond 1 go on as the row ends, for
// interpolation.
template <class Value>
AlbedoTable loss_table(const Value& kept) {
  constexpr float step = 1.0f / (angles - 1);
  AlbedoTable table{};
  for (int r = 0; r < roughnesses; r++) {
    float root = root_of_row(float(r)), end = 1 / (1 + root);
    float at_end = 1 - kept(tilted(1), root * root);
    float* row = table.value[r];
    int last = std::min(int(end / step - 0.3f), angles - 1);
    for (int a = 0; a <= last; a++) {
      float x = float(a) * step, t = root * x / (1 - x);
      row[a] = 1 - kept(tilted(std::max(t * t, 1e-6f)), root * root);
    }
    float slope = (at_end - row[last]) / (end - float(last) * step);
    for (int a = last + 1; a < angles; a++) row[a] = row[last] + slope * (float(a - last) * step);
  }
  set_averages(table,
               [](const AlbedoRow& row, float root, float t) { return eval_loss(row, root, t); });
  return table;
}

std::unique_ptr<DielectricAlbedo> make_dielectric(float eta) {
  auto made = std::make_unique<DielectricAlbedo>();
  made->fresnel_average =
      hemisphere_average([&](float cosine) { return fresnel_dielectric(cosine, eta); });
  for (int r = 0; r < roughnesses; r++) {
    float root = root_of_row(float(r));
    for (int a = 0; a < angles; a++) {
      float t = float(a) / (angles - 1);
      FacetAlbedo sum =
          sum_albedo(tilted(std::max(t * t, 1e-6f)), vec2(root * root), eta, false, table_points);
      made->fresnel.value[r][a] = sum.kept > 0 ? sum.reflected / sum.kept : 0;
    }
  }
  set_averages(made->fresnel, [](const AlbedoRow& row, float root, float t) {
    return eval_row(row, t) * (1 - eval_loss(albedo_row(mirror_loss(), root * root), root, t));
  });
  return made;
}

}  // namespace

// The points are a Fibonacci lattice over the numbers that sample_visible_normal takes.
FacetAlbedo sum_albedo(vec3 v, vec2 alpha, float eta, bool glass, int points) {
  int generator = 1;
  for (int next = 1; next < points;) next += std::exchange(generator, next);
  double kept = 0, reflected = 0, passed = 0;
  float lambda = ggx_lambda(v, alpha);
  for (int i = 0; i < points; i++) {
    vec2 u(float(i * generator % points) / float(points), (float(i) + 0.5f) / float(points));
    vec3 h = sample_visible_normal(v, alpha, u);
    float cosine = std::min(dot(v, h), 1.0f);
    if (cosine <= 0) continue;
    float f = fresnel_dielectric(cosine, eta);
    vec3 l = 2 * cosine * h - v;
    if (l.z > 0) {
      double part = double((1 + lambda) / (1 + lambda + ggx_lambda(l, alpha)));
      kept += part;
      reflected += part * double(f);
    }
    if (!glass || !refract_at(v, h, eta, l) || l.z >= 0) continue;
    passed += double((1 - f) * (1 + lambda) / (1 + lambda + ggx_lambda(l, alpha)));
  }
  return {float(kept / points), float(reflected / points), float((reflected + passed) / points)};
}

AlbedoPlace albedo_place(float root_alpha) {
  const float least = std::sqrt(smooth_alpha), root = glm::clamp(root_alpha, least, 1.0f);
  float position = (root - least) * ((roughnesses - 1) / (1 - least));
  int low = std::min(int(position), roughnesses - 2);
  float fine = position * ((AlbedoTable::averages - 1) / (roughnesses - 1));
  int at = std::min(int(fine), AlbedoTable::averages - 2);
  return {low, at, position - float(low), fine - float(at)};
}

const AlbedoTable& mirror_loss() {
  static const AlbedoTable table = loss_table([](vec3 v, float alpha) {
    return sum_albedo(v, vec2(alpha), 1.5f, false, table_points).kept;
  });
  return table;
}

const DielectricAlbedo& dielectric_albedo(float ior, bool glass) {
  static std::mutex mutex;
  static std::array<std::unique_ptr<DielectricAlbedo>, index_steps + 1> tables;
  static std::array<std::atomic<const DielectricAlbedo*>, index_steps + 1> made[2];  // with glass
  float root = ior > 1 ? (ior - 1) / (ior + 1) : ior == 0 ? 1 : 0;
  int step = std::min(int(root * index_steps + 0.5f), index_steps);
  float rounded = float(step) / index_steps;
  float eta = step == index_steps ? 1e6f : (1 + rounded) / (1 - rounded);
  if (const DielectricAlbedo* known = made[glass][size_t(step)].load(std::memory_order_acquire))
    return *known;
  std::lock_guard lock(mutex);
  auto& entry = tables[size_t(step)];
  if (!entry) entry = make_dielectric(eta);
  if (glass && !entry->glass) {
    auto losses = [](float over) {
      return loss_table([over](vec3 v, float alpha) {
        return sum_albedo(v, vec2(alpha), over, true, glass_points).passed;
      });
    };
    entry->glass.reset(new DielectricAlbedo::Glass{losses(eta), losses(1 / eta)});
  }
  made[glass][size_t(step)].store(entry.get(), std::memory_order_release);
  return *entry;
}

}  // namespace wellspring::light
