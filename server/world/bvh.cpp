// SPDX-License-Identifier: Apache-2.0
// Two Embree scenes: what stands still, built once at high quality, and what moves, refitted by
// commit(). A ray visits the still one, then the moving one if it meets its box before the hit.
// Measured against one scene with an instance per moving mesh: no instance transform on the way to
// walls, and commit() costs nothing that grows with the museum.
#include "world/bvh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>

#include "base/log.h"
#include "world/bvh_alpha.h"
#include "world/embree.h"

namespace wellspring {
namespace {

// Repeated meshes are copied into world space while all copies together stay below this many
// triangles: measured, a flat scene is traced 1.5 times as fast, for 200 bytes a triangle. Beyond
// it they become Embree instances.
constexpr size_t flat_triangle_budget = 1'000'000;
constexpr size_t high_quality_limit = 4'000'000;  // beyond it the build trades quality for time

// One device for the whole process, never released: its threads outlive every World.
RTCDevice shared_device() {
  static RTCDevice device = [] {
    RTCDevice made = rtcNewDevice(nullptr);
    if (!made) throw std::runtime_error("Embree cannot start on this machine");
    rtcSetDeviceErrorFunction(
        made,
        [](void*, RTCError code, const char* message) {
          log::error("Embree error {}: {}", int(code), message ? message : "");
        },
        nullptr);
    return made;
  }();
  return device;
}

bool has_packets() {
  static bool native =
      rtcGetDeviceProperty(shared_device(), RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
  return native;
}

// Inverse transpose up to a positive factor, also for flattened (singular) transforms: the cofactor
// matrix, which is the determinant times the inverse transpose, with the sign taken out.
mat3 normal_matrix(const mat4& to_world) {
  mat3 m(to_world);
  float largest = 0;
  for (int i = 0; i < 3; i++) largest = std::max(largest, max_component(glm::abs(m[i])));
  if (!(largest > 0) || !std::isfinite(largest)) return mat3(1);
  m /= largest;
  mat3 cofactor(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
  return dot(m[0], cofactor[0]) < 0 ? -cofactor : cofactor;
}

bool is_mirrored(const mat4& to_world) {
  mat3 m(to_world);
  return dot(normalize(m[0]), cross(normalize(m[1]), normalize(m[2]))) < 0;
}

bool is_singular(const mat4& to_world) {
  mat3 m(to_world);
  float scale = length(m[0]) * length(m[1]) * length(m[2]);
  return !(std::abs(glm::determinant(m)) > 1e-6f * scale);
}

void check_mesh(const Mesh& mesh, size_t material_count) {
  if (mesh.material < 0 || size_t(mesh.material) >= material_count)
    throw std::invalid_argument("World: mesh \"" + mesh.name + "\" has no such material");
  for (const uvec3& triangle : mesh.triangles)
    if (std::max({triangle.x, triangle.y, triangle.z}) >= mesh.positions.size())
      throw std::invalid_argument("World: mesh \"" + mesh.name + "\" has an index out of range");
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

// False for NaN and infinity in origin or direction, and for an empty interval.
bool is_traceable(const Ray& ray) {
  vec3 sum = (ray.origin + ray.direction) * 0.0f;
  return sum.x + sum.y + sum.z == 0 && ray.t_min <= ray.t_max;
}

Bounds box_of(const std::vector<vec3>& positions) {
  Bounds box;
  for (const vec3& p : positions) {
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
  }
  return box;
}

float half_area(const Bounds& box) {
  vec3 d = box.high - box.low;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

bool meets(const Bounds& box, const Ray& ray, float t_max) {
  if (!(box.low.x <= box.high.x)) return false;  // nothing moves, or all is hidden
  vec3 inverse = 1.0f / ray.direction;
  vec3 a = (box.low - ray.origin) * inverse, b = (box.high - ray.origin) * inverse;
  float near = ray.t_min, far = t_max;
  for (int i = 0; i < 3; i++) {
    // fmin and fmax skip the NaN of a ray lying in a slab's plane.
    near = std::fmax(near, std::fmin(a[i], b[i]));
    far = std::fmin(far, std::fmax(a[i], b[i]));
  }
  return near <= far * 1.00001f;
}

}  // namespace

struct World::Impl {
  // What a filter function needs to know about the geometry it is called for.
  struct Tag {
    const Impl* impl;
    uint32_t instance;  // unused inside an Embree instance, whose own id says which it is
    bool instanced;
  };
  struct Query : embree::Context {
    const Ray* rays;
  };

  const Scene* scene = nullptr;
  std::vector<Mesh> moving;
  std::vector<PlacedMesh> placed;
  std::vector<Tag> tags;  // reserved up front: geometries point into it
  RTCScene still_scene = nullptr, moving_scene = nullptr;
  std::vector<RTCScene> mesh_scenes;     // of the instanced meshes
  std::vector<uint32_t> still_instance;  // Embree geometry id -> instance
  std::vector<RTCGeometry> moving_geometry;
  std::vector<char> visible;
  std::vector<Bounds> moving_boxes;
  std::vector<float> built_area;  // of a moving mesh's box when its tree was last built anew
  Bounds moving_bounds;           // of all that is visible
  bool moved = false;             // since the last commit

  ~Impl() {
    for (RTCGeometry geometry : moving_geometry) rtcReleaseGeometry(geometry);
    if (still_scene) rtcReleaseScene(still_scene);
    if (moving_scene) rtcReleaseScene(moving_scene);
    for (RTCScene s : mesh_scenes) rtcReleaseScene(s);
  }

  static void filter(const RTCFilterFunctionNArguments* arguments);
  RTCGeometry make_geometry(const Mesh& mesh, const mat4* to_world, const Tag& tag,
                            RTCBuildQuality);
  void build_still();
  void build_moving();
  void update_moving_bounds();
  Hit to_hit(unsigned geometry, unsigned instance, unsigned primitive, float u, float v, float t,
             bool is_moving_hit) const {
    Hit hit;
    if (geometry == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.t = t;
    hit.triangle = primitive;
    hit.barycentric = {u, v};
    if (is_moving_hit)
      hit.instance = uint32_t(scene->instances.size()) + geometry;
    else
      hit.instance = still_instance[instance != RTC_INVALID_GEOMETRY_ID ? instance : geometry];
    return hit;
  }
  void intersect8(const Ray* rays, Hit* hits, int count) const;
};

void World::Impl::filter(const RTCFilterFunctionNArguments* arguments) {
  const Tag& tag = *static_cast<const Tag*>(arguments->geometryUserPtr);
  const Query& query = *static_cast<const Query*>(arguments->context);
  const Impl& impl = *tag.impl;
  for (unsigned i = 0; i < arguments->N; i++) {
    if (arguments->valid[i] != -1) continue;
    uint32_t instance = tag.instance;
    if (tag.instanced)
      instance = impl.still_instance[RTCHitN_instID(arguments->hit, arguments->N, i, 0)];
    vec2 barycentric{RTCHitN_u(arguments->hit, arguments->N, i),
                     RTCHitN_v(arguments->hit, arguments->N, i)};
    uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    const Ray& ray = query.rays[RTCRayN_id(arguments->ray, arguments->N, i)];
    if (passes(*impl.scene, impl.placed[instance], instance, triangle, barycentric, ray))
      arguments->valid[i] = 0;
  }
}

// A triangle geometry with its own copy of the vertices, in world space if `to_world` is given.
// Embree has no empty buffers, so an empty mesh becomes one point, which nothing hits.
RTCGeometry World::Impl::make_geometry(const Mesh& mesh, const mat4* to_world, const Tag& tag,
                                       RTCBuildQuality quality) {
  RTCGeometry geometry = rtcNewGeometry(shared_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<vec3*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3),
                              std::max<size_t>(mesh.positions.size(), 1)));
  auto* triangles = static_cast<uvec3*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3),
                              std::max<size_t>(mesh.triangles.size(), 1)));
  if (!positions || !triangles) {
    rtcReleaseGeometry(geometry);
    throw std::bad_alloc();
  }
  positions[0] = vec3(0);
  triangles[0] = uvec3(0);
  for (size_t i = 0; i < mesh.positions.size(); i++)
    positions[i] = to_world ? vec3(*to_world * vec4(mesh.positions[i], 1)) : mesh.positions[i];
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  rtcSetGeometryBuildQuality(geometry, quality);
  tags.push_back(tag);
  rtcSetGeometryUserData(geometry, &tags.back());
  if (may_pass(mesh, scene->materials[size_t(mesh.material)])) {
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
  }
  rtcCommitGeometry(geometry);
  return geometry;
}

void World::Impl::build_still() {
  // Which meshes are repeated so often that copying them would take too much? Largest total first.
  std::vector<size_t> uses(scene->meshes.size(), 0);
  for (const Instance& instance : scene->instances) uses[size_t(instance.mesh)]++;
  std::vector<size_t> order(scene->meshes.size());
  for (size_t i = 0; i < order.size(); i++) order[i] = i;
  auto total = [&](size_t mesh) { return uses[mesh] * scene->meshes[mesh].triangles.size(); };
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return total(a) < total(b); });
  size_t flat_triangles = 0;
  std::vector<char> flat(scene->meshes.size(), 0);
  for (size_t mesh : order) {
    if (uses[mesh] > 1 && flat_triangles + total(mesh) > flat_triangle_budget) continue;
    flat[mesh] = 1;
    flat_triangles += total(mesh);
  }

  bool high_quality = flat_triangles < high_quality_limit;
  auto quality = high_quality ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
  auto new_scene = [&] {
    RTCScene made = rtcNewScene(shared_device());
    rtcSetSceneFlags(made, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(made, quality);
    return made;
  };
  still_scene = new_scene();
  std::vector<RTCScene> scene_of_mesh(scene->meshes.size(), nullptr);
  for (uint32_t i = 0; i < scene->instances.size(); i++) {
    const Instance& instance = scene->instances[i];
    const Mesh& mesh = scene->meshes[size_t(instance.mesh)];
    if (mesh.triangles.empty()) continue;
    RTCGeometry geometry = nullptr;
    // Embree inverts an instance's transform; a flattened one has no inverse, so it is copied too.
    if (flat[size_t(instance.mesh)] || is_singular(instance.to_world)) {
      geometry = make_geometry(mesh, &instance.to_world, {this, i, false}, quality);
    } else {
      RTCScene& of_mesh = scene_of_mesh[size_t(instance.mesh)];
      if (!of_mesh) {
        of_mesh = new_scene();
        mesh_scenes.push_back(of_mesh);
        RTCGeometry shared = make_geometry(mesh, nullptr, {this, i, true}, quality);
        rtcAttachGeometry(of_mesh, shared);
        rtcReleaseGeometry(shared);
        rtcCommitScene(of_mesh);
      }
      geometry = rtcNewGeometry(shared_device(), RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, of_mesh);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                              &instance.to_world[0][0]);
      rtcCommitGeometry(geometry);
    }
    rtcAttachGeometryByID(still_scene, geometry, unsigned(still_instance.size()));
    rtcReleaseGeometry(geometry);
    still_instance.push_back(i);
  }
  rtcCommitScene(still_scene);
}

