// SPDX-License-Identifier: Apache-2.0
#include "light/kept/skin/skin_light.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/material/light_slope.h"
#include "light/sample/lamps_seen.h"
#include "light/sample/light_tables.h"
#include "light/walk/first_surface.h"

namespace wellspring::light {
namespace {

constexpr float window = 8;        // samples, before they count as older
constexpr float most_older = 48;   // older samples that are remembered
constexpr float least_judged = 4;  // older samples that newer ones are compared with
// Standard errors between the means that show a change of light
constexpr float surprise = 4;
// Samples that older ones beside such a place still count as
constexpr float kept_nearby = 0.5f;
constexpr float blocked_window = 16;   // samples
constexpr uint32_t sure_samples = 4;   // samples before a place can be hidden
constexpr float maybe_hidden = 0.25f;  // share blocked from which samples look closer
constexpr int closer_looks = 4;        // short rays
// So many blocked ones, among them and the sample's own, hide the place
constexpr int closed = 3;
constexpr float seen_share = 0.75f;  // share of samples for places that views see
constexpr float rays_a_sample = 4;   // rays that look for a place: some miss
constexpr float least_dense = 0.3f;  // least share of samples for sparse places
constexpr float well_known = 24;     // samples
// A power of two: one in so many well-known places that are met is sampled
constexpr uint32_t less_of_known = 4;
constexpr float hidden = 0.8f;           // share blocked from which a place is hidden
constexpr uint32_t longest_period = 16;  // turns from sample to sample of a place
// Tries for a direction; dimension of those after the first
constexpr uint32_t most_tries = 4, again = 48;
constexpr uint32_t look = 64;  // dimension of closer looks
// As a multiple of the light kept there and the mean light
constexpr float most_over_known = 3;
constexpr float gather_blunt = 0.14f;  // as technique `gather` has it

struct Asked {
  uint32_t place = 0, index = 0;
};
struct Answer {
  vec3 light{0};
  bool valid = false, blocked = false;
  bool shut = false;  // the place is hidden now
  // The slope is made of the light that came straight, times its slope_of(), and of the direction
  // that the rest came from.
  vec3 straight{0}, straight_slope{0}, direction{0}, normal{0};
};

void scale(Answer& answer, float factor) {
  answer.light *= factor, answer.straight *= factor, answer.straight_slope *= factor;
}

vec3 find_slope(const Answer& answer) {
  const float rest = luminance(answer.light - answer.straight);
  if (!(rest > 0)) return answer.straight_slope;
  return answer.straight_slope + rest * slope_of(answer.direction, answer.normal);
}

// Holds a place around the vertex where light is gathered.
struct SkinPoint {
  SurfacePlace place;
  vec3 normal{0, 1, 0};
};

// Returns the area of that triangle as it is now; 0: it has none that is any use.
float area_of(const World& world, const SkinCorner& c) {
  const Mesh& mesh = world.mesh_of(c.instance);
  uvec3 t = mesh.triangles[c.triangle];
  vec3 a = mesh.positions[t.x];
  vec3 n = cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
  float area = std::sqrt(dot(n, n));
  return area > 0 && std::isfinite(area) ? area : 0.0f;
}

// Picks a point in the half of the triangles around that is nearest to the vertex, as densely as it
// is interpolated there.
bool pick_point(const World& world, const SkinLight& skin, uint32_t place, Sampler& sampler,
                SkinPoint& point) {
  std::span<const SkinCorner> around =
      std::span(skin.corners.begin() + skin.first_corner[place],
                skin.corners.begin() + skin.first_corner[place + 1]);
  float all = 0;
  for (const SkinCorner& c : around) all += area_of(world, c);
  if (!(all > 0) || !std::isfinite(all)) return false;
  vec2 u = sampler.next2(), v = sampler.next2();
  float left = u.x * all;
  const SkinCorner* chosen = nullptr;
  for (const SkinCorner& c : around) {
    float area = area_of(world, c);
    if (!(area > 0)) continue;
    chosen = &c;
    if ((left -= area) < 0) break;
  }
  // The median of three numbers is distributed as the hat function's weight.
  float w = sampler.next();
  float near = 0.5f + 0.5f * std::max(std::min(u.y, v.x), std::min(std::max(u.y, v.x), w));
  const Mesh& mesh = world.mesh_of(chosen->instance);
  uvec3 t = mesh.triangles[chosen->triangle];
  vec3 weight(0);
  weight[int(chosen->corner)] = near;
  weight[int(chosen->corner + 1) % 3] = (1 - near) * v.y;
  weight[int(chosen->corner + 2) % 3] = (1 - near) * (1 - v.y);
  vec3 p[3], n(0);
  for (int c = 0; c < 3; c++) p[c] = mesh.positions[t[c]], n += mesh.normals[t[c]] * weight[c];
  float side = skin.places[place].back ? -1.0f : 1.0f;
  SurfacePlace& at = point.place;
  at.position = p[0] * weight.x + p[1] * weight.y + p[2] * weight.z;
  at.geometric_normal = eval_face(world, chosen->instance, chosen->triangle) * side;
  for (vec3 corner : p) at.extent = std::max(at.extent, max_component(abs(corner)));
  n *= side;
  float length2 = dot(n, n);
  bool usable = length2 > 1e-12f && std::isfinite(length2) && dot(n, at.geometric_normal) > 0;
  point.normal = usable ? n / std::sqrt(length2) : at.geometric_normal;
  return is_finite(at.position) && is_finite(at.geometric_normal);
}

// Returns the light that a white Lambertian surface there would reflect.
Answer gather(const Transport& transport, const WalkRules& rules, const SkinLight& skin,
              uint32_t place, Sampler& sampler) {
  Answer answer;
  SkinPoint point;
  if (!pick_point(transport.world, skin, place, sampler, point)) return answer;
  Request request;
  request.ray.origin = offset_origin(point.place, point.place.geometric_normal);
  request.ray.direction = -point.place.geometric_normal;
  Walk walk = begin_walk(transport, request);
  LambertLobe lobe{point.normal, point.place.geometric_normal, vec3(1)};
  const uint32_t base = Dimensions::first_surface;
  sampler.seek(base);
  DirectLight direct = sample_direct_light(transport, walk, point.place, lobe, true, sampler);
  answer.light = direct.area_diffuse + direct.punctual_diffuse;
  answer.valid = true;
  answer.normal = point.normal;
  answer.straight = answer.light;
  if (float l = luminance(direct.area_diffuse); l > 0)
    answer.straight_slope += l * slope_of(direct.area_direction, point.normal);
  if (float l = luminance(direct.punctual_diffuse); l > 0)
    answer.straight_slope += l * slope_of(direct.punctual_direction, point.normal);
  // The part of a smooth normal's hemisphere that lies within a flat triangle is as light as the
  // rest: else facets would darken what is round.
  BsdfSample scattered;
  for (uint32_t i = 0; i < most_tries && !(scattered.pdf > 0); i++) {
    sampler.seek(i == 0 ? base + Dimensions::scatter + 1 : again + i);
    scattered = sample_lambert(lobe, sampler.next2());
  }
  if (!advance(walk, point.place, scattered)) return answer;
  answer.direction = scattered.direction;
  walk.area_share = transport.tables.area_share > 0 ? 1.0f : 0.0f;
  Hit hit = transport.world.intersect(walk.ray);
  answer.blocked = hit.valid() && hit.t < skin.reach;
  sampler.seek(Dimensions::walk);
  answer.light += follow(transport, rules, walk, hit, sampler);
  return answer;
}

// Returns whether the place is hidden at the moment, after a sample whose way was `blocked` or not.
// Lips and lids that move hide a place and open it again.
bool is_shut(const World& world, const SkinLight& skin, uint32_t place, bool blocked,
             Sampler& sampler) {
  int found = blocked;
  for (int i = 0; i < closer_looks; i++) {
    sampler.seek(look + uint32_t(8 * i));
    SkinPoint point;
    if (!pick_point(world, skin, place, sampler, point)) return true;
    const BsdfSample way = sample_lambert(
        LambertLobe{point.normal, point.place.geometric_normal, vec3(1)}, sampler.next2());
    if (!(way.pdf > 0)) continue;
    Ray ray;
    ray.origin = offset_origin(point.place, way.direction);
    ray.direction = way.direction;
    ray.t_max = skin.reach;
    found += world.intersect(ray).valid();
  }
  return found >= closed;
}

bool is_hidden(const SkinHistory& h) { return h.asked >= sure_samples && h.blocked > hidden; }

bool is_faced(const World& world, const SkinPlace& place, std::span<const View> views) {
  const Mesh& mesh = world.mesh_of(place.instance);
  vec3 p = mesh.positions[place.vertex];
  vec3 n = mesh.normals[place.vertex] * (place.back ? -1.0f : 1.0f);
  constexpr float aside = 0.2f;  // normals of a vertex lean
  for (const View& view : views) {
    vec3 line = view.position - p;
    if (dot(n, line) > -aside * std::sqrt(dot(line, line))) return true;
  }
  return views.empty();
}

uint32_t period_of(const SkinLight& skin, uint32_t place, bool faced) {
  uint32_t period = is_hidden(skin.history[place]) ? 16 : 1;
  if (!faced) period *= 8;
  float area = skin.places[place].area;
  if (16 * area < skin.usual_area) period *= 4;
  else if (4 * area < skin.usual_area) period *= 2;
  return std::min(period, longest_period);
}

// Chooses places that are seen, for each view as many.
void choose_seen(const World& world, const SkinUpdate& update, size_t most, SkinLight& skin,
                 std::vector<Asked>& asked) {
  const size_t each = most / std::max<size_t>(update.views.size(), 1);
  for (size_t v = 0; v < update.views.size() && each > 0; v++) {
    const SkinSight sight =
        see_skin(world, skin, update.views[v], int(rays_a_sample * each), mix64(update.seed + v));
    size_t taken = 0;
    for (size_t i = 0; i < sight.places.size(); i++) {
      const uint32_t place = sight.places[i];
      SkinHistory& h = skin.history[place];
      // Light has more detail where places are dense, as on a face.
      const float dense = std::sqrt(skin.usual_area / std::max(skin.places[place].area, 1e-12f));
      const float choice = float(mix64(update.seed + i) >> 40) * 0x1p-24f;
      if (choice > std::max(dense, least_dense)) continue;
      // Places that are well known need less.
      const bool known = h.newer.count + h.older.count > well_known;
      if (known && (h.passed_over++ & (less_of_known - 1)) != 0) continue;
      asked.push_back({place, h.asked++});
      if (++taken == each) break;
    }
  }
}

// Chooses the places to sample now.
void choose(const World& world, const SkinUpdate& update, SkinLight& skin,
            std::vector<Asked>& asked) {
  const uint32_t count = uint32_t(skin.places.size());
  const size_t most = size_t(std::max(update.samples, 0));
  const std::vector<uint8_t> shows = find_visible(world, skin);
  if (std::find(shows.begin(), shows.end(), 1) == shows.end()) return;
  const uint64_t step = golden_step(count);
  auto place_at = [&](uint64_t i) { return uint32_t((i * step) % count); };
  auto take = [&](uint32_t place) { asked.push_back({place, skin.history[place].asked++}); };
  choose_seen(world, update, size_t(seen_share * float(most)), skin, asked);
  auto shown = [&](uint32_t place) {
    return shows[skin.places[place].instance - skin.first_instance];
  };
  for (uint32_t i = 0; i < count && asked.size() < most; i++) {
    uint32_t place = place_at(uint64_t(skin.cursor) + i);
    if (skin.history[place].asked == 0 && shown(place) &&
        is_faced(world, skin.places[place], update.views))
      take(place);
  }
  uint64_t looked = 0, looks = uint64_t(longest_period) * count;
  for (; looked < looks && asked.size() < most; looked++) {
    uint32_t place = place_at(skin.cursor);
    if (++skin.cursor == count) skin.cursor = 0, skin.turn++;
    if (!shown(place)) continue;
    uint32_t period = period_of(skin, place, is_faced(world, skin.places[place], update.views));
    if (((skin.turn + uint32_t(mix64(place))) & (period - 1)) == 0) take(place);
  }
}

// Returns the most light a sample may bring. Rare samples that are much brighter than the light
// kept would be visible as blotches for seconds.
float most_light(const SkinLight& skin, uint32_t place, float clamp) {
  const vec4& known = skin.light[place];
  if (!(clamp > 0) || !(known.w > 0)) return clamp;
  return std::min(clamp, most_over_known * (max_component(vec3(known)) + max_component(skin.mean)));
}

void add(SkinMean& mean, vec3 light, vec3 slope) {
  mean.count++;
  mean.slope += (slope - mean.slope) / mean.count;
  float before = luminance(light - mean.mean);
  mean.mean += (light - mean.mean) / mean.count;
  mean.squares += before * luminance(light - mean.mean);
}

// Makes the newer samples part of the older.
void join(SkinHistory& h) {
  SkinMean &to = h.older, &from = h.newer;
  if (to.count > most_older - window) {
    to.squares *= (most_older - window) / to.count;
    to.count = most_older - window;
  }
  float count = to.count + from.count, apart = luminance(from.mean - to.mean);
  to.squares += from.squares + apart * apart * to.count * from.count / count;
  to.mean += (from.mean - to.mean) * (from.count / count);
  to.slope += (from.slope - to.slope) * (from.count / count);
  to.count = count;
  from = {};
}

void remember(const Answer& answer, const Asked& asked, SkinLight& skin) {
  SkinHistory& h = skin.history[asked.place];
  if (!answer.valid) return;
  float blocked = answer.blocked ? 1.0f : 0.0f;
  h.blocked += (blocked - h.blocked) / std::min(float(asked.index + 1), blocked_window);
  if (answer.shut) return;
  add(h.newer, answer.light, find_slope(answer));
  if (h.newer.count >= window) join(h);
}

// Adds up the difference between newer and older means and its variance, of places that have both.
struct Difference {
  float sum = 0, squares = 0, freedom = 0, inverse = 0;
  void add(const SkinHistory& h) {
    if (h.newer.count < 1 || h.older.count < least_judged) return;
    sum += luminance(h.newer.mean - h.older.mean);
    squares += h.newer.squares + h.older.squares;
    freedom += h.newer.count + h.older.count - 2;
    inverse += 1 / h.newer.count + 1 / h.older.count;
  }
  bool surprises() const {
    return freedom >= 2 * window && sum * sum > surprise * surprise * inverse * squares / freedom;
  }
};

// Keeps only the last sample where light has changed, and lets neighbours' older samples count
// little. All places are compared before any is changed.
void drop_history(std::span<const Asked> asked, std::span<const Answer> answers, SkinLight& skin) {
  std::vector<uint8_t> dropped(asked.size(), 0);
  auto around = [&](uint32_t place) {
    return std::span(skin.edges)
        .subspan(skin.first_edge[place], skin.first_edge[place + 1] - skin.first_edge[place]);
  };
  parallel_ranges(int(asked.size()), 256, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      uint32_t place = asked[i].place;
      const SkinHistory& h = skin.history[place];
      if (h.newer.count < 1 || h.older.count < least_judged) continue;
      Difference d;
      d.add(h);
      for (const SkinEdge& e : around(place)) d.add(skin.history[e.place]);
      dropped[i] = d.surprises();
    }
  });
  for (size_t i = 0; i < asked.size(); i++) {
    if (!dropped[i]) continue;
    for (const SkinEdge& e : around(asked[i].place)) {
      SkinMean& older = skin.history[e.place].older;
      float left = std::min(1.0f, kept_nearby / std::max(older.count, kept_nearby));
      older.count *= left, older.squares *= left;
    }
  }
  for (size_t i = 0; i < asked.size(); i++) {
    if (!dropped[i]) continue;
    SkinHistory& h = skin.history[asked[i].place];
    h.older = {}, h.newer = {};
    if (answers[i].valid && !answers[i].shut)
      add(h.newer, answers[i].light, find_slope(answers[i]));
  }
}

}  // namespace

