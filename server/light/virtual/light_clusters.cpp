// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/light_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring::light {
namespace {

// Classes 0 to 5 are the six ways to face; lights without such a way have classes of their own, and
// double_sided and scattering are added.
constexpr uint32_t distant = 6, all_around = 7, double_sided = 8, scattering = 16, classes = 32;

uint32_t class_of(const PointLight& light) {
  if (light.kind == PointLightKind::distant) return distant;
  if (light.kind == PointLightKind::punctual) return all_around;
  vec3 size = glm::abs(light.normal);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  uint32_t way = uint32_t(2 * axis) + (light.normal[axis] < 0);
  return way + (light.double_sided ? double_sided : 0) +
         (light.kind == PointLightKind::scattering ? scattering : 0);
}

constexpr int bits = 9;  // bits of a coordinate; five more name the class

// Spreads the bits of x: every third bit of the result is one of x's.
uint32_t spread_bits(uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

struct Keyed {
  uint32_t key = 0;
  uint32_t light = 0;
};

// Sorts by key, ascending; items of the same key stay in order. Sorts by three digits, the last one
// first.
void sort_by_key(std::vector<Keyed>& items) {
  constexpr int digit = 11, digits = 3;
  std::vector<Keyed> sorted(items.size());
  for (int d = 0; d < digits; d++) {
    auto digit_of = [&](const Keyed& k) { return k.key >> (d * digit) & ((1u << digit) - 1); };
    std::vector<uint32_t> next((1u << digit) + 1, 0);
    for (const Keyed& k : items) next[digit_of(k) + 1]++;
    for (size_t i = 1; i < next.size(); i++) next[i] += next[i - 1];
    for (const Keyed& k : items) sorted[next[digit_of(k)]++] = k;
    items.swap(sorted);
  }
}

}  // namespace

std::vector<uint32_t> order_lights(const InstantPass& pass) {
  std::array<vec3, classes> low, high;
  low.fill(vec3(std::numeric_limits<float>::infinity()));
  high.fill(-low[0]);
  std::vector<Keyed> keyed;
  keyed.reserve(pass.lights.size());
  for (uint32_t i = 0; i < uint32_t(pass.lights.size()); i++) {
    const PointLight& light = pass.lights[i];
    if (light.exact) continue;
    uint32_t c = class_of(light);
    low[c] = glm::min(low[c], light.position), high[c] = glm::max(high[c], light.position);
    keyed.push_back({c, i});
  }
  constexpr float last = float((1 << bits) - 1);
  std::array<float, classes> scale;
  for (size_t c = 0; c < classes; c++)
    scale[c] = last / std::max(max_component(high[c] - low[c]), 1e-30f);
  for (Keyed& k : keyed) {
    const uint32_t c = k.key;
    const vec3 place = (pass.lights[k.light].position - low[c]) * scale[c];
    k.key = c << (3 * bits);
    for (int a = 0; a < 3; a++) k.key |= spread_bits(uint32_t(std::min(place[a], last))) << a;
  }
  sort_by_key(keyed);
  std::vector<uint32_t> order;
  order.reserve(keyed.size());
  for (const Keyed& k : keyed) order.push_back(k.light);
  return order;
}

namespace {

constexpr float near_radii = 2;  // radii; a place nearer than that many asks each light
constexpr size_t most_points = 16;

// Returns whether all lights of a cluster have the same in `of`.
bool is_same(const LightLanes& lights, const std::vector<Lanes>& of, size_t c) {
  for (int i = 1; i < lane_count; i++)
    if (lights.number[c * lane_count + size_t(i)] != LightLanes::none && of[c][i] != of[c][0])
      return false;
  return true;
}

// Makes the light that stands for the lights of cluster c, if they are alike.
void unite(LightClusters& all, size_t c) {
  const LightLanes& l = all.lights;
  const float power = lanes_sum(l.power[c]);
  if (!(power > 0) || !std::isfinite(1 / power)) return;
  if (!is_same(l, l.near, c) || !is_same(l, l.back, c) || !is_same(l, l.even, c)) return;
  const Lanes weight = l.power[c] / power;
  auto mean = [&](const Lanes3& of) {
    return vec3(lanes_sum(of.x * weight), lanes_sum(of.y * weight), lanes_sum(of.z * weight));
  };
  const VplGroup& group = l.groups[c];
  const vec3 centre = mean(group.position);
  vec3 normal = mean(group.normal);
  const float length = std::sqrt(dot(normal, normal));
  if (!(length > 0)) return;
  normal /= length;
  float radius2 = 0, spread2 = 0;
  for (int i = 0; i < lane_count; i++) {
    if (l.number[c * lane_count + size_t(i)] == LightLanes::none) continue;
    vec3 away = group.position.at(i) - centre, turned = group.normal.at(i) - normal;
    radius2 = std::max(radius2, dot(away, away)), spread2 = std::max(spread2, dot(turned, turned));
  }
  if (!std::isfinite(radius2 + spread2)) return;
  ClusterRow& row = all.rows[c / lane_count];
  const size_t lane = c % lane_count;
  row.position.set(int(lane), centre), row.normal.set(int(lane), normal);
  row.radius[lane] = std::sqrt(radius2), row.spread[lane] = std::sqrt(spread2);
  row.near[lane] = l.near[c][0], row.back[lane] = l.back[c][0], row.even[lane] = l.even[c][0];
  row.power[lane] = power;
  all.inverse_power[c] = 1 / power;
}

// Returns a cosine for all lights of a cluster: its centre's is `middle`, and each light's is
// within `reach` of that. The result is not 0 if any light's may be above 0.
Lanes lit_cosine(Lanes middle, Lanes reach, LaneMask both_sides) {
  Lanes least = 0.25f * (middle + reach);
  least = both_sides ? lanes_max(-middle, 0.25f * reach) : lanes_max(least, Lanes{});
  return lanes_max(middle, least);
}

// Returns the irradiance by the clusters of a row as if each were one light, as eval_unshadowed
// does; adds to `near` the bits of those too near for that.
Lanes eval_row(const ClusterRow& row, const LitPoint& point, float most, unsigned& near) {
  const Lanes one = all_lanes(1.0f);
  const Lanes3 way = row.position - all_lanes(point.position) * row.near;
  Lanes inverse = one / lanes_sqrt(lanes_max(dot(way, way), all_lanes(1e-20f)));
  Lanes reach = lanes_min(row.radius * inverse, one);
  near |= negative_lanes(reach > 1 / near_radii);
  Lanes here = dot(way, all_lanes(point.normal)) * inverse;
  Lanes there = -dot(way, row.normal) * inverse;
  here = lit_cosine(here, reach, LaneMask{} - int(point.both_sides));
  there = lit_cosine(there, reach + row.spread, row.back > 0);
  here += point.even * (one - here);
  there += row.even * (one - there);
  Lanes falls = row.near > 0 ? lanes_min(inverse * inverse, all_lanes(most)) : one;
  return row.power * here * there * falls;
}

}  // namespace

LightClusters make_light_clusters(const LightTables& tables, const InstantPass& pass) {
  LightClusters all;
  const std::vector<uint32_t> order = order_lights(pass);
  all.number = order.size();
  all.lights = make_light_lanes(tables, pass, order);
  const size_t clusters = all.size();
  all.rows.resize((clusters + lane_count - 1) / lane_count);
  all.inverse_power.assign(clusters, 0);
  all.held.assign(clusters, 0);
  for (size_t i = 0; i < order.size(); i++) all.held[i / lane_count]++;
  parallel_ranges(int(all.rows.size()), 8, [&](int first, int last) {
    size_t end = std::min(size_t(last) * lane_count, clusters);
    for (size_t c = size_t(first) * lane_count; c < end; c++) unite(all, c);
  });
  return all;
}

bool share_lights(const LightClusters& clusters, float clip, std::span<const LitPoint> points,
                  ClusterShares& shares) {
  // The light of clusters that are asked light by light is guessed from one of so many: it only
  // serves for the weight of a place.
  constexpr size_t guessed = 8;
  const float most = most_of_clip(clip);
  const size_t count = std::min(points.size(), most_points), rows = clusters.rows.size();
  shares.of_cluster.assign(rows * lane_count, 0);
  shares.detail_of.assign(clusters.size(), ClusterShares::none);
  shares.details.clear();
  shares.scratch.resize(rows * most_points);
  Lanes totals[most_points] = {};
  std::vector<uint32_t> each;  // clusters asked light by light
  for (size_t row = 0; row < rows; row++) {
    const ClusterRow here = clusters.rows[row];
    unsigned near = 0;
    for (size_t p = 0; p < count; p++) {
      Lanes effect = eval_row(here, points[p], most, near);
      shares.scratch[row * most_points + p] = effect;
      totals[p] += effect;
    }
    for (size_t lane = 0; lane < lane_count && row * lane_count + lane < clusters.size(); lane++) {
      size_t c = row * lane_count + lane;
      if (clusters.inverse_power[c] > 0 && !(near >> lane & 1)) continue;
      each.push_back(uint32_t(c));
    }
  }
  float weight[most_points];
  for (size_t p = 0; p < count; p++) {
    float guess = 0;
    for (size_t k = 0; k < each.size(); k += guessed)
      if (clusters.inverse_power[each[k]] == 0)
        guess += lanes_sum(eval_unshadowed(clusters.lights, each[k], points[p], most));
    float sum = lanes_sum(totals[p]) + float(guessed) * guess;
    weight[p] = sum > 0 && std::isfinite(1 / sum) ? 1 / sum : 0;
  }
  for (size_t row = 0; row < rows; row++) {
    Lanes sum{};
    for (size_t p = 0; p < count; p++) sum += weight[p] * shares.scratch[row * most_points + p];
    store_lanes(&shares.of_cluster[row * lane_count], sum);
  }
  for (uint32_t c : each) {
    Lanes sum{};
    for (size_t p = 0; p < count; p++)
      sum += weight[p] * eval_unshadowed(clusters.lights, c, points[p], most);
    shares.detail_of[c] = uint32_t(shares.details.size());
    shares.details.push_back(sum);
    shares.of_cluster[c] = lanes_sum(sum);
  }
  double all = 0;
  for (float s : shares.of_cluster) all += double(s);
  if (!(all > 0) || !std::isfinite(all)) return false;
  const float scale = float(1 / all);
  for (float& s : shares.of_cluster) s *= scale;
  for (Lanes& s : shares.details) s *= scale;
  return true;
}

}  // namespace wellspring::light
