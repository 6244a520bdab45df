// SPDX-License-Identifier: Apache-2.0
#include "show/visit/good_view.h"

#include <algorithm>
#include <cmath>

#include "picture/keyframe.h"
#include "picture/laid_view.h"

namespace wellspring::show {
namespace {

constexpr int most_panes = 64;           // panes passed before a ray counts as lost
constexpr float finger = 0.02f;          // share of the picture's height
constexpr float steepest_ground = 0.7f;  // cosine; steeper surfaces are no ground
constexpr float storey = 20;             // metres in which ground is looked for below a place
// metres: half the diagonal of what is seen as one; half a side of a part
constexpr float largest = 3, part = 1.2f;
constexpr float farthest_look = 14;  // metres from which an object is looked at
constexpr float share = 0.75f;       // share of the picture that the object takes at most
constexpr float narrowest = 0.42f;   // radians, as if the visitor leant over the object
// How a part of a very large picture is looked at: its surroundings over itself, and radians.
constexpr float part_margin = 1.6f, narrowest_part = 0.03f;
constexpr size_t most_looks = 240;   // places tried with rays
constexpr size_t sample_count = 16;  // number of samples of an object's surface

// Holds a triangle, or a part of a volume's box: its middle, and the box around it.
struct SurfaceSample {
  vec3 place, normal;
  float area = 0;  // m^2
  vec3 low, high;
  bool solid = true;  // rays meet it
};

bool is_glass(const Material& material) { return material.transmission > 0.5f; }

using Objects = std::vector<uint32_t>;  // indices into Scene::objects

bool has(const Objects& objects, uint32_t object) {
  return object != 0 && std::ranges::find(objects, object) != objects.end();
}

// Returns the point of interest that an object belongs to; of several, the one with the fewest
// parts.
int point_of(const Exhibit& exhibit, uint32_t object) {
  int found = -1;
  size_t fewest = SIZE_MAX;
  for (size_t i = 0; i < exhibit.points.size(); i++) {
    const Objects& objects = exhibit.points[i].objects;
    if (objects.size() < fewest && has(objects, object)) found = int(i), fewest = objects.size();
  }
  return found;
}

vec3 normal_of(const World& world, const Hit& hit) {
  const Mesh& mesh = world.mesh_of(hit.instance);
  uvec3 corner = mesh.triangles[hit.triangle];
  vec3 normal = world.normal_to_world(hit.instance) *
                cross(mesh.positions[corner.y] - mesh.positions[corner.x],
                      mesh.positions[corner.z] - mesh.positions[corner.x]);
  float length = glm::length(normal);
  return length > 0 ? normal / length : vec3(0);
}

// Returns whether it is a storyteller's: an object that no node of the scene's files is.
bool is_figure(const World& world, uint32_t instance) {
  const uint32_t object = world.object_of(instance);
  const std::vector<int>& nodes = world.scene().object_nodes;
  return world.is_moving(instance) && (object >= nodes.size() || nodes[object] < 0);
}

// Adds parts of the boxes around volumes.
void add_volumes(const World& world, const Objects& objects, std::vector<SurfaceSample>& samples) {
  constexpr int parts = 3;  // parts a side
  for (const PlacedVolume& placed : world.volumes()) {
    if (!has(objects, placed.object)) continue;
    const Bounds box = bounds_of(placed);
    const vec3 size = (box.high - box.low) / float(parts);
    for (int i = 0; i < 6 * parts * parts; i++) {
      const int axis = i / 2 % 3, u = (axis + 1) % 3, v = (axis + 2) % 3;
      vec3 normal(0), low = box.low;
      normal[axis] = i % 2 ? 1.0f : -1.0f;
      low[u] += size[u] * float(i / 6 % parts), low[v] += size[v] * float(i / 6 / parts);
      if (i % 2) low[axis] = box.high[axis];
      vec3 high = low;
      high[u] += size[u], high[v] += size[v];
      samples.push_back({0.5f * (low + high), normal, size[u] * size[v], low, high, false});
    }
  }
}

// Returns the triangles of objects, or of the part of them around `near`.
std::vector<SurfaceSample> samples_of(const World& world, const Objects& objects,
                                      const std::optional<vec3>& near) {
  std::vector<SurfaceSample> samples;
  add_volumes(world, objects, samples);
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++) {
    if (!has(objects, world.object_of(i))) continue;
    const Mesh& mesh = world.mesh_of(i);
    for (size_t t = 0; t < mesh.triangles.size(); t++) {
      uvec3 corner = mesh.triangles[t];
      auto at = [&](uint32_t k) { return vec3(world.to_world(i) * vec4(mesh.positions[k], 1)); };
      const vec3 a = at(corner.x), b = at(corner.y), c = at(corner.z), place = (a + b + c) / 3.0f;
      vec3 away = near ? abs(place - *near) : vec3(0);
      if (std::max({away.x, away.y, away.z}) > part) continue;
      const vec3 across = cross(b - a, c - a);
      const float twice = glm::length(across);
      vec3 low = min(a, min(b, c)), high = max(a, max(b, c));
      if (near) low = max(low, *near - part), high = min(high, *near + part);
      samples.push_back({place, twice > 0 ? across / twice : vec3(0), 0.5f * twice, low, high});
    }
  }
  return samples;
}

Bounds bounds_of(const std::vector<SurfaceSample>& samples) {
  Bounds bounds;
  for (const SurfaceSample& sample : samples) {
    bounds.low = min(bounds.low, sample.low);
    bounds.high = max(bounds.high, sample.high);
  }
  return bounds;
}

// Keeps some samples, evenly by area: a knob of many triangles counts no more than it is large.
std::vector<SurfaceSample> thin_out(const std::vector<SurfaceSample>& samples) {
  float all = 0, sum = 0;
  for (const SurfaceSample& sample : samples) all += sample.area;
  std::vector<SurfaceSample> few;
  for (const SurfaceSample& sample : samples) {
    sum += sample.area;
    while (few.size() < sample_count && sum * sample_count > all * (float(few.size()) + 0.5f))
      few.push_back(sample);
  }
  // there is no area at all
  if (few.empty()) few = samples, few.resize(std::min(few.size(), sample_count));
  return few;
}

struct Look {
  vec3 eye{0};
  float yaw = 0, pitch = 0;
  float fov = 1;     // vertical, so that the whole object takes its share of it
  float wishes = 0;  // score, but for obstacles
};

// Returns the look from an eye to the middle of a box.
Look look_from(vec3 eye, const Bounds& box, float aspect) {
  Look look{.eye = eye};
  vec3 to = 0.5f * (box.low + box.high) - eye;
  look.yaw = std::atan2(-to.x, -to.z);
  look.pitch = std::atan2(to.y, glm::length(vec2(to.x, to.z)));
  const vec3 forward = normalize(to), right(std::cos(look.yaw), 0, -std::sin(look.yaw)),
             up = cross(right, forward);
  float tangent = 0;
  for (int i = 0; i < 8; i++) {
    vec3 corner(i & 1 ? box.low.x : box.high.x, i & 2 ? box.low.y : box.high.y,
                i & 4 ? box.low.z : box.high.z);
    vec3 d = corner - eye;
    float depth = std::max(dot(d, forward), 0.05f);
    tangent = std::max(
        {tangent, std::abs(dot(d, up)) / depth, std::abs(dot(d, right)) / (depth * aspect)});
  }
  look.fov = 2 * std::atan(tangent / share);
  return look;
}

// Returns how much of the samples is seen, and how squarely, 0 to 1 each.
vec2 seen_from(const World& world, vec3 eye, const Objects& objects,
               const std::vector<SurfaceSample>& samples) {
  float seen = 0, square = 0;
  for (const SurfaceSample& sample : samples) {
    vec3 way = sample.place - eye;
    float distance = glm::length(way);
    if (distance < 1e-3f) continue;
    Hit hit = first_solid(world, {eye, 0, way / distance, distance + 0.02f});
    const bool hidden = hit.valid() && hit.t < distance - 0.02f;
    const bool met = hit.valid() && has(objects, world.object_of(hit.instance));
    if (hidden || (sample.solid && !met)) continue;
    seen++;
    square += std::abs(dot(sample.normal, way / distance));
  }
  return vec2(seen, square) / float(std::max<size_t>(samples.size(), 1));
}

// Holds where an eye sees a volume or scan: metres along the axis.
struct SeenObject {
  uint32_t object = 0;
  float depth = 0;
};
// Returns the volume that hides most of what is behind it at a place of the picture, in pixels.
std::optional<SeenObject> volume_at(const World& world, const View& view, vec2 pixel,
                                    float surface) {
  const VolumeView volumes(world.volumes(), view, false, 0);
  const ivec2 whole(pixel);
  if (!volumes.shows(whole.x, whole.y, 1)) return {};
  const Laid laid = volumes.look(whole.x, whole.y, pixel - vec2(whole), all_lanes(surface));
  if (!std::isfinite(laid.depth[0])) return {};
  return SeenObject{laid.object[0], laid.depth[0]};
}

// Draws what the picture shows of scans around one of its places, in pixels.
class ScansAround {
 public:
  ScansAround(const World& world, const View& view, vec2 pixel, float reach) {
    const ShownScans scans{&world, nullptr, nullptr};
    if (scans.all().empty()) return;
    const ivec2 corner(glm::floor(pixel - reach)), end(glm::floor(pixel + reach));
    window_ = {corner.x, corner.y, end.x - corner.x + 1, end.y - corner.y + 1};
    const View part = window_view(view, window_);
    points_ = ScanView(scans, part, vec2(0.5f), false, work_.scans);
    const size_t pixels = size_t(part.width) * size_t(part.height);
    splats_.assign(has_splats(scans.all()) ? pixels : 0, INFINITY);
    Image8 image;
    image.width = part.width, image.height = part.height;
    image.rgb.resize(3 * pixels);
    if (!splats_.empty()) lay_splats_over(scans, part, work_.splats, image, splats_);
    splat_ = splat_object(scans.all());
  }
  // Returns what is seen of a scan at a pixel in reach.
  std::optional<SeenObject> at(vec2 pixel) const {
    const ivec2 to = ivec2(glm::floor(pixel)) - ivec2(window_.left, window_.top);
    if (to.x < 0 || to.y < 0 || to.x >= window_.width || to.y >= window_.height) return {};
    const ScanSurface seen = points_.any() ? points_.surface(to.x, to.y) : ScanSurface{};
    const float splat =
        splats_.empty() ? INFINITY : splats_[size_t(to.y) * size_t(window_.width) + size_t(to.x)];
    if (splat < seen.depth) return SeenObject{splat_, splat};
    if (!std::isfinite(seen.depth)) return {};
    return SeenObject{seen.object, seen.depth};
  }

