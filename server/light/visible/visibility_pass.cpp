// SPDX-License-Identifier: Apache-2.0
#include "light/visible/visibility_impl.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "light/sample/medium.h"
#include "light/walk/first_surface.h"

namespace wellspring::light {
VisibilityPass::VisibilityPass(const World& world, const Lights& lights)
    : impl_(std::make_unique<Impl>(world, lights)) {
  const Scene& scene = world.scene();
  impl_->moving_object.resize(scene.objects.size(), 0);
  for (int i = 0; i < world.instance_count(); i++) {
    uint32_t object = world.object_of(uint32_t(i));
    if (world.is_moving(uint32_t(i)) && object < scene.objects.size())
      impl_->moving_object[object] = 1;
  }
  TextureRanges ranges(scene);
  for (size_t i = 0; i < scene.materials.size(); i++) {
    const Material& m = scene.materials[i];
    DemodulationScale scale;
    impl_->polished.push_back(may_be_polished(m, ranges));
    impl_->reflectance.push_back(m.unlit ? Reflectance::base
                                         : find_reflectance(m, impl_->metal_of(int(i)), scale));
    impl_->scale.push_back(scale);
    impl_->panes.push_back(pane_kind(m));
    impl_->glossy.push_back(may_gloss(m, ranges));
    impl_->plain.push_back(is_plain(m, ranges));
  }
  for (const Image& image : scene.images)
    if (image.large) impl_->pieces = image.large->store;
  for (const Mesh& mesh : scene.meshes)
    if (mesh.material >= 0) impl_->any_gloss |= impl_->glossy[size_t(mesh.material)] != 0;
}
VisibilityPass::~VisibilityPass() = default;

bool VisibilityPass::any_gloss() const { return impl_->any_gloss; }

bool VisibilityPass::moves(uint32_t object) const {
  return object < impl_->moving_object.size() && impl_->moving_object[object];
}

bool VisibilityPass::rasterises(const View& view) const {
  Transport transport{impl_->world, *impl_->lights.tables};
  return !impl_->lights.tables->any_solid || find_media(transport, view.position).innermost() < 0;
}

vec3 VisibleRun::Impl::read_large(const Facet& f, int i) const {
  const TextureRef& reference = f.material->base_color_texture;
  const Scene& scene = *visibility.pictures.scene;
  const Texture& texture = scene.textures[size_t(reference.texture)];
  if (texture_instance != f.instance || texture_triangle != f.triangle) {
    to_texture = PixelToTexture(
        make_pictured_triangle(*f.placed, f.triangle, reference, view.position), view);
    texture_instance = f.instance, texture_triangle = f.triangle;
  }
  if (!sampler) sampler.emplace(*visibility.pieces);
  const PictureFootprint footprint =
      to_texture.at(double(run->x + i) + double(offset.x), double(run->y) + double(offset.y),
                    double(blurred_angle / pixel_angle), texture);
  return sampler->look(*f.placed->picture, footprint);
}

// Does demodulated_albedo() for eight base colours at a time.
static void keep_lanes(MetalDemodulation metal, Lanes metallic, Lanes (&rgb)[3]) {
  if (metal == MetalDemodulation::none) {
    LaneMask diffuse = lanes_max(lanes_max(rgb[0], rgb[1]), rgb[2]) * (1 - metallic) > least_albedo;
    for (Lanes& channel : rgb) channel = diffuse ? channel * (1 - metallic) : all_lanes(0);
  } else {
    for (Lanes& channel : rgb) channel = lanes_max(channel, least_demodulated_metal * metallic);
  }
}

// Reads eight pixels from `i` on, those before `end`; returns false if they have to be looked up
// one by one.
bool VisibleRun::Impl::read_lanes(const PicturePlaces& places, const TextureRef& reference,
                                  float texels, int i, int end, Lanes (&rgb)[3]) const {
  constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
  const Texture& texture = visibility.pictures.scene->textures[size_t(reference.texture)];
  Lanes u = load_lanes(places.u + i), v = load_lanes(places.v + i);
  // Lanes beyond the last pixel read its place, which costs nothing.
  LaneMask here = lane < float(end - i);
  u = here ? u : all_lanes(places.u[end - 1]), v = here ? v : all_lanes(places.v[end - 1]);
  size_t image = size_t(texture.image);
  return eval_pyramid(visibility.pictures.scene->images[image], visibility.pictures.pyramids[image],
                      texture, u, v, texels, rgb);
}

void VisibleRun::Impl::describe_normals(const Facet& f, int begin, int end, RunSurface& to) const {
  float side = f.front ? 1.0f : -1.0f;
  vec3 a = f.normal[0] * side;
  if (f.one_normal && dot(a, a) > 1e-25f) {
    for (int i = begin; i < end; i += lane_count) {
      store_lanes(to.nx + i, all_lanes(a.x));
      store_lanes(to.ny + i, all_lanes(a.y));
      store_lanes(to.nz + i, all_lanes(a.z));
    }
    return;
  }
  vec3 b = f.normal[1] * side - a, c = f.normal[2] * side - a, face = f.face * side;
  for (int i = begin; i < end; i += lane_count) {
    Lanes u = load_lanes(run->u + i), v = load_lanes(run->v + i);
    Lanes x = a.x + b.x * u + c.x * v, y = a.y + b.y * u + c.y * v, z = a.z + b.z * u + c.z * v;
    LaneMask some = x * x + y * y + z * z > 1e-25f;
    store_lanes(to.nx + i, some ? x : all_lanes(face.x));
    store_lanes(to.ny + i, some ? y : all_lanes(face.y));
    store_lanes(to.nz + i, some ? z : all_lanes(face.z));
  }
}

// Makes pixels [begin, end) of a run, all of one triangle, stretches or parts of stretches. Returns
// false if each has to be seen by itself.
bool VisibleRun::Impl::place(const Facet& f, int begin, int end, Stretches& to) const {
  const Material& m = *f.material;
  int index = f.placed->mesh->material;
  if (m.unlit || visibility.reflectance[size_t(index)] == Reflectance::traced || emits(f))
    return false;
  bool base = reads_base(m, index), shine = reads_emission(m, index);
  bool alone =
      !f.placed->mesh->colors.empty() || (base && !f.base.known) || (shine && !f.shine.known);
  for (int i = begin; i < end; i += lane_count) {
    Stretch s{i, std::min(i + lane_count, end), &m, index, 0, 0, alone};
    if (!alone && (base || shine)) {
      Lanes a = load_lanes(run->u + i), b = load_lanes(run->v + i);
      int middle = std::min(i + lane_count / 2, end - 1);
      float width = pixel_width(f, distance(middle), blurred_angle);
      if (base) to.base.put(f.base, a, b, i), s.base_texels = width * f.base.texels;
      if (shine) to.shine.put(f.shine, a, b, i), s.emission_texels = width * f.shine.texels;
    }
    to.add(s);
  }
  return true;
}

void VisibleRun::Impl::describe(const Stretches& stretches, const Stretch& s,
                                RunSurface& to) const {
  const Material& m = *s.material;
  Reflectance way = visibility.reflectance[size_t(s.index)];
  bool blended = way == Reflectance::base;
  float floor = visibility.scale[size_t(s.index)].floor;
  vec3 scale = scale_of(m, s.index);
  bool reads = reads_base(m, s.index), reads_too = reads_emission(m, s.index);
  for (int i = s.begin; i < s.end; i += lane_count) {
    Lanes rgb[3] = {all_lanes(1), all_lanes(1), all_lanes(1)}, shine[3] = {rgb[0], rgb[0], rgb[0]};
    bool done = !s.alone;
    if (done && reads && m.large_picture) {
      for (int k = i; k < std::min(i + lane_count, s.end); k++) {
        const vec3 texel = read_large(facet(k), k);
        for (int c = 0; c < 3; c++) rgb[c][k - i] = texel[c];
      }
    } else if (done && reads)
      done = read_lanes(stretches.base, m.base_color_texture, s.base_texels, i, s.end, rgb);
    if (done && reads_too)
      done = read_lanes(stretches.shine, m.metallic_roughness_texture, s.emission_texels, i, s.end,
                        shine);
    int last = std::min(i + lane_count, s.end);
    if (!done) {
      for (int k = i; k < last; k++) {
        vec3 albedo = see(k).albedo;
        to.red[k] = albedo.x, to.green[k] = albedo.y, to.blue[k] = albedo.z;
      }
      continue;
    }
    for (int k = 0; k < 3; k++) rgb[k] = lanes_max(rgb[k] * scale[k], all_lanes(floor));
    if (blended) keep_lanes(visibility.metal_of(s.index), m.metallic * shine[2], rgb);
    store_lanes(to.red + i, rgb[0]);
    store_lanes(to.green + i, rgb[1]);
    store_lanes(to.blue + i, rgb[2]);
    for (int k = i; run->veil && k < last; k++) {
      vec3 tint = run->veil[k].tint;
      to.red[k] *= tint.x, to.green[k] *= tint.y, to.blue[k] *= tint.z;
    }
  }
}

uint64_t VisibleRun::describe(uint64_t wanted, RunSurface& to) const {
  if (seen_) return wanted;
  const RasterRun& r = *impl_->run;
  uint64_t alone = 0;
  Stretches stretches;
  for (int p = 0, begin = 0; p < r.pieces; begin = r.end[p++]) {
    int end = r.end[p];
    uint64_t these = (end - begin < 64 ? (uint64_t(1) << (end - begin)) - 1 : ~uint64_t(0))
                     << begin;
    if (!(wanted & these)) continue;
    const Facet* f = r.instance[begin] == RasterRun::nothing ? nullptr : &impl_->facet(begin);
    if (f && impl_->place(*f, begin, end, stretches)) impl_->describe_normals(*f, begin, end, to);
    else alone |= these;
  }
  for (int k = 0; k < stretches.count; k++) impl_->describe(stretches, stretches.of[k], to);
  for (int i = 0; r.veil && i < count; i++)
    if (r.veil[i].glow != vec3(0)) alone |= uint64_t(1) << i;
  return alone & wanted;
}

uint64_t VisibleRun::polished() const {
  if (seen_) return ~uint64_t(0) >> (64 - count);
  const RasterRun& r = *impl_->run;
  uint64_t found = 0;
  for (int p = 0, begin = 0; p < r.pieces; begin = r.end[p++]) {
    if (r.instance[begin] == RasterRun::nothing) continue;
    int material = impl_->facet(begin).placed->mesh->material;
    if (!impl_->visibility.polished[size_t(material)]) continue;
    for (int i = begin; i < r.end[p]; i++) found |= uint64_t(1) << i;
  }
  return found;
}

void VisibleRun::gloss(uint32_t* codes, uint8_t* metallic) const {
  std::fill_n(codes, count, 0u), std::fill_n(metallic, count, uint8_t(0));
  if (seen_) return;
  const RasterRun& r = *impl_->run;
  for (int p = 0, begin = 0; p < r.pieces; begin = r.end[p++]) {
    if (r.instance[begin] == RasterRun::nothing) continue;
    Facet& f = impl_->facet(begin);
    if (!impl_->visibility.glossy[size_t(f.placed->mesh->material)]) continue;
    place_shine(impl_->visibility.world, f);
    for (int i = begin; i < r.end[p]; i++) {
      const float width = pixel_width(f, impl_->distance(i), impl_->blurred_angle);
      Gloss gloss = see_gloss(impl_->visibility.pictures, f, {r.u[i], r.v[i]}, width);
      if (r.veil) gloss.f0 *= r.veil[i].tint;
      const GlossCode packed = pack_gloss(gloss);
      codes[i] = packed.code, metallic[i] = packed.metallic;
    }
  }
}

PrimaryHit VisibleRun::see(int i) const { return seen_ ? seen_[i] : impl_->see(i); }

PrimaryHit VisibleRun::Impl::see(int i) const {
  Hit hit = hit_of(*run, i, view, offset);
  Ray ray = view_ray(view, float(run->x + i) + offset.x, float(run->y) + offset.y);
  PrimaryHit seen;
  if (!hit.valid()) {
    seen.normal = -ray.direction;
    seen.distance = std::numeric_limits<float>::infinity();
    seen.glow = eval_environment(visibility.lights.tables->environment, ray.direction);
  } else {
    const Facet& f = facet(i);
    if (visibility.reflectance[size_t(f.placed->mesh->material)] == Reflectance::traced) {
      wellspring::light::see(visibility.world, visibility.lights, std::span(&ray, 1),
                             std::span(&seen, 1));
      return seen;
    }
    float pixel = pixel_width(f, distance(i), blurred_angle);
    vec3 texel(0);
    const bool large = f.material->large_picture;
    if (large) texel = read_large(f, i);
    seen = see_facet(visibility.pictures, visibility.world, f,
                     visibility.metal_of(f.placed->mesh->material), hit, pixel,
                     large ? &texel : nullptr);
  }
  if (run->veil) {
    const Veil& veil = run->veil[i];
    seen.albedo *= veil.tint;
    seen.glow = seen.glow * veil.tint + veil.glow;
  }
  return seen;
}

bool VisibilityPass::anything_moves() const {
  const World& world = impl_->world;
  for (int i = 0; i < world.instance_count(); i++)
    if (world.is_moving(uint32_t(i)) && world.is_visible(uint32_t(i))) return true;
  return false;
}

Bounds VisibilityPass::moving_bounds() const { return impl_->world.moving_bounds(); }

void VisibilityPass::see(const View& view, vec2 offset,
                         const std::function<void(const VisibleRun&)>& take, RasterShows shows,
                         float blur) const {
  RasterSettings settings;
  settings.shows = shows;
  settings.offset = offset;
  draw(view, settings, blur, take);
}

std::span<const std::vector<EdgeShare>> VisibilityPass::see_edges(
    const View& view, vec2 offset, const std::function<void(const VisibleRun&)>& take,
    RasterShows shows, PixelsDiffer differ) const {
  RasterSettings settings;
  settings.shows = shows;
  settings.offset = offset;
  settings.edges = true;
  settings.differ = std::move(differ);
  if (!draw(view, settings, 1, take)) return {};
  return impl_->raster.edges();
}

// Casts rays row by row, 64 pixels at a time.
void VisibilityPass::cast(const View& view, vec2 offset, uint64_t picture,
                          const std::function<void(const VisibleRun&)>& take) const {
  constexpr int most = RasterRun::most;
  parallel_for(view.height, [&](int y) {
    for (int x = 0; x < view.width; x += most) {
      VisibleRun run;
      run.picture = picture;
      run.x = x, run.y = y, run.count = std::min(most, view.width - x);
      Ray rays[most];
      PrimaryHit seen[most];
      float depth[most + 8];
      uint32_t object[most + 8];
      for (int i = 0; i < run.count; i++)
        rays[i] = view_ray(view, float(x + i) + offset.x, float(y) + offset.y);
      wellspring::light::see(impl_->world, impl_->lights, std::span(rays, size_t(run.count)),
                             std::span(seen, size_t(run.count)));
      for (int i = 0; i < run.count; i++) {
        object[i] = seen[i].object;
        depth[i] = seen[i].distance * dot(rays[i].direction, view.forward);
      }
      run.depth = depth, run.object = object, run.seen_ = seen;
      take(run);
    }
  });
}

// Draws the view. Returns whether it was rasterised, so that edges may be asked for.
bool VisibilityPass::draw(const View& view, RasterSettings settings, float blur,
                          const std::function<void(const VisibleRun&)>& take) const {
  static std::atomic<uint64_t> pictures = 0;
  const uint64_t picture = ++pictures;
  if (!rasterises(view)) {
    if (settings.shows != RasterShows::moving) cast(view, settings.offset, picture, take);
    return false;
  }
  const Impl& s = *impl_;
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
    thread_local FacetCache facets;
    facets.start(picture);
    uint32_t object[RasterRun::most + 8];
    for (int p = 0, begin = 0; p < raster_run.pieces; begin = raster_run.end[p++]) {
      uint32_t instance = raster_run.instance[begin];
      uint32_t shown = instance == RasterRun::nothing ? 0 : s.world.object_of(instance);
      std::fill(object + begin, object + raster_run.end[p], shown);
    }
    VisibleRun::Impl run_impl{.visibility = s,
                              .view = view,
                              .offset = settings.offset,
                              .pixel_angle = slope,
                              .blurred_angle = blur * slope,
                              .facets = facets,
                              .run = &raster_run};
    VisibleRun run;
    run.picture = picture;
    run.x = raster_run.x, run.y = raster_run.y, run.count = raster_run.count;
    run.depth = raster_run.depth, run.object = object;
    run.impl_ = &run_impl;
    take(run);
  });
  return true;
}

}  // namespace wellspring::light
