// SPDX-License-Identifier: Apache-2.0
// Spreads light between places: a Gaussian Markov random field solved by multigrid
// (light/kept/skin/skin_light.h).
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/kept/skin/skin_light.h"
#include "light/material/light_slope.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

constexpr float least_noise = 0.02f, most_noise = 4;  // relative variance of a sample
constexpr double prior_noise = 0.4, prior_samples = 1000;
constexpr float kept_after_switch = 0.25f;  // samples that all light from before a switch counts as
constexpr float least_known = 0.5f;         // samples that connected places need to have light
constexpr float damping = 0.8f;             // factor of Jacobi steps
constexpr int coarse_steps = 2, coarsest_steps = 8;
constexpr float sure_of_group = 1;    // samples a group needs to give its mean
constexpr float prior_slope = 0.25f;  // prior weight of no slope, in samples a place
constexpr int grain = 2048;           // places

// Returns the mean of a place's samples; w: their count.
vec4 told(const SkinHistory& h, vec3 SkinMean::*what) {
  float count = h.newer.count + h.older.count;
  if (!(count > 0)) return vec4(0);
  vec3 mean = (h.newer.*what * h.newer.count + h.older.*what * h.older.count) / count;
  return vec4(mean, count);
}

// Holds the equations of one level: the amount to be added to a place's light, times the weights
// there, is `residual` plus what neighbours are given, times their weights.
struct Equations {
  std::span<const uint32_t> first_edge;
  std::span<const SkinEdge> edges;
  float noise = 1;
  std::vector<uint8_t> active;  // 0: the place stays as it is
  std::vector<vec4> residual;   // w: count of samples
  std::vector<vec4> added, before;

  size_t size() const { return residual.size(); }
  // Returns the neighbours' weight in w, and the weighted sum of what they are given in xyz.
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

// Measures the relative variance of samples, and the mean light of visible places.
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
  // While most places have one sample, they hardly show the variance.
  const double prior = prior_samples * double(luminance(skin.mean)) * double(luminance(skin.mean));
  squares += prior_noise * prior, whole += prior;
  if (whole > 0) skin.noise = std::clamp(float(squares / whole), least_noise, most_noise);
}

// Marks the places that are connected with samples of light, not with hidden places alone.
void mark_known(std::span<const vec4> sums, std::span<const uint8_t> active, SkinLight& skin) {
  std::vector<float> known(skin.pieces, 0);
  for (size_t i = 0; i < sums.size(); i++) known[skin.piece[i]] += sums[i].w;
  for (size_t i = 0; i < sums.size(); i++)
    if (active[i]) skin.light[i].w = known[skin.piece[i]] >= least_known;
}

// Sums up the samples of each active place.
std::vector<vec4> find_sums(const SkinLight& skin, vec3 SkinMean::*what,
                            const std::vector<uint8_t>& active) {
  std::vector<vec4> sums(skin.places.size(), vec4(0));
  parallel_ranges(int(sums.size()), grain, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      if (!active[i]) continue;
      const vec4 said = told(skin.history[i], what);
      sums[i] = vec4(vec3(said) * said.w, said.w);
    }
  });
  return sums;
}

// Lets a place that had no light begin with the mean of its samples, or of those of the smallest
// group around it that has any: cycles take long to carry light far.
void begin_unknown(const SkinLight& skin, std::span<const vec4> sums,
                   std::span<const uint8_t> unknown, std::vector<vec4>& values) {
  if (std::find(unknown.begin(), unknown.end(), 1) == unknown.end()) return;
  std::vector<std::vector<vec4>> coarser;
  vec4 all(0);
  for (const vec4& sum : sums) all += sum;
  for (const SkinLevel& level : skin.levels) {
    std::span<const vec4> finer = coarser.empty() ? sums : std::span<const vec4>(coarser.back());
    std::vector<vec4> of(level.size(), vec4(0));
    for (size_t i = 0; i < finer.size(); i++) of[level.parent[i]] += finer[i];
    coarser.push_back(std::move(of));
  }
  parallel_ranges(int(sums.size()), grain, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      if (!unknown[i]) continue;
      vec4 sum = sums[i];
      size_t at = i;
      for (size_t level = 0; !(sum.w >= sure_of_group) && level < coarser.size(); level++) {
        at = skin.levels[level].parent[at];
        sum = coarser[level][at];
      }
      if (!(sum.w > 0)) sum = all;
      if (sum.w > 0) values[i] = vec4(vec3(sum) / sum.w, values[i].w);
    }
  });
}