 private:
  PictureWindow window_;
  LaidWork work_;
  ScanView points_;
  std::vector<float> splats_;
  uint32_t splat_ = 0;
};

}  // namespace

Hit first_solid(const World& world, Ray ray) {
  for (int i = 0; i < most_panes; i++) {
    Hit hit = world.intersect(ray);
    if (!hit.valid()) return hit;
    if (!is_figure(world, hit.instance) && !is_glass(world.material_of(hit.instance))) return hit;
    ray.t_min = hit.t + 1e-3f;
  }
  return {};
}

namespace {

// Finds the stand-in of what is seen of a scan, `distance` metres along a ray.
Hit stand_in_at(const World& world, Ray ray, float distance) {
  constexpr float near = 0.5f;  // metres
  ray.from_eye = false, ray.t_min = std::max(distance - near, 0.0f), ray.t_max = distance + near;
  const Hit hit = world.intersect(ray);
  return hit.valid() && world.placed(hit.instance).stands_in ? hit : Hit{};
}

}  // namespace

std::optional<Pointed> point_at(const Exhibit& exhibit, const World& world, const View& view,
                                vec2 at) {
  const vec2 size(view.width, view.height), pixel = at * size;
  const float reach = finger * size.y;
  const ScansAround scans(world, view, pixel, reach + 1);
  auto look = [&](vec2 place) { return view_ray(view, place.x, place.y); };
  const Ray ray = look(pixel);
  Hit hit = first_solid(world, ray);
  const float ahead = dot(ray.direction, view.forward);
  std::optional<SeenObject> seen = scans.at(pixel);
  if (seen && seen->depth < ahead * hit.t) hit = stand_in_at(world, ray, seen->depth / ahead);
  else seen.reset();
  const auto volume = volume_at(world, view, pixel, seen ? seen->depth : ahead * hit.t);
  if (volume) seen = volume;
  if (!hit.valid() && !seen) return {};
  Pointed pointed;
  const float distance = seen ? seen->depth / ahead : hit.t;
  pointed.place = ray.origin + ray.direction * distance;
  pointed.point = point_of(exhibit, seen ? seen->object : world.object_of(hit.instance));
  pointed.ground = pointed.place;
  if (!hit.valid() && volume) return pointed;
  const bool is_ground = hit.valid() && !volume && normal_of(world, hit).y > steepest_ground;
  if (!is_ground) {
    vec3 before = pointed.place - ray.direction * std::min(0.3f, 0.5f * distance);
    Hit below = first_solid(world, {before, 0, {0, -1, 0}, storey});
    pointed.ground = below.valid() ? before - vec3(0, below.t, 0) : before;
  }
  for (int i = 0; i < 8 && pointed.point < 0 && !is_ground; i++) {
    float angle = 0.25f * pi * float(i);
    const vec2 there = pixel + reach * vec2(std::cos(angle), std::sin(angle));
    const Ray beside = look(there);
    const Hit found = first_solid(world, beside);
    const auto scan = scans.at(there);
    const float depth = found.t * dot(beside.direction, view.forward);
    const bool near = scan && scan->depth < depth;
    if (!near && !found.valid()) continue;
    pointed.point = point_of(exhibit, near ? scan->object : world.object_of(found.instance));
    if (pointed.point < 0) continue;
    const float away = near ? scan->depth / dot(beside.direction, view.forward) : found.t;
    pointed.place = beside.origin + beside.direction * away;
  }
  return pointed;
}

