// SPDX-License-Identifier: Apache-2.0
#include "show/visit/route.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <queue>

namespace wellspring::show {

namespace {

constexpr float spacing = 0.15f;  // metres between the points of a way
constexpr float thin_cost = 3;    // how much dearer a metre is if there is no room to spare
constexpr int smoothing_rounds = 150;

std::string name_place(vec3 p) { return fmt::format("({:.2f}, {:.2f}, {:.2f})", p.x, p.y, p.z); }

// Returns the distance from things that an edge between places needs so that all of it keeps the
// radius.
float need_of(const WalkMap& map) { return map.radius + 0.71f * map.cell; }

struct Open {
  float guess = 0;  // guessed length of the whole way
  int place = 0;
  bool operator<(const Open& other) const { return guess > other.guess; }
};

// Returns places from `from` to `to`; empty: none. `nearest` is the place reached that is nearest
// to `to`.
std::vector<int> search(const WalkMap& map, int from, int to, int& nearest) {
  const float need = need_of(map);
  const size_t count = map.places.size();
  std::vector<float> cost(count, INFINITY);
  std::vector<int32_t> before(count, -1);
  std::priority_queue<Open> open;
  auto left = [&](int p) {
    return glm::length(map.places[size_t(p)].ground - map.places[size_t(to)].ground);
  };
  cost[size_t(from)] = 0;
  open.push({left(from), from});
  nearest = from;
  std::vector<bool> done(count);
  while (!open.empty()) {
    int p = open.top().place;
    open.pop();
    if (done[size_t(p)]) continue;
    done[size_t(p)] = true;
    if (left(p) < left(nearest)) nearest = p;
    if (p == to) break;
    const WalkPlace& place = map.places[size_t(p)];
    for (int next : place.next) {
      if (next < 0 || done[size_t(next)]) continue;
      const WalkPlace& other = map.places[size_t(next)];
      if (other.clear < need && next != to) continue;
      float tight =
          std::clamp((map.farthest - other.clear) / (map.farthest - map.radius), 0.0f, 1.0f);
      float there = cost[size_t(p)] +
                    glm::length(other.ground - place.ground) * (1 + thin_cost * tight * tight);
      if (there >= cost[size_t(next)]) continue;
      cost[size_t(next)] = there;
      before[size_t(next)] = p;
      open.push({there + left(next), next});
    }
  }
  std::vector<int> way;
  if (cost[size_t(to)] == INFINITY) return way;
  for (int p = to; p >= 0; p = before[size_t(p)]) way.push_back(p);
  std::reverse(way.begin(), way.end());
  return way;
}

// Returns whether the straight line is free, at `keep` metres from things.
bool is_free(const WalkMap& map, vec3 a, vec3 b, float keep) {
  int steps = std::max(1, int(std::ceil(glm::length(b - a) / (0.5f * map.cell))));
  vec3 p = a;
  for (int i = 0; i <= steps; i++) {
    vec3 next = mix(a, b, float(i) / float(steps));
    p = {next.x, ground_at(map, next.x, next.z, p.y), next.z};
    if (clear_at(map, p) < keep) return false;
  }
  return std::abs(p.y - b.y) < walk_step;
}

// Cuts all corners that can be cut.
std::vector<vec3> pull(const WalkMap& map, const std::vector<vec3>& points) {
  std::vector<vec3> pulled{points.front()};
  for (size_t i = 0; i + 1 < points.size();) {
    size_t next = i + 1;
    // The next point is the farthest that can be seen: the range is halved until it is found.
    size_t low = 1, high = points.size() - 1 - i;
    while (low < high) {
      size_t middle = (low + high + 1) / 2;
      if (is_free(map, points[i], points[i + middle], map.radius + 0.05f)) low = middle;
      else high = middle - 1;
    }
    next = i + low;
    pulled.push_back(points[next]);
    i = next;
  }
  return pulled;
}

std::vector<vec3> resample(const std::vector<vec3>& points) {
  std::vector<vec3> result{points.front()};
  for (size_t i = 1; i < points.size(); i++) {
    int steps = std::max(1, int(std::ceil(glm::length(points[i] - points[i - 1]) / spacing)));
    for (int k = 1; k <= steps; k++)
      result.push_back(mix(points[i - 1], points[i], float(k) / float(steps)));
  }
  return result;
}

// Moves every point towards the middle of its neighbours, unless that leads too near to something.
void smooth(const WalkMap& map, std::vector<vec3>& points) {
  for (int round = 0; round < smoothing_rounds; round++)
    for (size_t i = 1; i + 1 < points.size(); i++) {
      vec3 p = mix(points[i], 0.5f * (points[i - 1] + points[i + 1]), 0.8f);
      p.y = ground_at(map, p.x, p.z, points[i].y);
      float now = clear_at(map, points[i]);
      if (clear_at(map, p) >= std::min(map.radius, now)) points[i] = p;
    }
}

}  // namespace

Route find_route(const WalkMap& map, vec3 from, vec3 to) {
  Route route;
  vec3 feet[2] = {from, to};
  int places[2];
  for (int i = 0; i < 2; i++) {
    feet[i].y -= map.eye_height;
    places[i] = find_place(map, feet[i], lean, need_of(map));
    if (places[i] < 0) {
      route.problem = "there is no room for a visitor of radius " +
                      fmt::format("{:.2f}", map.radius) + " m at " + name_place(feet[i]);
      return route;
    }
  }
  int nearest = places[0];
  std::vector<int> way = search(map, places[0], places[1], nearest);
  if (way.empty()) {
    route.problem = "there is no way for a visitor of radius " + fmt::format("{:.2f}", map.radius) +
                    " m from " + name_place(feet[0]) + " to " + name_place(feet[1]) +
                    "; it ends at " + name_place(map.places[size_t(nearest)].ground);
    return route;
  }
  std::vector<vec3> points;
  for (int p : way) points.push_back(map.places[size_t(p)].ground);
  points = pull(map, points);
  // The route ends at the given ends, not where the grid has a place.
  auto join = [&](vec3 foot, vec3& end) {
    foot.y = end.y;
    if (clear_at(map, foot) >= map.radius) end = foot;
    return foot;
  };
  vec3 first = join(feet[0], points.front()), last = join(feet[1], points.back());
  if (first != points.front()) points.insert(points.begin(), first);
  if (last != points.back()) points.push_back(last);
  points = resample(points);
  smooth(map, points);
  route.points = std::move(points);
  return route;
}

std::vector<int> reachable_places(const WalkMap& map, vec3 eye) {
  const float need = need_of(map);
  std::vector<int> places;
  const int first = find_place(map, eye - vec3(0, map.eye_height, 0), lean, need);
  if (first < 0) {
    for (size_t i = 0; i < map.places.size(); i++)
      if (map.places[i].clear >= need) places.push_back(int(i));
    return places;
  }
  std::vector<bool> found(map.places.size());
  found[size_t(first)] = true;
  places.push_back(first);
  for (size_t i = 0; i < places.size(); i++)
    for (int next : map.places[size_t(places[i])].next) {
      if (next < 0 || found[size_t(next)] || map.places[size_t(next)].clear < need) continue;
      found[size_t(next)] = true;
      places.push_back(next);
    }
  return places;
}

int nearest_of(const WalkMap& map, const std::vector<int>& places, vec3 ground) {
  int best = -1;
  float least = INFINITY;
  for (int place : places) {
    // Another storey counts as farther than it looks.
    vec3 way = (map.places[size_t(place)].ground - ground) * vec3(1, 3, 1);
    if (float distance = dot(way, way); distance < least) least = distance, best = place;
  }
  return best;
}

}  // namespace wellspring::show