// Adds the difference that neighbours are expected to have: as their normals differ, by the slope
// between them.
void expect_slopes(const World& world, const SkinLight& skin, Equations& of) {
  std::vector<vec3> normals(skin.places.size());
  parallel_ranges(int(normals.size()), grain, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      const SkinPlace& place = skin.places[i];
      const vec3 n = world.mesh_of(place.instance).normals[place.vertex];
      const float length2 = dot(n, n);
      if (length2 > 1e-12f && std::isfinite(length2))
        normals[i] = n * ((place.back ? -1.0f : 1.0f) / std::sqrt(length2));
    }
  });
  parallel_ranges(int(normals.size()), grain, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      if (!of.active[i]) continue;
      const vec3 here(skin.slope[i]), light(skin.light[i]);
      vec3 sum(0);
      for (uint32_t e = skin.first_edge[i]; e < skin.first_edge[i + 1]; e++) {
        const uint32_t next = skin.edges[e].place;
        const vec3 both = light + vec3(skin.light[next]);
        const float most = 0.5f * luminance(both);
        if (!(most > 0)) continue;
        const float differs = 0.5f * dot(here + vec3(skin.slope[next]), normals[i] - normals[next]);
        sum += skin.edges[e].alike * std::clamp(differs / most, -1.0f, 1.0f) * 0.5f * both;
      }
      of.residual[i] += vec4(of.noise * sum, 0);
    }
  });
}

void run_cycles(const SkinLight& skin, int cycles, Equations& of) {
  of.before.resize(of.added.size());
  for (int cycle = 0; cycle < cycles; cycle++) {
    if (!skin.levels.empty()) solve(skin, 0, of);
    of.step();
  }
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
  std::vector<vec4> slopes = find_sums(skin, &SkinMean::slope, active),
                    lights = find_sums(skin, &SkinMean::mean, active);
  std::vector<uint8_t> unknown(count);
  for (size_t i = 0; i < count; i++) unknown[i] = active[i] && !(skin.light[i].w > 0);
  mark_known(lights, active, skin);
  for (vec4& slope : slopes) slope.w += prior_slope;
  begin_unknown(skin, slopes, unknown, skin.slope);
  begin_unknown(skin, lights, unknown, skin.light);
  auto equations = [&](std::vector<vec4>&& sums, const std::vector<vec4>& from) {
    return Equations{skin.first_edge, skin.edges, skin.noise, active, std::move(sums), from, {}};
  };
  Equations of_slopes = equations(std::move(slopes), skin.slope);
  run_cycles(skin, (cycles + 1) / 2, of_slopes);  // slopes change less
  skin.slope = std::move(of_slopes.added);
  Equations of = equations(std::move(lights), skin.light);
  expect_slopes(world, skin, of);
  run_cycles(skin, cycles, of);
  parallel_ranges(int(count), grain, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      skin.light[i] = vec4(max(vec3(of.added[i]), vec3(0)), skin.light[i].w);
  });
  measure(visible, skin);
  for (size_t i = 0; i < count; i++)
    if (!(skin.light[i].w > 0)) skin.light[i] = vec4(skin.mean, 0), skin.slope[i] = vec4(0);
}

SkinTriangle find_skin(const SkinLight& skin, uint32_t instance, uvec3 vertices, bool back) {
  const std::vector<uint32_t>& place = back ? skin.back : skin.front;
  const uint32_t* of = &place[skin.first_vertex[instance - skin.first_instance]];
  vec3 light[3], slope[3];
  for (int k = 0; k < 3; k++) {
    const uint32_t at = of[vertices[k]];
    light[k] = vec3(skin.light[at]);
    const float l = luminance(light[k]);
    if (l > 0) slope[k] = vec3(skin.slope[at]) / l;
    const float length2 = dot(slope[k], slope[k]);
    if (length2 > most_slope * most_slope) slope[k] *= most_slope / std::sqrt(length2);
  }
  return {light[0], light[1] - light[0], light[2] - light[0],
          slope[0], slope[1] - slope[0], slope[2] - slope[0]};
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
      const vec4 before = told(h, &SkinMean::mean), slope = told(h, &SkinMean::slope);
      const float left = luminance(kept);
      h.newer = h.older = {};
      if (before.w > 0)
        h.older = {vec3(before) * kept + added, left * vec3(slope), kept_after_switch, 0};
      h.asked = 0;
      skin.light[i] = vec4(vec3(skin.light[i]) * kept + added, skin.light[i].w);
      skin.slope[i] *= left;
    }
  });
}

