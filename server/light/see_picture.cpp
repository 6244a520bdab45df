// SPDX-License-Identifier: Apache-2.0
#include "light/see_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "light/first_surface.h"
#include "world/texture_pyramid.h"

namespace wellspring {
namespace {

// How the reflectance of a material is found.
enum class Reflectance : uint8_t {
  scaled,  // a factor times base colour
  metal,   // base colour, where it is not too dark to be kept
  base,    // base colour, metallic and roughness of each place say all
  traced,  // ask a ray
};

// Base colour with this factor is what kept_reflectance() gives of it: matt, or metal too sharp to
// keep.
Reflectance find_reflectance(const Material& m, float& factor) {
  if (m.transmission > 0 || m.anisotropy > 0) return Reflectance::traced;
  factor = 1 - m.metallic;
  bool textured = m.metallic_roughness_texture.texture >= 0;
  if (factor == 1) return Reflectance::scaled;
  if (!textured && m.metallic < 1) return Reflectance::scaled;
  if (textured) return Reflectance::base;
  bool soft = kept_reflectance(vec3(1), 1, m.roughness).soft;
  factor = soft ? 1 : 0;
  return soft ? Reflectance::metal : Reflectance::scaled;
}

// RasterSettings::see_through of what is a clear pane everywhere.
uint8_t pane_kind(const Material& m) {
  bool clear = m.transmission == 1 && m.transmission_texture.texture < 0 && m.thickness == 0 &&
               m.metallic == 0 && m.roughness == 0 && m.alpha_mode == AlphaMode::opaque && !m.unlit;
  if (!clear || m.anisotropy > 0 || m.clearcoat > 0 || m.sheen_color != vec3(0)) return 0;
  bool alike = m.base_color_texture.texture < 0 && m.specular_texture.texture < 0 &&
               m.specular_color_texture.texture < 0 && m.normal_texture.texture < 0 &&
               m.emission_texture.texture < 0;
  return alike ? 1 : 2;
}

// The last triangle of a run: neighbours mostly share it.
struct Facet {
  uint32_t instance = 0xffffffffu, triangle = 0;
  const PlacedMesh* placed = nullptr;
  const Material* material = nullptr;
  uvec3 corner{0};
  vec3 normal[3];  // world, not unit
  vec3 face{0};    // geometric, on the winding's side
  bool one_normal = false;
  float root_area = 0;         // of the face, metres
  float uv_width[2] = {0, 0};  // of each set: root of the face's area in it
};

void load_facet(const World& world, const Hit& hit, Facet& f) {
  if (f.instance == hit.instance && f.triangle == hit.triangle) return;
  f.instance = hit.instance;
  f.triangle = hit.triangle;
  f.placed = &world.placed(hit.instance);
  f.material = f.placed->material;
  const Mesh& mesh = *f.placed->mesh;
  f.corner = mesh.triangles[hit.triangle];
  float area = 0;
  f.face = eval_face(world, hit.instance, hit.triangle, &area);
  f.root_area = std::sqrt(area);
  for (int set = 0; set < 2; set++) {
    const std::vector<vec2>& uv = mesh.uv[set];
    if (uv.empty()) continue;
    vec2 a = uv[f.corner.y] - uv[f.corner.x], b = uv[f.corner.z] - uv[f.corner.x];
    f.uv_width[set] = std::sqrt(0.5f * std::abs(a.x * b.y - a.y * b.x));
  }
  for (int k = 0; k < 3; k++) {
    vec3 n = mesh.normals[f.corner[k]];
    f.normal[k] = f.placed->in_place ? n : f.placed->normal_to_world * n;
  }
  f.one_normal = f.normal[0] == f.normal[1] && f.normal[0] == f.normal[2];
}

template <class T>
T mix3(const T& a, const T& b, const T& c, vec3 w) {
  return a * w.x + b * w.y + c * w.z;
}

// Pictures with their smaller selves, of all that a scene's reflectance is made of.
struct Pictures {
  const Scene* scene = nullptr;
  std::vector<TexturePyramid> pyramids;  // of each image; empty where none is needed
};

Pictures make_pictures(const Scene& scene) {
  Pictures pictures{&scene, std::vector<TexturePyramid>(scene.images.size())};
  std::vector<uint8_t> used(scene.images.size(), 0);
  for (const Material& m : scene.materials)
    for (const TextureRef* r :
         {&m.base_color_texture, &m.metallic_roughness_texture, &m.emission_texture})
      if (r->texture >= 0 && scene.textures[size_t(r->texture)].image >= 0)
        used[size_t(scene.textures[size_t(r->texture)].image)] = 1;
  parallel_for(int(used.size()), [&](int i) {
    if (used[size_t(i)]) pictures.pyramids[size_t(i)] = make_pyramid(scene.images[size_t(i)]);
  });
  return pictures;
}

// A pixel's width in metres on the surface it sees: the root of its area there.
float pixel_width(const Facet& f, float distance, vec3 direction, float pixel_angle) {
  return distance * pixel_angle / std::sqrt(std::max(std::abs(dot(f.face, direction)), 0.02f));
}

// The same in texels of a picture.
float footprint_texels(const Pictures& pictures, const Facet& f, const TextureRef& reference,
                       float width) {
  const Scene& scene = *pictures.scene;
  const Image& image = scene.images[size_t(scene.textures[size_t(reference.texture)].image)];
  const mat3& t = reference.uv_transform;
  float texels =
      std::abs(t[0].x * t[1].y - t[0].y * t[1].x) * float(image.width) * float(image.height);
  return width * f.uv_width[reference.uv_set] * std::sqrt(texels) / std::max(f.root_area, 1e-20f);
}

vec3 read_picture(const Pictures& pictures, const Mesh& mesh, const Facet& f, vec3 weight,
                  float pixel, const TextureRef& reference) {
  const Scene& scene = *pictures.scene;
  const Texture& texture = scene.textures[size_t(reference.texture)];
  if (texture.image < 0) return vec3(1);
  const std::vector<vec2>& set = mesh.uv[reference.uv_set];
  vec2 uv = set.empty() ? vec2(0) : mix3(set[f.corner.x], set[f.corner.y], set[f.corner.z], weight);
  uv = vec2(reference.uv_transform * vec3(uv, 1));
  const Image& image = scene.images[size_t(texture.image)];
  float texels = footprint_texels(pictures, f, reference, pixel);
  return eval_pyramid(image, pictures.pyramids[size_t(texture.image)], texture, uv, texels);
}

Seen see_facet(const Pictures& pictures, const Facet& f, const Hit& hit, vec3 direction,
               float pixel_angle, bool reflectance) {
  const Mesh& mesh = *f.placed->mesh;
  const Material& m = *f.material;
  vec3 weight(1 - hit.barycentric.x - hit.barycentric.y, hit.barycentric.x, hit.barycentric.y);
  Seen seen;
  seen.distance = hit.t;
  seen.object = f.placed->object;
  bool front = dot(f.face, direction) <= 0;
  float pixel = pixel_width(f, hit.t, direction, pixel_angle);
  vec3 normal = f.one_normal ? f.normal[0] : mix3(f.normal[0], f.normal[1], f.normal[2], weight);
  float length2 = dot(normal, normal);
  normal = length2 > 1e-25f ? normal / std::sqrt(length2) : f.face;
  seen.normal = front ? normal : -normal;
  seen.scatters = !m.unlit;
  bool shines = (front || m.double_sided) && m.emission != vec3(0);
  if (!reflectance && !shines && !m.unlit) return seen;
  vec3 base = vec3(m.base_color);
  if (m.base_color_texture.texture >= 0)
    base *= read_picture(pictures, mesh, f, weight, pixel, m.base_color_texture);
  if (!mesh.colors.empty())
    base *= vec3(
        mix3(mesh.colors[f.corner.x], mesh.colors[f.corner.y], mesh.colors[f.corner.z], weight));
  float metallic = m.metallic, roughness = m.roughness;
  if (m.metallic_roughness_texture.texture >= 0 && m.metallic > 0) {
    vec3 t = read_picture(pictures, mesh, f, weight, pixel, m.metallic_roughness_texture);
    roughness *= t.y, metallic *= t.z;
  }
  if (seen.scatters) seen.albedo = kept_reflectance(base, metallic, roughness).albedo;
  if (m.unlit || shines) {
    Surface surface;  // what surface_emission() reads
    surface.front = front;
    surface.base_color = glm::max(base, vec3(0));
    surface.emission = m.emission;
    if (!(front || m.double_sided))
      surface.emission = vec3(0);
    else if (m.emission_texture.texture >= 0)
      surface.emission *= read_picture(pictures, mesh, f, weight, pixel, m.emission_texture);
    seen.glow = surface_emission(surface, m);
  }
  return seen;
}

}  // namespace

struct PictureSight::Impl {
  const World& world;
  Lights lights;
  Raster raster;
  Pictures pictures;
  std::vector<Reflectance> reflectance;  // of each material
  std::vector<float> factor;             // of those scaled
  std::vector<uint8_t> panes;            // of each material: is one everywhere
  std::vector<uint8_t> moving_object;  // by object
  Impl(const World& w, const Lights& l)
      : world(w), lights(l), raster(w), pictures(make_pictures(w.scene())) {}
};

PictureSight::PictureSight(const World& world, const Lights& lights)
    : impl_(std::make_unique<Impl>(world, lights)) {
  const Scene& scene = world.scene();
  impl_->moving_object.resize(scene.objects.size(), 0);
  for (int i = 0; i < world.instance_count(); i++) {
    uint32_t object = world.object_of(uint32_t(i));
    if (world.is_moving(uint32_t(i)) && object < scene.objects.size())
      impl_->moving_object[object] = 1;
  }
  for (size_t i = 0; i < scene.materials.size(); i++) {
    const Material& m = scene.materials[i];
    float factor = 0;
    impl_->reflectance.push_back(m.unlit ? Reflectance::base : find_reflectance(m, factor));
    impl_->factor.push_back(impl_->reflectance.back() == Reflectance::base ? 1 : factor);
    impl_->panes.push_back(pane_kind(m));
  }
}
PictureSight::~PictureSight() = default;

bool PictureSight::moves(uint32_t object) const {
  return object < impl_->moving_object.size() && impl_->moving_object[object];
}

bool PictureSight::can_see(const View& view) const {
  Transport transport{impl_->world, *impl_->lights.tables};
  return !impl_->lights.tables->any_solid || find_media(transport, view.position).innermost() < 0;
}

struct SightRun::Impl {
  const PictureSight::Impl& sight;
  const View& view;
  vec2 offset;
  float pixel_angle;
  const RasterRun* run = nullptr;
  mutable Facet facet{};
  Seen see(int i, bool reflectance = true) const;
  bool read_lanes(const TextureRef& reference, int i, int middle, Lanes (&rgb)[3]) const;
  void reflect(int begin, int end, RunReflectance& to) const;
};

// As kept_reflectance(), eight base colours at a time.
static void keep_lanes(Lanes metallic, Lanes roughness, Lanes (&rgb)[3]) {
  Lanes matt[3], metal[3];
  for (int k = 0; k < 3; k++) matt[k] = rgb[k] * (1 - metallic), metal[k] = rgb[k] * metallic;
  LaneMask diffuse = lanes_max(lanes_max(matt[0], matt[1]), matt[2]) > least_albedo;
  LaneMask soft = (roughness >= least_soft_roughness) &
                  (lanes_min(lanes_min(metal[0], metal[1]), metal[2]) > least_kept_metal);
  for (int k = 0; k < 3; k++) rgb[k] = diffuse ? matt[k] : soft ? metal[k] : all_lanes(0);
}

// Eight pixels of the facet from `i` on; false: they have to be looked up one by one.
bool SightRun::Impl::read_lanes(const TextureRef& reference, int i, int middle,
                                Lanes (&rgb)[3]) const {
  const Scene& scene = *sight.pictures.scene;
  const Texture& texture = scene.textures[size_t(reference.texture)];
  if (texture.image < 0) return true;
  const std::vector<vec2>& set = facet.placed->mesh->uv[reference.uv_set];
  if (set.empty()) return false;
  const mat3& t = reference.uv_transform;
  auto at = [&](uint32_t corner) { return vec2(t * vec3(set[corner], 1)); };
  vec2 a = at(facet.corner.x), b = at(facet.corner.y) - a, c = at(facet.corner.z) - a;
  Lanes u = load_lanes(run->u + i), v = load_lanes(run->v + i);
  vec3 direction =
      view_ray(view, float(run->x + middle) + offset.x, float(run->y) + offset.y).direction;
  float width = pixel_width(facet, run->depth[middle], direction, pixel_angle);
  size_t image = size_t(texture.image);
  return eval_pyramid(scene.images[image], sight.pictures.pyramids[image], texture,
                      a.x + b.x * u + c.x * v, a.y + b.y * u + c.y * v,
                      footprint_texels(sight.pictures, facet, reference, width), rgb);
}

// Pixels [begin, end) of a run, all of one triangle.
void SightRun::Impl::reflect(int begin, int end, RunReflectance& to) const {
  const RasterRun& r = *run;
  Hit hit;
  hit.instance = r.instance[begin];
  hit.triangle = r.triangle[begin];
  load_facet(sight.world, hit, facet);
  const Mesh& mesh = *facet.placed->mesh;
  const Material& m = *facet.material;
  size_t material = size_t(mesh.material);
  bool base_picture = m.base_color_texture.texture >= 0;
  bool metal = sight.reflectance[material] == Reflectance::metal;
  bool blended = sight.reflectance[material] == Reflectance::base && !m.unlit;
  bool quick = (metal || blended || sight.reflectance[material] == Reflectance::scaled) &&
               mesh.colors.empty();
  vec3 scale = glm::clamp(vec3(m.base_color), 0.0f, 1.0f) * sight.factor[material];
  for (int i = begin; i < end; i += lane_count) {
    Lanes rgb[3] = {all_lanes(1), all_lanes(1), all_lanes(1)}, shine[3] = {rgb[0], rgb[0], rgb[0]};
    int middle = std::min(i + lane_count / 2, end - 1);
    bool done = quick;
    if (done && base_picture && scale != vec3(0))
      done = read_lanes(m.base_color_texture, i, middle, rgb);
    if (done && blended && m.metallic_roughness_texture.texture >= 0)
      done = read_lanes(m.metallic_roughness_texture, i, middle, shine);
    if (!done) {
      for (int k = i; k < std::min(i + lane_count, end); k++) {
        vec3 albedo = see(k).albedo;
        to.red[k] = albedo.x, to.green[k] = albedo.y, to.blue[k] = albedo.z;
      }
      continue;
    }
    for (int k = 0; k < 3; k++) rgb[k] *= scale[k];
    if (blended) keep_lanes(m.metallic * shine[2], m.roughness * shine[1], rgb);
    if (metal) {
      LaneMask kept = lanes_min(lanes_min(rgb[0], rgb[1]), rgb[2]) > least_kept_metal;
      for (Lanes& channel : rgb) channel = kept ? channel : all_lanes(0);
    }
    store_lanes(to.red + i, rgb[0]);
    store_lanes(to.green + i, rgb[1]);
    store_lanes(to.blue + i, rgb[2]);
    for (int k = i; r.veil && k < std::min(i + lane_count, end); k++) {
      vec3 tint = r.veil[k].tint;
      to.red[k] *= tint.x, to.green[k] *= tint.y, to.blue[k] *= tint.z;
    }
  }
}

void SightRun::reflect(uint64_t wanted, RunReflectance& to) const {
  const RasterRun& r = *impl_->run;
  for (int i = 0, end; i < count; i = end) {
    for (end = i + 1;
         end < count && r.triangle[end] == r.triangle[i] && r.instance[end] == r.instance[i];)
      end++;
    uint64_t these = (end - i < 64 ? (uint64_t(1) << (end - i)) - 1 : ~uint64_t(0)) << i;
    if (!(wanted & these)) continue;
    if (r.instance[i] != RasterRun::nothing) {
      impl_->reflect(i, end, to);
    } else {
      std::fill(to.red + i, to.red + end, 0.0f);
      std::fill(to.green + i, to.green + end, 0.0f), std::fill(to.blue + i, to.blue + end, 0.0f);
    }
  }
}

Seen SightRun::see(int i, bool reflectance) const { return impl_->see(i, reflectance); }

Seen SightRun::Impl::see(int i, bool reflectance) const {
  Hit hit = hit_of(*run, i, view, offset);
  Ray ray = view_ray(view, float(run->x + i) + offset.x, float(run->y) + offset.y);
  Seen seen;
  if (!hit.valid()) {
    seen.normal = -ray.direction;
    seen.distance = std::numeric_limits<float>::infinity();
    seen.glow = eval_environment(sight.lights.tables->environment, ray.direction);
  } else {
    load_facet(sight.world, hit, facet);
    if (sight.reflectance[size_t(facet.placed->mesh->material)] == Reflectance::traced) {
      wellspring::see(sight.world, sight.lights, std::span(&ray, 1), std::span(&seen, 1));
      return seen;
    }
    seen = see_facet(sight.pictures, facet, hit, ray.direction, pixel_angle, reflectance);
  }
  if (run->veil) {
    const Veil& veil = run->veil[i];
    seen.albedo *= veil.tint;
    seen.glow = seen.glow * veil.tint + veil.glow;
  }
  return seen;
}

void PictureSight::see(const View& view, vec2 offset,
                       const std::function<void(const SightRun&)>& take) const {
  const Impl& s = *impl_;
  RasterSettings settings;
  settings.offset = offset;
  settings.see_through = s.panes;
  settings.veil = [&](const Hit& hit, vec3 direction) {
    Ray ray;
    ray.origin = view.position;
    ray.direction = direction;
    Surface pane = eval_surface(s.world, ray, hit);
    return Veil{pane_transmittance(pane, s.world.material_of(hit.instance), direction),
                pane.emission};
  };
  float slope = 2 * view.tan_half_fov / float(view.height);
  impl_->raster.draw(view, settings, [&](const RasterRun& raster_run) {
    uint32_t object[RasterRun::most], last = RasterRun::nothing;
    for (int i = 0; i < raster_run.count; i++) {
      uint32_t instance = raster_run.instance[i];
      if (instance == RasterRun::nothing)
        object[i] = 0;
      else
        object[i] = i > 0 && instance == last ? object[i - 1] : s.world.object_of(instance);
      last = instance;
    }
    SightRun::Impl run_impl{s, view, offset, slope};
    run_impl.run = &raster_run;
    SightRun run;
    run.x = raster_run.x, run.y = raster_run.y, run.count = raster_run.count;
    run.depth = raster_run.depth, run.object = object;
    run.impl_ = &run_impl;
    take(run);
  });
}

}  // namespace wellspring