std::optional<Viewpoint> good_view(const Exhibit& exhibit, const World& world, const WalkMap& map,
                                   const std::vector<int>& places, int point,
                                   std::optional<vec3> near, const Viewpoint& from, float aspect,
                                   float fov) {
  const PointOfInterest& thing = exhibit.points[size_t(point)];
  const vec3 eye_now = vec3(from.position - exhibit.scene.origin);
  std::vector<SurfaceSample> samples = samples_of(world, thing.objects, {});
  if (samples.empty()) return {};
  Bounds box = bounds_of(samples);
  if (!near && thing.half > 0) near = vec3(thing.place - exhibit.scene.origin);
  if (0.5f * glm::length(box.high - box.low) > largest) {
    if (!near)
      near = std::ranges::min_element(samples, {}, [&](const SurfaceSample& sample) {
               return glm::length(sample.place - eye_now);
             })->place;
    if (auto of_part = samples_of(world, thing.objects, near); !of_part.empty())
      samples = std::move(of_part), box = bounds_of(samples);
  }
  const vec3 middle = 0.5f * (box.low + box.high);
  const float direction = std::atan2(eye_now.x - middle.x, eye_now.z - middle.z);
  std::vector<Look> looks;
  for (int i : places) {
    const WalkPlace& place = map.places[size_t(i)];
    const vec3 eye = place.ground + vec3(0, map.eye_height, 0);
    if (glm::length(eye - middle) > farthest_look) continue;
    Look look = look_from(eye, box, aspect);
    float around =
        std::remainder(std::atan2(eye.x - middle.x, eye.z - middle.z) - direction, 2 * pi);
    float too_wide = std::max(0.0f, look.fov / fov - 1);
    // Wishes: as large as it can be without being cut, not seen from above, and the way that it was
    // looked at.
    look.wishes = -6 * too_wide - 0.8f * std::abs(std::log(std::min(look.fov / fov, 1.0f))) -
                  0.6f * std::abs(look.pitch) - 0.25f * std::abs(around);
    looks.push_back(look);
  }
  std::ranges::sort(looks, std::greater<>{}, &Look::wishes);
  if (looks.size() > most_looks) {  // keeps some of all, the best more densely
    for (size_t i = 0; i < most_looks; i++) {
      float t = float(i) / float(most_looks);
      looks[i] = looks[size_t(t * t * float(looks.size() - 1))];
    }
    looks.resize(most_looks);
  }
  samples = thin_out(samples);
  const Look* best = nullptr;
  float most = 0, best_seen = 0;
  for (const Look& look : looks) {
    vec2 seen = seen_from(world, look.eye, thing.objects, samples);
    float score = look.wishes + 4 * seen.x + 1.5f * seen.y;
    if (seen.x > 0 && (!best || score > most)) best = &look, most = score, best_seen = seen.x;
  }
  if (!best || best_seen <= 0) return {};
  Viewpoint view;
  view.position = exhibit.scene.origin + dvec3(best->eye);
  view.yaw = best->yaw;
  view.pitch = std::clamp(best->pitch, -1.45f, 1.45f);
  view.fov = std::clamp(best->fov, std::min(narrowest, fov), fov);
  if (thing.half > 0) {
    const dvec3 way = thing.place - view.position;
    view.yaw = float(std::atan2(-way.x, -way.z));
    view.pitch = std::clamp(float(std::atan2(way.y, length(dvec2(way.x, way.z)))), -1.45f, 1.45f);
    view.fov = std::clamp(2 * std::atan(part_margin * thing.half / float(length(way))),
                          narrowest_part, fov);
  }
  return view;
}

}  // namespace wellspring::show