// Finds by rays of views where light on what moves is seen (light/kept/skin/skin_light.h).

namespace {

constexpr float nearest_seen = 1e-3f;  // metres: nearer things may be anywhere in the picture
constexpr int most_panes_seen = 8;     // panes in a row
constexpr uint32_t nowhere = 0xffffffffu;

struct Rectangle {
  vec2 low{INFINITY}, high{-INFINITY};
};

Rectangle rectangle_of(const Bounds& box, const View& view) {
  const vec2 size(float(view.width), float(view.height));
  Rectangle window;
  for (int k = 0; k < 8; k++) {
    const vec3 corner(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                      k & 4 ? box.high.z : box.low.z);
    const Projected at = project_point(view, corner);
    if (!(at.depth > nearest_seen)) return {vec2(0), size};
    window.low = glm::min(window.low, vec2(at.x, at.y));
    window.high = glm::max(window.high, vec2(at.x, at.y));
  }
  return {glm::clamp(window.low, vec2(0), size), glm::clamp(window.high, vec2(0), size)};
}

// Finds what the ray meets behind clear panes.
Hit look(const World& world, Ray ray) {
  Hit hit = world.intersect(ray);
  for (int i = 0; i < most_panes_seen && hit.valid(); i++) {
    if (!(world.material_of(hit.instance).transmission > 0)) break;
    ray.t_min = hit.t * 1.00001f + 1e-5f;
    hit = world.intersect(ray);
  }
  return hit;
}

// Returns one of the triangle's corners, the likelier the nearer, of the side that is seen.
uint32_t place_at(const World& world, const SkinLight& skin, const Hit& hit, vec3 direction,
                  float choice) {
  if (!hit.valid() || hit.instance < skin.first_instance) return nowhere;
  const uvec3 corners = world.mesh_of(hit.instance).triangles[hit.triangle];
  const vec2 at = hit.barycentric;
  const uint32_t vertex = choice < at.x ? corners.y : choice < at.x + at.y ? corners.z : corners.x;
  const bool back = dot(eval_face(world, hit.instance, hit.triangle), direction) > 0;
  return (back ? skin.back
               : skin.front)[skin.first_vertex[hit.instance - skin.first_instance] + vertex];
}

}  // namespace

SkinSight see_skin(const World& world, const SkinLight& skin, const View& view, int rays,
                   uint64_t turn) {
  SkinSight sight;
  const Bounds box = world.moving_bounds();
  if (skin.places.empty() || !(box.low.x <= box.high.x)) return sight;
  const Rectangle window = rectangle_of(box, view);
  const vec2 size = window.high - window.low;
  const float pixels = size.x * size.y;
  if (!(pixels > 0)) return sight;
  const int count = std::clamp(int(std::min(std::ceil(pixels), 1e9f)), 1, std::max(rays, 1));
  std::vector<uint32_t> met(size_t(count), nowhere);
  // The points are the R2 sequence (Roberts 2018), begun anywhere.
  const uint64_t random = mix64(turn);
  const double begin_x = double(random >> 40) * 0x1p-24,
               begin_y = double(random & 0xffffff) * 0x1p-24;
  parallel_ranges(count, 64, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      const vec2 at(float(std::fmod(begin_x + i * 0.7548776662466927, 1.0)),
                    float(std::fmod(begin_y + i * 0.5698402909980532, 1.0)));
      const vec2 place = window.low + at * size;
      const Ray ray = view_ray(view, place.x, place.y);
      const float choice = float(mix64(random + uint64_t(i)) >> 40) * 0x1p-24f;
      met[size_t(i)] = place_at(world, skin, look(world, ray), ray.direction, choice);
    }
  });
  for (uint32_t place : met)
    if (place != nowhere) sight.places.push_back(place);
  sight.pixels = pixels * float(sight.places.size()) / float(count);
  return sight;
}

}  // namespace wellspring::light
