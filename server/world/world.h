// SPDX-License-Identifier: Apache-2.0
// Finds where rays end: a thin wrapper of Embree (3 or 4; world/embree.h hides the difference). The
// static scene is built once; moving meshes (the storyteller) are refitted each tick.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "world/placed_scan.h"
#include "world/placed_volume.h"
#include "world/scene.h"

namespace wellspring::store {
struct ShownPicture;  // store/picture/sample_picture.h
}

namespace wellspring::world {

// Says how a lamp of the scene shines.

inline constexpr uint8_t lamp_full = 255;
struct LampLevel {
  uint8_t level = lamp_full;  // 0: off; lamp_full: as bright as the scene has it
  uint8_t light = 0;          // 0: its own light; else one of Lamp::dial, counted from 1
  constexpr LampLevel() = default;
  constexpr LampLevel(int level, uint8_t light = 0) : level(uint8_t(level)), light(light) {}
  auto operator<=>(const LampLevel&) const = default;
};
using LampLevels = std::vector<LampLevel>;  // one for each of the scene's lamps
// Says how a lamp is switched: 0: off; 1: on; more: on with that light of Lamp::dial, counted from
// 2.
using LampSwitch = uint8_t;

// Returns the factor of the scene's own light; exactly 0 and 1 at the ends. The square of the
// level, so that steps in the dark are small, too.
inline float brightness_of(LampLevel level) {
  const float share = float(level.level) / float(lamp_full);
  return share * share;
}
// Returns the light that a lamp is set to; null: its own.
inline const LampLight* dialed(const Lamp& lamp, LampLevel level) {
  return level.light > 0 && level.light <= lamp.dial.size() ? &lamp.dial[level.light - 1u]
                                                            : nullptr;
}
// Returns the factor of a lamp's own light, by brightness and colour.
inline vec3 factor_of(const Lamp& lamp, LampLevel level) {
  const LampLight* light = dialed(lamp, level);
  return brightness_of(level) * (light ? light->factor : vec3(1));
}
// Returns these of all lamps of a scene.
std::vector<vec3> lamp_factors(const Scene& scene, std::span<const LampLevel> levels);

// Returns the level of that brightness, 0 to 1.
inline uint8_t level_of(float brightness) {
  return uint8_t(std::lround(float(lamp_full) * std::sqrt(brightness)));
}

struct Ray {
  vec3 origin{0};
  float t_min = 0;
  vec3 direction{0, 0, -1};
  float t_max = std::numeric_limits<float>::infinity();
  // The ray comes from the eye, straight or through thin panes: it passes back faces
  // (PlacedMesh::one_sided) and what stands in for something else (PlacedMesh::stands_in).
  // view_ray() sets it; light is stopped by both sides, and by stand-ins.
  bool from_eye = false;
  // The ray stands for a cone: its width at the origin, in metres, and how much wider it becomes a
  // metre. 0: none. Only very large pictures are read by it.
  float width = 0, spread = 0;
};

// Holds rays side by side, as vector units want them; t_min is 0.
struct RayPacket {
  static constexpr int lanes = 16;
  alignas(64) float origin_x[lanes], origin_y[lanes], origin_z[lanes];
  alignas(64) float direction_x[lanes], direction_y[lanes], direction_z[lanes], t_max[lanes];
  uint32_t from_eye = 0;  // a bit a lane, as in Ray; not used for occluders
};

struct Hit {
  float t = std::numeric_limits<float>::infinity();
  uint32_t instance = 0xffffffffu;  // index into the World's instances; none: nothing hit
  uint32_t triangle = 0;
  vec2 barycentric{0};  // weights of the triangle's second and third corner
  bool valid() const { return instance != 0xffffffffu; }
};

// Holds triangles of thin transmitting materials that a ray passed, each once, in no order.
struct PanesPassed {
  static constexpr int most = 16;
  Hit hits[most];
  int count = 0;
  bool more = false;  // more triangles than fit: the ray was taken for blocked
};

// Holds the place where a volume stops a ray.
struct VolumeHit {
  float t = 0;
  vec3 color{0};        // light that the matter there sends back along the ray
  uint32_t object = 0;  // PlacedVolume::object
};

// Returns how many rays this thread has traced so far, nearest hits and occluders alike: for
// measurements.
uint64_t rays_traced();

// Holds what shading needs of a triangle that stands still, in one cache line, world space. Places
// are corner + edge1 * barycentric.x + edge2 * barycentric.y.
struct alignas(64) Face {
  vec3 corner;
  float extent;  // SurfacePlace
  vec3 edge1;
  float flat;  // 1: the mesh's normals there are `normal`
  vec3 edge2;
  float plain = 0;  // 1: flat, with an area, and the material's base colour is the same all over
  vec3 normal;      // unit, towards the side the winding faces; 0: a triangle without area
};

// Holds all about an instance of a World, in one place for the shading loop.
struct PlacedMesh {
  const Mesh* mesh = nullptr;
  const Material* material = nullptr;
  uint32_t object = 0;
  bool moving = false;
  bool in_place = false;  // its vertices are in world space already
  bool mirrored = false;  // its winding is turned round (gltf::is_mirrored())
  mat4 to_world{1};
  // Inverse transpose of the upper 3x3 up to a positive factor: normalise after using it.
  mat3 normal_to_world{1};
  // One for each triangle; null: it moves, or is one of very many copies.
  const Face* faces = nullptr;
  uint32_t paints = 0;     // how often its material was repainted
  bool one_sided = false;  // the eye does not see its back faces (Scene::cull_back_faces)
  bool stands_in = false;  // the eye does not see it at all (Mesh::stands_in)
  // Its triangles are so small for its place that world coordinates are too coarse for them: the
  // tree and faces have them relative to to_world[3] (world/world_build.h).
  bool apart = false;
  // World::pictures() of its base colour; null: it has no very large picture.
  const ShownPicture* picture = nullptr;
  float steps = 0;  // not 0: SurfacePlace::extent counts this many steps of a coordinate
};

// Holds a scene with moving meshes. Instances [0, scene.instances.size()) are the scene's; the rest
// are `moving`, whose vertices are already in world space. Built once per exhibit; not copyable.
class World {
 public:
  // Borrows `scene` for its lifetime. `moving` meshes keep their triangle count for ever.
  // moving_object[i] is the object id of samples of moving[i] (append the name to scene.objects
  // first).
  World(const Scene& scene, std::vector<Mesh> moving = {},
        std::vector<uint32_t> moving_object = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  const Scene& scene() const;
  int instance_count() const;
  const Mesh& mesh_of(uint32_t instance) const;
  const Material& material_of(uint32_t instance) const;
  uint32_t object_of(uint32_t instance) const;
  const mat4& to_world(uint32_t instance) const;         // identity for moving ones
  const mat3& normal_to_world(uint32_t instance) const;  // as in PlacedMesh
  bool any_apart() const;                                // PlacedMesh::apart
  bool is_moving(uint32_t instance) const;
  // Bounds of all moving meshes that are visible; empty: low above high.
  Bounds moving_bounds() const;
  bool is_visible(uint32_t instance) const;           // false: moving, and hidden by show()
  const PlacedMesh& placed(uint32_t instance) const;  // all of the above at once

  // Replaces a moving mesh's vertices (same counts); show() shows or hides it. Call commit()
  // afterwards, while no ray is being traced. A vertex that is not finite stays where it was. If
  // the mesh has tangents, they are computed anew. `mirrored`: clockwise triangles show their
  // front.
  void move(int moving, std::span<const vec3> positions, std::span<const vec3> normals,
            bool mirrored = false);
  void show(int moving, bool visible);
  void commit();
  // Changes how a material that `repaints` looks on the meshes that move; the scene's own stays as
  // it is. The change counts from the scene's, not from the last one. While no ray is being traced.
  void repaint(int material, const Repaint& change);
  uint64_t paints() const;  // number of repaints so far

  // Dims the scene's lamps, or sets another light of theirs, by their numbers; all are full at
  // first. While no ray is being traced. Lights have to be updated, too: light/kept/lamps.h.
  void set_lamp(int lamp, LampLevel level);
  const LampLevels& lamp_levels() const;

  // Shows something else than the scene's where an image has a very large picture. While nothing
  // is drawn and no ray is being traced.
  void show_picture(int image, const ShownPicture& shown);
  // Returns what is shown of each of the scene's images; empty if it has no very large pictures.
  std::span<const ShownPicture> pictures() const;

  // Volumes stand in the scene from now on, in place of those before. While no ray is being traced.
  void place_volumes(std::vector<PlacedVolume> volumes);
  void show_volume(int volume, VolumeLook look);  // likewise
  std::span<const PlacedVolume> volumes() const;
  // Scans stand in the scene from now on, in place of those before; their stand-ins are meshes of
  // the scene. While nothing is drawn.
  void place_scans(std::vector<PlacedScan> scans);
  void show_scan(int scan, const ScanLook& look);  // likewise
  std::span<const PlacedScan> scans() const;
  // Returns where a volume stops the ray before t_end, if one does: a mean of many rays is what
  // pictures march through it. Rays are stopped by chance, decided by a hash of the ray, so that a
  // replay agrees. `maxima`: also by volumes that show the largest value along a ray, which is no
  // matter in the room.
  std::optional<VolumeHit> meet_volume(const Ray& ray, float t_end, bool maxima) const;
  // Returns whether the ray crosses a volume's bounds before t_end.
  bool has_volume_on(const Ray& ray, float t_end) const;
  // Returns light that glowing volumes send along the ray before t_end, which they stop nowhere:
  // right in the mean, by such a hash.
  vec3 volume_glow(const Ray& ray, float t_end) const;

  // Returns the nearest hit. Rays pass surfaces with alpha where their alpha says so (mask:
  // cut-off; blend: stochastically, decided by a hash of the ray and the hit, so that a replay
  // agrees). Rays of the eye pass back faces of instances that are one_sided: a ray that meets one
  // is traced again, so that other rays only pay for a look at the hit's normal. Thread-safe
  // between commits. A ray that is not finite hits nothing.
  Hit intersect(const Ray& ray) const;
  // Returns whether anything lies between t_min and t_max. Alpha as above. Glass counts as opaque.
  // Volumes stop the ray as in meet_volume(), but for maxima.
  bool occluded(const Ray& ray) const;
  // Does the same, but rays pass thin transmitting materials, which `panes` gets: the caller finds
  // how much light they let through.
  bool occluded(const Ray& ray, PanesPassed& panes) const;
  // Traces `count` coherent rays at once; results are those of intersect().
  void intersect_many(const Ray* rays, Hit* hits, int count) const;
  // Returns occluded(ray i) as bit i, for the rays whose bit is set in `active`. Pays if rays from
  // neighbouring places go to one light: measured 2.8 times as fast as one by one.
  uint32_t occluded_packet(const RayPacket& rays, uint32_t active) const;
  // These call intersect() and occluded() one by one for the rays whose bit is set in `active`,
  // with less work around each. Pays if rays have nothing in common. hits[i] is ray i's.
  void intersect_each(const RayPacket& rays, uint32_t active, Hit* hits) const;
  uint32_t occluded_each(const RayPacket& rays, uint32_t active) const;
  // Finds triangles that the unit direction `way` crosses between `before` metres before `place`
  // and `after` behind it (Hit::t from there); the line may pass beside a triangle by as much as
  // the larger of these. Returns at most `most`, in no order; triangles nearly parallel to `way` do
  // not count, nor does alpha.
  int find_near(vec3 place, vec3 way, float before, float after, Hit* hits, int most) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::world
