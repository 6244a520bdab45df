// SPDX-License-Identifier: Apache-2.0
// Light between places: a Gaussian Markov random field solved by multigrid
// (light/known/skin_light.h).
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/known/skin_light.h"

namespace wellspring {
namespace {

constexpr float open_below = 0.6f, shut_above = 0.85f, shut_weight = 1e-4f;  // of what is blocked
constexpr float least_noise = 0.02f, most_noise = 4;  // relative variance of a sample
constexpr double prior_noise = 0.4, prior_samples = 1000;
constexpr float kept_after_switch = 0.25f;  // samples that all light before a switch counts as
constexpr float least_known = 0.5f;         // samples
constexpr float damping = 0.8f;             // of Jacobi steps
constexpr int coarse_steps = 2, coarsest_steps = 8;
constexpr int grain = 2048;  // places

float openness(float blocked) {
  float shut = std::clamp((blocked - open_below) / (shut_above - open_below), 0.0f, 1.0f);
  return 1 - (1 - shut_weight) * shut;
}

// What samples say of a place; w: their count.
vec4 told(const SkinHistory& h) {
  float count = h.newer.count + h.older.count;
  if (!(count > 0)) return vec4(0);
  vec3 mean = (h.newer.mean * h.newer.count + h.older.mean * h.older.count) / count;
  return vec4(mean, count * openness(h.blocked));
}

// The equations of one level: what is to be added to the light of a place, times the weights there,
// is `residual` and what neighbours are given, times theirs.
struct Equations {
  std::span<const uint32_t> first_edge;
  std::span<const SkinEdge> edges;
  float noise = 1;
  std::vector<uint8_t> active;  // others stay as they are
  std::vector<vec4> residual;   // w: samples
  std::vector<vec4> added, before;