int update_skin(const World& world, const Lights& lights, const SkinUpdate& update,
                SkinLight& skin) {
  if (skin.places.empty()) return 0;
  std::vector<Asked> asked;
  choose(world, update, skin, asked);
  const Transport transport{world, *lights.tables, lights.known.get(), lights.lamps_seen.get()};
  WalkRules rules;
  rules.max_depth = update.transport.max_depth;
  if (lights.known) rules.blunt = gather_blunt;
  const SpectralTables* spectral = lights.tables->spectral.get();
  const bool hues = spectral && !spectral->rows.empty();
  std::vector<Answer> answers(asked.size());
  parallel_ranges(int(asked.size()), 64, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      Sampler sampler(mix64(update.seed ^ mix64(asked[i].place)), asked[i].index);
      answers[i] = gather(transport, rules, skin, asked[i].place, sampler);
      if (skin.history[asked[i].place].blocked > maybe_hidden || answers[i].blocked)
        answers[i].shut = is_shut(world, skin, asked[i].place, answers[i].blocked, sampler);
      vec3& light = answers[i].light;
      // Hues beyond the colours of a display are below zero in a channel (finish_samples).
      if (hues && is_finite(light)) light = max(light, vec3(0));
      if (!is_finite(light) || std::min({light.x, light.y, light.z}) < 0) {
        answers[i].valid = false;
        lights.bad_samples->fetch_add(1, std::memory_order_relaxed);
      }
      float most = most_light(skin, asked[i].place, update.transport.clamp);
      float largest = max_component(light);
      if (most > 0 && largest > most) scale(answers[i], most / largest);
    }
  });
  for (size_t i = 0; i < asked.size(); i++) remember(answers[i], asked[i], skin);
  drop_history(asked, answers, skin);
  return int(asked.size());
}

}  // namespace wellspring::light
