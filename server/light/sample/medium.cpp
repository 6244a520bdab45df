// SPDX-License-Identifier: Apache-2.0
#include "light/sample/medium.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "light/material/bsdf.h"
#include "light/sample/light_tables.h"
#include "light/sample/pane_boxes.h"
#include "light/sample/transport.h"

namespace wellspring::light {
namespace {

bool is_solid(const Surface& surface, const Material& material) {
  return material.thickness > 0 && surface.transmission > 0;
}

int count_of(const MediumStack& stack, int material) {
  return int(std::count(stack.material, stack.material + stack.count, material));
}

void enter_before_all(MediumStack& stack, int material) {
  if (stack.count == MediumStack::most) return;
  std::copy_backward(stack.material, stack.material + stack.count,
                     stack.material + stack.count + 1);
  stack.material[0] = material;
  stack.count++;
}

float size_of(const World& world, uint32_t instance) {
  Bounds box = bounds_of(world.placed(instance));
  return length(box.high - box.low);
}

// Holds faces of one boundary, by material.
struct Crossing {
  int material;
  bool enters = false, leaves = false;
  uint32_t instance;  // instance that is entered, or else left
};
struct Crossings {
  static constexpr int most = 8;
  Crossing list[most];
  int count = 0;
};

// Adds one more face of a boundary; a ray between two triangles of one face crosses it once.
void add_crossing(Crossings& all, const Surface& surface, uint32_t instance) {
  int i = 0;
  while (i < all.count && all.list[i].material != surface.material) i++;
  if (i == Crossings::most) return;
  if (i == all.count) all.list[all.count++] = {surface.material, false, false, instance};
  (surface.front ? all.list[i].enters : all.list[i].leaves) = true;
  if (surface.front) all.list[i].instance = instance;
}

// Adds the faces that coincide with a solid's surface, as far as a ray's next origin would pass
// over them. Returns true if an opaque face is there; `hit` is then on it.
bool find_coincident(const World& world, const Surface& surface, bool pass_opaque, Hit& hit,
                     Crossings& all) {
  vec3 way = -surface.geometric_normal;
  float step = dot(offset_origin(surface, way) - surface.position, way);
  float before = std::min(step, position_error(surface));
  std::array<Hit, 2 * Crossings::most> near;
  int count = world.find_near(surface.position, way, before, step, near.data(), int(near.size()));
  // They come in the order of the tree, on which results may not depend.
  std::sort(near.begin(), near.begin() + count, [](const Hit& a, const Hit& b) {
    return a.instance != b.instance ? a.instance < b.instance : a.triangle < b.triangle;
  });
  Ray across;
  across.origin = surface.position - way;
  across.direction = way;
  for (int i = 0; i < count; i++) {
    if (near[i].instance == hit.instance && near[i].triangle == hit.triangle) continue;
    const Material& material = world.material_of(near[i].instance);
    if (material.transmission == 0 && material.alpha_mode == AlphaMode::opaque) {
      if (pass_opaque) continue;
      near[i].t = hit.t;
      hit = near[i];
      return true;
    }
    if (!(material.thickness > 0)) continue;
    Surface other = eval_surface(world, across, near[i]);
    if (is_solid(other, material)) add_crossing(all, other, near[i].instance);
  }
  return false;
}

// Crosses a boundary. A body that ends where another of its material begins is no boundary, nor is
// one met on its edge. If several solids are entered at once, the smaller is taken as the inner
// one.
void cross(const World& world, Crossings& all, Media& media) {
  Crossing* end = std::remove_if(all.list, all.list + all.count,
                                 [](const Crossing& c) { return c.enters && c.leaves; });
  Crossing* enters =
      std::stable_partition(all.list, end, [](const Crossing& c) { return c.leaves; });
  for (Crossing* c = all.list; c < enters; c++)
    if (count_of(media.here, c->material) == 0) enter_before_all(media.here, c->material);
  if (end - enters > 1)
    std::sort(enters, end, [&](const Crossing& a, const Crossing& b) {
      float sa = size_of(world, a.instance), sb = size_of(world, b.instance);
      return sa != sb ? sa > sb : a.material < b.material;
    });
  media.beyond = media.here;
  for (Crossing* c = all.list; c < enters; c++) leave_solid(media.beyond, c->material);
  for (Crossing* c = enters; c < end; c++) enter_solid(media.beyond, c->material);
}

Surface meet(const Transport& transport, const Ray& ray, bool pass_opaque, Hit& hit, Media& media) {
  const World& world = transport.world;
  Surface surface = eval_surface(world, ray, hit);
  media.beyond = media.here;
  if (!is_solid(surface, world.material_of(hit.instance))) return surface;
  Crossings all;
  add_crossing(all, surface, hit.instance);
  if (find_coincident(world, surface, pass_opaque, hit, all)) return eval_surface(world, ray, hit);
  cross(world, all, media);
  return surface;
}

// Returns the solids that a ray from `place` leaves without having entered them, the innermost
// first.
MediumStack find_left(const Transport& transport, vec3 place, vec3 direction) {
  constexpr int most_surfaces = 256;
  MediumStack left;
  Media media;
  Ray ray;
  ray.origin = place;
  ray.direction = direction;
  for (int i = 0; i < most_surfaces; i++) {
    Hit hit = transport.world.intersect(ray);
    if (!hit.valid()) break;
    bool moves = transport.world.is_moving(hit.instance);
    Media after = media;
    Surface surface = meet(transport, ray, true, hit, after);
    if (!moves) {
      for (int k = after.here.count - media.here.count - 1; k >= 0; k--)
        if (left.count < MediumStack::most) left.material[left.count++] = after.here.material[k];
      media.here = after.beyond;
    }
    ray.origin = offset_origin(surface, direction);
  }
  return left;
}

bool is_in(const Bounds& box, vec3 place) {
  return glm::all(glm::lessThanEqual(box.low, place)) &&
         glm::all(glm::lessThanEqual(place, box.high));
}

float index_of(const Transport& transport, int material) {
  return material < 0 ? 1.0f
                      : refractive_index(transport.world.scene().materials[size_t(material)]);
}

}  // namespace

void enter_solid(MediumStack& stack, int material) {
  if (stack.count == MediumStack::most) {
    std::copy(stack.material + 1, stack.material + stack.count, stack.material);
    stack.count--;
  }
  stack.material[stack.count++] = material;
}

void leave_solid(MediumStack& stack, int material) {
  for (int i = stack.count - 1; i >= 0; i--) {
    if (stack.material[i] != material) continue;
    std::copy(stack.material + i + 1, stack.material + stack.count, stack.material + i);
    stack.count--;
    return;
  }
}

MediumStack find_media(const Transport& transport, vec3 place) {
  const SolidBounds& solids = transport.tables.solids;
  if (!is_in(solids.all, place)) return {};
  struct Asked {
    uint64_t key = 0;
    vec3 place{0};
    MediumStack found;
  };
  thread_local Asked last;
  if (last.key == solids.key && last.place == place) return last.found;
  bool maybe = std::any_of(solids.each.begin(), solids.each.end(),
                           [&](const Bounds& box) { return is_in(box, place); });
  MediumStack found;
  if (maybe) {
    const vec3 directions[] = {normalize(vec3(0.31f, 0.87f, 0.39f)),
                               normalize(vec3(-0.62f, -0.55f, 0.56f)),
                               normalize(vec3(0.48f, -0.33f, -0.81f))};
    MediumStack left[3];
    for (int i = 0; i < 3; i++) left[i] = find_left(transport, place, directions[i]);
    for (int k = left[0].count - 1; k >= 0; k--) {
      int material = left[0].material[k];
      int agreed = std::min(count_of(left[1], material), count_of(left[2], material));
      if (count_of(found, material) < agreed) enter_solid(found, material);
    }
  }
  last = {solids.key, place, found};
  return found;
}

Surface meet_surface(const Transport& transport, const Ray& ray, Hit& hit, Media& media) {
  if (!transport.tables.any_solid) return eval_surface(transport.world, ray, hit);
  return meet(transport, ray, false, hit, media);
}

float index_outside(const Transport& transport, const Media& media, const Surface& surface) {
  return index_of(transport, (surface.front ? media.here : media.beyond).innermost());
}

bool owns_boundary(const Media& media, const Surface& surface) {
  return (surface.front ? media.beyond : media.here).innermost() == surface.material;
}

Bsdf make_bsdf_in(const Transport& transport, const Media& media, const Surface& surface,
                  const Material& material, vec3 direction) {
  const DielectricAlbedo& albedo = *transport.tables.materials[size_t(surface.material)].albedo;
  bool solid = is_solid(surface, material);
  bool plain = solid ? media.here.count + media.beyond.count == 1 : media.here.count == 0;
  bool pane = !solid && surface.transmission > 0;
  if (plain || pane) return make_bsdf(surface, material, direction, albedo);
  float index = solid ? index_of(transport, (surface.front ? media.beyond : media.here).innermost())
                      : refractive_index(material);
  float outside = solid ? index_outside(transport, media, surface)
                        : index_of(transport, media.here.innermost());
  if (!solid) index = std::max(index, outside);
  float ratio = std::max(index / outside, outside / index);
  return make_bsdf(surface, material, direction, dielectric_albedo(ratio, solid), index, outside);
}

}  // namespace wellspring::light