  size_t size() const { return residual.size(); }
  // Weight of neighbours in w, and of what they are given in xyz.
  vec4 around(size_t i, std::span<const vec4> given) const {
    vec4 sum(0);
    for (uint32_t e = first_edge[i]; e < first_edge[i + 1]; e++) {
      vec4 next = given[edges[e].place];
      next.w = 1;
      sum += next * edges[e].alike;
    }
    return sum * noise;
  }
  void step() {
    std::swap(added, before);
    parallel_ranges(int(size()), grain, [&](int begin, int end) {
      for (size_t i = size_t(begin); i < size_t(end); i++) {
        if (!active[i]) {
          added[i] = before[i];
          continue;
        }
        vec4 near = around(i, before), r = residual[i];
        float weight = r.w + near.w;
        vec4 wanted = weight > 0 ? (vec4(vec3(r), 0) + near) / weight : before[i];
        added[i] = before[i] + damping * (wanted - before[i]);
      }
    });
  }
  vec4 left(size_t i) const {
    vec4 near = around(i, added), r = residual[i];
    vec3 rest = vec3(r) + vec3(near) - vec3(added[i]) * (r.w + near.w);
    return vec4(rest, r.w);
  }
};

void solve(const SkinLight& skin, size_t level, Equations& finer) {
  const SkinLevel& here = skin.levels[level];
  Equations of{here.first_edge, here.edges, finer.noise, {}, {}, {}, {}};
  of.active.assign(here.size(), 0);
  of.residual.assign(here.size(), vec4(0));
  of.added.assign(here.size(), vec4(0));
  of.before = of.added;
  for (size_t i = 0; i < finer.size(); i++) {
    if (!finer.active[i]) continue;
    of.residual[here.parent[i]] += finer.left(i);
    of.active[here.parent[i]] = 1;
  }
  bool last = level + 1 == skin.levels.size();
  for (int k = 0; k < (last ? coarsest_steps : coarse_steps); k++) of.step();
  if (!last) {
    solve(skin, level + 1, of);
    for (int k = 0; k < coarse_steps; k++) of.step();
  }
  for (size_t i = 0; i < finer.size(); i++) finer.added[i] += of.added[here.parent[i]];
}

// The relative variance of samples, and the mean light of what is visible.
void measure(std::span<const uint8_t> visible, SkinLight& skin) {
  double squares = 0, whole = 0, count = 0, samples = 0;
  dvec3 sum(0);
  for (size_t i = 0; i < skin.places.size(); i++) {
    const vec4& light = skin.light[i];
    if (!(light.w > 0) || !visible[skin.places[i].instance - skin.first_instance]) continue;
    sum += dvec3(vec3(light)), count++;
    samples += double(skin.history[i].newer.count + skin.history[i].older.count);
    for (const SkinMean* mean : {&skin.history[i].newer, &skin.history[i].older}) {
      if (!(mean->count > 1)) continue;
      double known = double(luminance(vec3(light)));
      squares += double(mean->squares), whole += double(mean->count - 1) * known * known;
    }
  }
  if (count > 0) skin.mean = vec3(sum / count), skin.samples = float(samples / count);
  // While most places have one sample, little is known of that.
  const double prior = prior_samples * double(luminance(skin.mean)) * double(luminance(skin.mean));
  squares += prior_noise * prior, whole += prior;
  if (whole > 0) skin.noise = std::clamp(float(squares / whole), least_noise, most_noise);
}

// Whether anything is known of what hangs together with each place: more than that it is hidden.
void mark_known(std::span<const vec4> said, std::span<const uint8_t> active, SkinLight& skin) {
  std::vector<float> known(skin.pieces, 0);
  for (size_t i = 0; i < said.size(); i++) known[skin.piece[i]] += said[i].w;
  for (size_t i = 0; i < said.size(); i++)
    if (active[i]) skin.light[i].w = known[skin.piece[i]] >= least_known;
}

}  // namespace

std::vector<uint8_t> find_visible(const World& world, const SkinLight& skin) {
  std::vector<uint8_t> visible;
  for (uint32_t i = skin.first_instance; i < uint32_t(world.instance_count()); i++)
    visible.push_back(world.is_visible(i));
  return visible;
}

void smooth_skin(const World& world, SkinLight& skin, int cycles) {
  const size_t count = skin.places.size();
  if (count == 0) return;
  const std::vector<uint8_t> visible = find_visible(world, skin);
  std::vector<uint8_t> active(count);
  for (size_t i = 0; i < count; i++)
    active[i] = visible[skin.places[i].instance - skin.first_instance];
  std::vector<vec4> said(count, vec4(0));
  parallel_ranges(int(count), grain, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      if (active[i]) said[i] = told(skin.history[i]);
  });
  mark_known(said, active, skin);
  Equations of{skin.first_edge, skin.edges, skin.noise, std::move(active),
               std::move(said), skin.light, {}};
  of.before.resize(count);
  for (vec4& r : of.residual) r = vec4(vec3(r) * r.w, r.w);
  for (int cycle = 0; cycle < cycles; cycle++) {
    if (!skin.levels.empty()) solve(skin, 0, of);
    of.step();
  }
  parallel_ranges(int(count), grain, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      skin.light[i] = vec4(max(vec3(of.added[i]), vec3(0)), skin.light[i].w);
  });
  measure(visible, skin);
  for (vec4& light : skin.light)
    if (!(light.w > 0)) light = vec4(skin.mean, 0);
}

void relight_skin(const World& world, const SkinChange& change, SkinLight& skin) {
  parallel_ranges(int(skin.places.size()), grain, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      const SkinPlace& place = skin.places[i];
      const Mesh& mesh = world.mesh_of(place.instance);
      vec3 kept(1), added(0);
      vec3 normal = mesh.normals[place.vertex] * (place.back ? -1.0f : 1.0f);
      if (!change(mesh.positions[place.vertex], normal, kept, added)) continue;
      SkinHistory& h = skin.history[i];
      vec4 before = told(h);
      h.newer = h.older = {};
      if (before.w > 0) h.older = {vec3(before) * kept + added, kept_after_switch, 0};
      h.asked = 0;
      skin.light[i] = vec4(vec3(skin.light[i]) * kept + added, skin.light[i].w);
    }
  });
}

}  // namespace wellspring