void World::Impl::build_moving() {
  moving_scene = rtcNewScene(shared_device());
  // Refitting needs both the dynamic flag and low scene quality; with medium quality Embree 3
  // builds the tree anew at every commit (20,000 triangles: 5.3 ms instead of 0.3 ms).
  rtcSetSceneFlags(moving_scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
  rtcSetSceneBuildQuality(moving_scene, RTC_BUILD_QUALITY_LOW);
  uint32_t first = uint32_t(scene->instances.size());
  for (uint32_t i = 0; i < moving.size(); i++) {
    RTCGeometry geometry =
        make_geometry(moving[i], nullptr, {this, first + i, false}, RTC_BUILD_QUALITY_REFIT);
    rtcAttachGeometryByID(moving_scene, geometry, i);
    moving_geometry.push_back(geometry);
  }
  visible.assign(moving.size(), 1);
  built_area.assign(moving.size(), 0);
  for (const Mesh& mesh : moving) moving_boxes.push_back(box_of(mesh.positions));
  update_moving_bounds();
  rtcCommitScene(moving_scene);
}

void World::Impl::update_moving_bounds() {
  moving_bounds = Bounds();
  for (size_t i = 0; i < moving.size(); i++) {
    if (!visible[i] || moving[i].triangles.empty()) continue;
    moving_bounds.low = glm::min(moving_bounds.low, moving_boxes[i].low);
    moving_bounds.high = glm::max(moving_bounds.high, moving_boxes[i].high);
  }
}

World::World(const Scene& scene, std::vector<Mesh> moving, std::vector<uint32_t> moving_object)
    : impl_(std::make_unique<Impl>()) {
  Impl& w = *impl_;
  w.scene = &scene;
  w.moving = std::move(moving);
  for (const Mesh& mesh : scene.meshes) check_mesh(mesh, scene.materials.size());
  for (Mesh& mesh : w.moving) {
    check_mesh(mesh, scene.materials.size());
    for (vec3& p : mesh.positions)
      if (!is_finite(p)) p = vec3(0);
  }
  for (const Instance& instance : scene.instances) {
    if (instance.mesh < 0 || size_t(instance.mesh) >= scene.meshes.size())
      throw std::invalid_argument("World: an instance has no such mesh");
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    w.placed.push_back({&mesh, &scene.materials[size_t(mesh.material)], instance.object, false,
                        is_mirrored(instance.to_world), instance.to_world,
                        normal_matrix(instance.to_world)});
  }
  for (size_t i = 0; i < w.moving.size(); i++)
    w.placed.push_back({&w.moving[i], &scene.materials[size_t(w.moving[i].material)],
                        i < moving_object.size() ? moving_object[i] : 0, true, false, mat4(1),
                        mat3(1)});
  w.tags.reserve(scene.instances.size() + scene.meshes.size() + w.moving.size());
  w.build_still();
  w.build_moving();
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const Scene& World::scene() const { return *impl_->scene; }
int World::instance_count() const { return int(impl_->placed.size()); }
const PlacedMesh& World::placed(uint32_t instance) const { return impl_->placed[instance]; }
const Mesh& World::mesh_of(uint32_t instance) const { return *placed(instance).mesh; }
const Material& World::material_of(uint32_t instance) const { return *placed(instance).material; }
uint32_t World::object_of(uint32_t instance) const { return placed(instance).object; }
const mat4& World::to_world(uint32_t instance) const { return placed(instance).to_world; }
const mat3& World::normal_to_world(uint32_t instance) const {
  return placed(instance).normal_to_world;
}
bool World::is_moving(uint32_t instance) const { return placed(instance).moving; }

void World::move(int moving, std::span<const vec3> positions, std::span<const vec3> normals) {
  Impl& w = *impl_;
  Mesh& mesh = w.moving.at(size_t(moving));
  if (positions.size() != mesh.positions.size() || normals.size() != mesh.normals.size())
    throw std::invalid_argument("World::move: mesh \"" + mesh.name + "\" keeps its vertex count");
  for (size_t i = 0; i < positions.size(); i++)
    if (is_finite(positions[i])) mesh.positions[i] = positions[i];
  std::copy(normals.begin(), normals.end(), mesh.normals.begin());
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

void World::commit() {
  if (!impl_->moved) return;
  impl_->moved = false;
  impl_->update_moving_bounds();
  rtcCommitScene(impl_->moving_scene);
}

Hit World::intersect(const Ray& ray) const {
  const Impl& w = *impl_;
  Hit hit;
  if (!is_traceable(ray)) return hit;
  Impl::Query query;
  embree::init(query);
  query.rays = &ray;
  RTCRayHit r = to_embree(ray);
  embree::intersect1(w.still_scene, query, r);
  hit = w.to_hit(r.hit.geomID, r.hit.instID[0], r.hit.primID, r.hit.u, r.hit.v, r.ray.tfar, false);
  if (meets(w.moving_bounds, ray, r.ray.tfar)) {
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::intersect1(w.moving_scene, query, r);
    if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID)
      hit =
          w.to_hit(r.hit.geomID, r.hit.instID[0], r.hit.primID, r.hit.u, r.hit.v, r.ray.tfar, true);
  }
  return hit;
}

bool World::occluded(const Ray& ray) const {
  const Impl& w = *impl_;
  if (!is_traceable(ray)) return false;
  Impl::Query query;
  embree::init(query);
  query.rays = &ray;
  RTCRay r = to_embree(ray).ray;
  embree::occluded1(w.still_scene, query, r);
  if (r.tfar < ray.t_min) return true;  // Embree says so with -infinity
  if (!meets(w.moving_bounds, ray, ray.t_max)) return false;
  embree::occluded1(w.moving_scene, query, r);
  return r.tfar < ray.t_min;
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
    for (; i < count; i += 8) impl_->intersect8(rays + i, hits + i, std::min(8, count - i));
  for (; i < count; i++) hits[i] = intersect(rays[i]);
}

}  // namespace wellspring
