// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "world/mesh_finish.h"
#include "world/surface.h"
#include "world/world.h"
#include "world/world_impl.h"
#include "world/world_packet.h"

namespace wellspring::world {
namespace {

thread_local uint64_t traced = 0;

bool has_packets() {
  static bool native =
      rtcGetDeviceProperty(shared_device(), RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
  return native;
}

RTCRayHit to_embree(const Ray& ray) {
  RTCRayHit r;
  r.ray.org_x = ray.origin.x, r.ray.org_y = ray.origin.y, r.ray.org_z = ray.origin.z;
  r.ray.dir_x = ray.direction.x, r.ray.dir_y = ray.direction.y, r.ray.dir_z = ray.direction.z;
  r.ray.tnear = ray.t_min, r.ray.tfar = ray.t_max;
  r.ray.time = 0, r.ray.mask = ~0u, r.ray.id = 0, r.ray.flags = 0;
  r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return r;
}

// Returns false for NaN in origin or direction, for places Embree does not accept (it ends at
// 1.84e18), and for an empty interval.
bool is_traceable(const Ray& ray) {
  constexpr float farthest = 1e17f;
  vec3 sum = glm::abs(ray.origin) + glm::abs(ray.direction);
  return sum.x + sum.y + sum.z <= farthest && ray.t_min <= ray.t_max;
}

float half_area(const Bounds& box) {
  vec3 d = box.high - box.low;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

}  // namespace

uint64_t rays_traced() { return traced; }
void count_rays(uint64_t more) { traced += more; }

void World::Impl::update_moving_bounds() {
  moving_bounds = Bounds();
  for (size_t i = 0; i < moving.size(); i++) {
    if (!visible[i] || moving[i].triangles.empty()) continue;
    moving_bounds.low = glm::min(moving_bounds.low, moving_boxes[i].low);
    moving_bounds.high = glm::max(moving_bounds.high, moving_boxes[i].high);
  }
  any_moving = moving_bounds.low.x <= moving_bounds.high.x;
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const Scene& World::scene() const { return *impl_->scene; }
Bounds World::moving_bounds() const { return impl_->moving_bounds; }
int World::instance_count() const { return int(impl_->placed.size()); }
const PlacedMesh& World::placed(uint32_t instance) const { return impl_->placed[instance]; }
const Mesh& World::mesh_of(uint32_t instance) const { return *placed(instance).mesh; }
const Material& World::material_of(uint32_t instance) const { return *placed(instance).material; }
uint32_t World::object_of(uint32_t instance) const { return placed(instance).object; }
const mat4& World::to_world(uint32_t instance) const { return placed(instance).to_world; }
const mat3& World::normal_to_world(uint32_t instance) const {
  return placed(instance).normal_to_world;
}
bool World::any_apart() const { return impl_->any_apart; }
bool World::is_moving(uint32_t instance) const { return placed(instance).moving; }
bool World::is_visible(uint32_t instance) const {
  return !is_moving(instance) || impl_->visible[instance - impl_->scene->instances.size()];
}

void World::move(int moving, std::span<const vec3> positions, std::span<const vec3> normals,
                 bool mirrored) {
  Impl& w = *impl_;
  Mesh& mesh = w.moving.at(size_t(moving));
  if (positions.size() != mesh.positions.size() || normals.size() != mesh.normals.size())
    throw std::invalid_argument("World::move: mesh \"" + mesh.name + "\" keeps its vertex count");
  for (size_t i = 0; i < positions.size(); i++)
    if (is_finite(positions[i])) mesh.positions[i] = positions[i];
  std::copy(normals.begin(), normals.end(), mesh.normals.begin());
  w.placed[w.scene->instances.size() + size_t(moving)].mirrored = mirrored;
  if (int uv = w.moving_tangent_uv[size_t(moving)]; uv >= 0) update_tangents(mesh, uv);
  RTCGeometry geometry = w.moving_geometry[size_t(moving)];
  if (mesh.positions.empty()) return;
  std::memcpy(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0), mesh.positions.data(),
              mesh.positions.size() * sizeof(vec3));
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  w.moving_boxes[size_t(moving)] = box_of(mesh.positions);
  float area = half_area(w.moving_boxes[size_t(moving)]), &built = w.built_area[size_t(moving)];
  if (!(area < 2 * built) || area < 0.25f * built) {  // always the first time
    built = area;
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0);  // asks for a new tree
  }
  rtcCommitGeometry(geometry);
  w.moved = true;
}

void World::show(int moving, bool visible) {
  Impl& w = *impl_;
  if (bool(w.visible.at(size_t(moving))) == visible) return;
  w.visible[size_t(moving)] = visible;
  RTCGeometry geometry = w.moving_geometry[size_t(moving)];
  visible ? rtcEnableGeometry(geometry) : rtcDisableGeometry(geometry);
  w.moved = true;
}

void World::repaint(int material, const Repaint& change) {
  Impl& w = *impl_;
  for (auto& [number, own] : w.painted) {
    if (number != material) continue;
    *own = repainted(w.scene->materials[size_t(material)], change);
    w.paints++;
    for (PlacedMesh& placed : w.placed)
      if (placed.material == own.get()) placed.paints++;
  }
}

uint64_t World::paints() const { return impl_->paints; }

void World::set_lamp(int lamp, LampLevel level) {
  Impl& w = *impl_;
  if (w.lamp_levels.at(size_t(lamp)) == level) return;
  w.lamp_levels[size_t(lamp)] = level;
  const Lamp& set = w.scene->lamps[size_t(lamp)];
  const LampLight* light = dialed(set, level);
  for (int material : set.materials)
    for (auto& [number, worn] : w.of_lamps) {
      if (number != material) continue;
      *worn = dimmed(w.scene->materials[size_t(material)], factor_of(set, level),
                     light ? light->spectrum : -1);
    }
}

std::vector<vec3> lamp_factors(const Scene& scene, std::span<const LampLevel> levels) {
  std::vector<vec3> factors;
  for (size_t i = 0; i < levels.size(); i++)
    factors.push_back(factor_of(scene.lamps[i], levels[i]));
  return factors;
}

const LampLevels& World::lamp_levels() const { return impl_->lamp_levels; }

void World::show_picture(int image, const ShownPicture& shown) {
  impl_->pictures.at(size_t(image)) = shown;
}

std::span<const ShownPicture> World::pictures() const { return impl_->pictures; }

void World::commit() {
  if (!impl_->moved) return;
  impl_->moved = false;
  impl_->update_moving_bounds();
  rtcCommitScene(impl_->moving_scene);
}

bool World::Impl::is_culled(const Hit& hit, vec3 direction) const {
  if (!hit.valid()) return false;
  const PlacedMesh& mesh = placed[hit.instance];
  return mesh.stands_in || (mesh.one_sided && is_behind(mesh, hit.triangle, direction));
}

Hit World::Impl::nearest(const Ray& ray, RTCFilterFunctionN filter) const {
  traced++;
  Query query;
  embree::init(query);
  query.rays = &ray;
  RTCRayHit r = to_embree(ray);
  embree::intersect1(still_scene, query, r, filter);
  Hit hit =
      to_hit(r.hit.geomID, r.hit.instID[0], r.hit.primID, r.hit.u, r.hit.v, r.ray.tfar, false);
  if (any_moving && meets(moving_bounds, ray, r.ray.tfar)) {
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::intersect1(moving_scene, query, r, filter);
    if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID)
      hit = to_hit(r.hit.geomID, r.hit.instID[0], r.hit.primID, r.hit.u, r.hit.v, r.ray.tfar, true);
  }
  return hit;
}

Hit World::intersect(const Ray& ray) const {
  if (!is_traceable(ray)) return {};
  return impl_->seen(ray, impl_->nearest(ray, nullptr));
}

bool World::Impl::is_occluded(const Ray& ray, PanesPassed* panes) const {
  traced++;
  Query query;
  embree::init(query);
  query.rays = &ray;
  query.panes = panes;
  RTCRay r = to_embree(ray).ray;
  embree::occluded1(still_scene, query, r);
  if (r.tfar < ray.t_min) return true;  // Embree says so with -infinity
  if (!any_moving || !meets(moving_bounds, ray, ray.t_max)) return false;
  embree::occluded1(moving_scene, query, r);
  return r.tfar < ray.t_min;
}

bool World::occluded(const Ray& ray) const {
  return is_traceable(ray) && (impl_->is_occluded(ray, nullptr) || impl_->is_shaded(ray));
}

bool World::occluded(const Ray& ray, PanesPassed& panes) const {
  panes.count = 0;
  panes.more = false;
  if (!is_traceable(ray)) return false;
  const bool blocked = impl_->is_occluded(ray, &panes);
  if ((blocked && !panes.more) || !impl_->is_shaded(ray)) return blocked;
  panes.more = false;
  return true;
}

void World::Impl::intersect8(const Ray* rays, Hit* hits, int count) const {
  alignas(32) int valid[8];
  RTCRayHit8 r;
  Query query;
  embree::init(query);
  query.rays = rays;
  for (int i = 0; i < 8; i++) {
    const Ray& ray = rays[i < count ? i : 0];
    valid[i] = i < count && is_traceable(ray) ? -1 : 0;
    traced += valid[i] != 0;
    r.ray.org_x[i] = ray.origin.x, r.ray.org_y[i] = ray.origin.y, r.ray.org_z[i] = ray.origin.z;
    r.ray.dir_x[i] = ray.direction.x, r.ray.dir_y[i] = ray.direction.y;
    r.ray.dir_z[i] = ray.direction.z;
    r.ray.tnear[i] = ray.t_min, r.ray.tfar[i] = ray.t_max;
    r.ray.time[i] = 0, r.ray.mask[i] = ~0u, r.ray.id[i] = unsigned(i), r.ray.flags[i] = 0;
    r.hit.geomID[i] = r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  auto hit_of = [&](int i, bool is_moving_hit) {
    return to_hit(r.hit.geomID[i], r.hit.instID[0][i], r.hit.primID[i], r.hit.u[i], r.hit.v[i],
                  r.ray.tfar[i], is_moving_hit);
  };
  embree::intersect8(still_scene, query, valid, r);
  bool any = false;
  for (int i = 0; i < count; i++) {
    hits[i] = valid[i] ? hit_of(i, false) : Hit();
    if (valid[i] && !meets(moving_bounds, rays[i], r.ray.tfar[i])) valid[i] = 0;
    any |= valid[i] != 0;
    r.hit.geomID[i] = r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  if (!any) return;
  embree::intersect8(moving_scene, query, valid, r);
  for (int i = 0; i < count; i++)
    if (valid[i] && r.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) hits[i] = hit_of(i, true);
}

void World::intersect_many(const Ray* rays, Hit* hits, int count) const {
  int i = 0;
  if (has_packets())
    for (; i < count; i += 8) {
      const int end = std::min(i + 8, count);
      impl_->intersect8(rays + i, hits + i, end - i);
      for (int k = i; k < end; k++) hits[k] = impl_->seen(rays[k], hits[k]);
    }
  for (; i < count; i++) hits[i] = intersect(rays[i]);
}

// Finds triangles around a place by Embree's point queries.

namespace {

struct Search {
  const World* world;
  glm::dvec3 from, way;  // unit
  double before, after, slack;
  uint32_t first_moving, is_moving;
  const uint32_t* still_instance;
  Hit* hits;
  int most, count = 0;
};

// Finds where the line from `from` along `way` crosses the triangle, as far as `slack` beside it.
bool cross_triangle(const Search& s, uint32_t instance, uint32_t triangle, Hit& hit) {
  const PlacedMesh& placed = s.world->placed(instance);
  uvec3 index = placed.mesh->triangles[triangle];
  glm::dvec3 c[3];
  for (int i = 0; i < 3; i++) {
    vec3 p = placed.mesh->positions[index[i]];
    glm::dvec3 from = s.from;
    if (placed.apart) {
      p = mat3(placed.to_world) * p;
      from -= glm::dvec3(placed.to_world[3]);
    } else if (!placed.in_place) {
      p = vec3(placed.to_world * vec4(p, 1));  // rounded as the tree has it
    }
    c[i] = glm::dvec3(p) - from;
  }
  glm::dvec3 normal = cross(c[1] - c[0], c[2] - c[0]);
  double area = length(normal);
  if (!(area > 0)) return false;
  double slope = dot(normal, s.way) / area;
  // The triangle is nearly parallel to the line: the next ray meets it.
  if (std::abs(slope) < 0.05) return false;
  double along = dot(normal, c[0]) / (area * slope);
  if (!(along >= -s.before && along <= s.after)) return false;
  glm::dvec3 at = along * s.way;
  double weight[3];
  for (int i = 0; i < 3; i++) {
    glm::dvec3 a = c[(i + 1) % 3], edge = c[(i + 2) % 3] - a;
    // This is the distance to the edge times its length.
    double inside = dot(cross(edge, at - a), normal) / area;
    if (!(inside >= -s.slack * length(edge))) return false;
    weight[i] = glm::clamp(inside / area, 0.0, 1.0);
  }
  hit.t = float(along);
  hit.instance = instance;
  hit.triangle = triangle;
  hit.barycentric = vec2(float(weight[1]), float(weight[2]));
  return true;
}

bool collect(RTCPointQueryFunctionArguments* a) {
  Search& s = *static_cast<Search*>(a->userPtr);
  uint32_t instance =
      s.is_moving
          ? s.first_moving + a->geomID
          : s.still_instance[a->context->instStackSize > 0 ? a->context->instID[0] : a->geomID];
  Hit hit;
  if (s.count < s.most && cross_triangle(s, instance, a->primID, hit)) s.hits[s.count++] = hit;
  return false;  // the radius stays
}

}  // namespace

int World::find_near(vec3 place, vec3 way, float before, float after, Hit* hits, int most) const {
  const Impl& w = *impl_;
  float radius = std::max(before, after);
  constexpr float farthest = 1e17f;
  vec3 size = glm::abs(place);
  if (!(size.x <= farthest && size.y <= farthest && size.z <= farthest && radius <= farthest))
    return 0;
  Search search{this,
                glm::dvec3(place),
                glm::dvec3(way),
                double(before),
                double(after),
                double(radius),
                uint32_t(w.scene->instances.size()),
                0,
                w.still_instance.data(),
                hits,
                most};
  RTCPointQuery query;
  query.x = place.x, query.y = place.y, query.z = place.z;
  query.radius = radius;
  query.time = 0;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(w.still_scene, &query, &context, collect, &search);
  const Bounds& box = w.moving_bounds;
  vec3 reach(radius);
  if (box.low.x <= box.high.x && glm::all(glm::lessThanEqual(box.low - reach, place)) &&
      glm::all(glm::lessThanEqual(place, box.high + reach))) {
    search.is_moving = 1;
    rtcPointQuery(w.moving_scene, &query, &context, collect, &search);
  }
  return search.count;
}

}  // namespace wellspring::world
