// SPDX-License-Identifier: Apache-2.0
// Holds the inside of a World, shared by world_rays.cpp (rays) and world_build.cpp (trees). Two
// Embree scenes: one for what stands still, built once at high quality, and one for what moves,
// refitted by commit(). A ray visits the still one, then the moving one if it meets its box before
// the hit. Measured against one scene with an instance per moving mesh: no instance transform on
// the way to walls, and commit() costs nothing that grows with the museum.
#pragma once
#include "world/embree.h"
#include "store/picture/sample_picture.h"
#include "world/tracked_volume.h"
#include "world/world.h"

namespace wellspring::world {

// Returns the one device for the whole process, never released: its threads outlive every World.
RTCDevice shared_device();
void count_rays(uint64_t more);  // for rays_traced()
Bounds box_of(const std::vector<vec3>& positions);

struct World::Impl {
  // Holds what a filter function needs of the geometry for which it is called.
  struct Tag {
    const Impl* impl;
    uint32_t instance;  // unused inside an Embree instance, whose own id tells the instance
    bool instanced;
    bool alpha = false;  // rays may pass some of its places
    bool pane = false;   // it may be a thin pane somewhere
  };
  struct Query : embree::Context {
    const Ray* rays = nullptr;  // one of these two
    const RayPacket* packet = nullptr;
    PanesPassed* panes = nullptr;  // gets the panes that a ray passes; null: panes block it
    Ray ray(unsigned i) const {
      if (rays) return rays[i];
      return {{packet->origin_x[i], packet->origin_y[i], packet->origin_z[i]},
              0,
              {packet->direction_x[i], packet->direction_y[i], packet->direction_z[i]},
              packet->t_max[i],
              (packet->from_eye >> i & 1) != 0};
    }
  };

  const Scene* scene = nullptr;
  std::vector<Mesh> moving;
  std::vector<PlacedMesh> placed;
  std::vector<std::pair<int, std::unique_ptr<Material>>>
      painted;  // copies of the scene's materials that repaint
  uint64_t paints = 0;
  std::vector<std::pair<int, std::unique_ptr<Material>>>
      of_lamps;  // copies of the materials of lamps
  LampLevels lamp_levels;
  std::vector<ShownPicture> pictures;  // for each of the images; empty: none is very large
  std::vector<PlacedVolume> volumes;
  std::vector<PlacedScan> scans;
  std::vector<TrackedVolume> tracked;    // those that stop rays
  std::vector<std::vector<Face>> faces;  // for each instance of the scene, if placed points to them
  std::vector<Tag> tags;                 // reserved up front: geometries point into it
  RTCScene still_scene = nullptr, moving_scene = nullptr;
  std::vector<RTCScene> mesh_scenes;     // scenes of the instanced meshes
  std::vector<uint32_t> still_instance;  // Embree geometry id -> instance
  std::vector<RTCGeometry> moving_geometry;
  std::vector<char> visible;
  std::vector<Bounds> moving_boxes;
  std::vector<int> moving_tangent_uv;  // texture coordinates of its tangents; -1: it has none
  // Area of each moving mesh's box when its tree was last built anew.
  std::vector<float> built_area;
  Bounds moving_bounds;        // bounds of all visible moving meshes
  bool any_moving = false;     // a moving mesh is visible
  bool any_one_sided = false;  // or stands in
  bool any_apart = false;
  bool moved = false;  // something has moved since the last commit

  ~Impl() {
    for (RTCGeometry geometry : moving_geometry) rtcReleaseGeometry(geometry);
    if (still_scene) rtcReleaseScene(still_scene);
    if (moving_scene) rtcReleaseScene(moving_scene);
    for (RTCScene s : mesh_scenes) rtcReleaseScene(s);
  }

  static void filter(const RTCFilterFunctionNArguments* arguments);
  static void filter_culled(const RTCFilterFunctionNArguments* arguments);
  static void filter_shadow(const RTCFilterFunctionNArguments* arguments);
  static Hit hit_of(const RTCFilterFunctionNArguments* arguments, unsigned i);
  // Returns whether the eye does not see the hit when it looks along `direction`.
  bool is_culled(const Hit& hit, vec3 direction) const;
  // Returns the nearest hit; every hit must pass `filter`, too.
  Hit nearest(const Ray& ray, RTCFilterFunctionN filter) const;
  // Returns what the eye sees along a ray whose nearest hit is known.
  Hit seen(const Ray& ray, const Hit& hit) const {
    return any_one_sided && ray.from_eye && is_culled(hit, ray.direction)
               ? nearest(ray, filter_culled)
               : hit;
  }
  // Returns whether a mesh is in the way of a ray that is traceable.
  bool is_occluded(const Ray& ray, PanesPassed* panes) const;
  // Return whether a volume is in the way of it, or of those rays of a packet.
  bool is_shaded(const Ray& ray) const { return !tracked.empty() && shades(tracked, ray); }
  uint32_t shaded(const RayPacket& rays, uint32_t active) const {
    return tracked.empty() || active == 0 ? 0 : shaded_lanes(rays, active);
  }
  uint32_t shaded_lanes(const RayPacket& rays, uint32_t active) const;
  RTCGeometry make_geometry(const Mesh& mesh, const mat4* to_world, const Tag& tag,
                            RTCBuildQuality);
  RTCGeometry make_apart(uint32_t instance, RTCBuildQuality quality);
  void build_still();
  void build_faces(PlacedMesh& placed, std::vector<Face>& faces);
  void build_moving();
  void update_moving_bounds();
  Hit to_hit(unsigned geometry, unsigned instance, unsigned primitive, float u, float v, float t,
             bool is_moving_hit) const {
    Hit hit;
    if (geometry == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.t = t;
    hit.triangle = primitive;
    hit.barycentric = {u, v};
    if (is_moving_hit) hit.instance = uint32_t(scene->instances.size()) + geometry;
    else hit.instance = still_instance[instance != RTC_INVALID_GEOMETRY_ID ? instance : geometry];
    return hit;
  }
  void intersect8(const Ray* rays, Hit* hits, int count) const;
  // Answers for lanes [first, first + width); Lanes is an RTCRay8 or RTCRay16.
  template <class Lanes, int width>
  uint32_t occluded_lanes(const RayPacket& rays, uint32_t active, int first) const;
};

}  // namespace wellspring::world
