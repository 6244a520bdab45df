// SPDX-License-Identifier: Apache-2.0
#include "light/emitter_groups.h"

#include <algorithm>
#include <cmath>

#include "light/light_tables.h"

namespace wellspring {
namespace {

constexpr float behind = 0.03f;  // weight of a group wholly behind the surface: never nothing

struct Cluster {
  std::vector<uint32_t> members;
  Bounds bounds;
  float power = 0;
};

vec3 middle(const EmitterTriangle& e) { return e.corner + (e.edge1 + e.edge2) / 3.0f; }

Cluster make_cluster(std::span<const EmitterTriangle> emitters, std::span<const float> power,
                     std::vector<uint32_t> members) {
  Cluster cluster;
  for (uint32_t i : members) {
    for (vec3 p : {emitters[i].corner, emitters[i].corner + emitters[i].edge1,
                   emitters[i].corner + emitters[i].edge2}) {
      cluster.bounds.low = glm::min(cluster.bounds.low, p);
      cluster.bounds.high = glm::max(cluster.bounds.high, p);
    }
    cluster.power += power[i];
  }
  cluster.members = std::move(members);
  return cluster;
}

// How much there is to win by splitting: bright and large first.
float worth(const Cluster& cluster) {
  return cluster.members.size() < 2 ? 0 : cluster.power * length(cluster.bounds.high - cluster.bounds.low);
}

// The weights of all groups as seen from a place; their sum.
float weigh(const EmitterGroups& groups, vec3 place, vec3 normal, float* weight) {
  float sum = 0;
  for (size_t g = 0; g < groups.power.size(); g++) {
    vec3 line = groups.centre[g] - place;
    float distance2 = dot(line, line);
    float above = dot(line, normal) + std::sqrt(groups.radius2[g]) > 0 ? 1.0f : behind;
    weight[g] = above * groups.power[g] / std::max(distance2, groups.radius2[g]);
    sum += weight[g];
  }
  return sum;
}

}  // namespace

EmitterGroups make_emitter_groups(std::span<const EmitterTriangle> emitters, std::span<const float> power,
                                  int most) {
  std::vector<uint32_t> able;
  for (uint32_t i = 0; i < emitters.size(); i++)
    if (std::isfinite(power[i]) && power[i] > 0) able.push_back(i);
  EmitterGroups groups;
  groups.group_of.assign(emitters.size(), 0);
  groups.share.assign(emitters.size(), 0);
  if (able.empty()) return groups;
  std::vector<Cluster> clusters{make_cluster(emitters, power, able)};
  while (clusters.size() < size_t(std::min(most, most_emitter_groups))) {
    auto widest = std::max_element(clusters.begin(), clusters.end(),
                                   [](const Cluster& a, const Cluster& b) { return worth(a) < worth(b); });
    if (!(worth(*widest) > 0)) break;
    Cluster cluster = std::move(*widest);
    clusters.erase(widest);
    vec3 size = cluster.bounds.high - cluster.bounds.low;
    int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    std::sort(cluster.members.begin(), cluster.members.end(), [&](uint32_t a, uint32_t b) {
      return middle(emitters[a])[axis] < middle(emitters[b])[axis];
    });
    auto half = cluster.members.begin() + long(cluster.members.size() / 2);
    clusters.push_back(make_cluster(emitters, power, {cluster.members.begin(), half}));
    clusters.push_back(make_cluster(emitters, power, {half, cluster.members.end()}));
  }
  for (const Cluster& cluster : clusters) {
    uint16_t g = uint16_t(groups.power.size());
    vec3 size = cluster.bounds.high - cluster.bounds.low;
    groups.centre.push_back(cluster.bounds.low + 0.5f * size);
    groups.radius2.push_back(std::max(0.25f * dot(size, size), 1e-12f));
    groups.power.push_back(cluster.power);
    groups.total += double(cluster.power);
    groups.first.push_back(uint32_t(groups.members.size()));
    std::vector<float> powers;
    for (uint32_t i : cluster.members) powers.push_back(power[i]);
    groups.choice.push_back(make_alias_table(powers));
    for (size_t k = 0; k < cluster.members.size(); k++) {
      groups.group_of[cluster.members[k]] = g;
      groups.share[cluster.members[k]] = groups.choice.back().cells[k].probability;
      groups.members.push_back(cluster.members[k]);
    }
  }
  groups.first.push_back(uint32_t(groups.members.size()));
  return groups;
}

EmitterPick sample_group(const EmitterGroups& groups, vec3 place, vec3 normal, float u) {
  float weight[most_emitter_groups];
  float sum = weigh(groups, place, normal, weight);
  EmitterPick pick;
  if (!(sum > 0) || !std::isfinite(sum)) return pick;
  float left = u * sum;
  size_t g = 0, last = groups.power.size() - 1;
  while (g < last && left >= weight[g]) left -= weight[g++];
  float rest = weight[g] > 0 ? std::clamp(left / weight[g], 0.0f, 0x1.fffffep-1f) : 0;
  AliasPick inside = sample_alias(groups.choice[g], rest);
  pick.index = groups.members[groups.first[g] + inside.index];
  pick.probability = weight[g] / sum * groups.share[pick.index];
  pick.u = inside.u;
  return pick;
}

float sample_group_probability(const EmitterGroups& groups, vec3 place, vec3 normal, uint32_t index) {
  if (!(groups.share[index] > 0)) return 0;
  float weight[most_emitter_groups];
  float sum = weigh(groups, place, normal, weight);
  if (!(sum > 0) || !std::isfinite(sum)) return 0;
  return weight[groups.group_of[index]] / sum * groups.share[index];
}

}  // namespace wellspring
