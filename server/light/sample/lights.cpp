// SPDX-License-Identifier: Apache-2.0
#include "light/sample/lights.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/memory.h"
#include "light/sample/caustic_casters.h"
#include "light/sample/emission.h"
#include "light/sample/light_tables.h"
#include "light/sample/medium.h"
#include "light/sample/pane_boxes.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

// Returns the mean emission over a triangle by a fixed pattern of look-ups, more for a finer
// texture.
vec3 mean_emission(const World& world, const EmitterTriangle& e, int look_ups) {
  vec3 sum{0};
  Ray ray;
  ray.origin = e.corner + e.normal;
  ray.direction = -e.normal;
  for (int i = 0; i < look_ups; i++) {
    // Points of a rank-1 lattice (Korobov; the plastic number), folded into the triangle.
    float a = std::fmod(0.5f + float(i) * 0.7548776662f, 1.0f),
          b = std::fmod(0.5f + float(i) * 0.5698402910f, 1.0f);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    Hit hit;
    hit.t = 1;
    hit.instance = e.instance;
    hit.triangle = e.triangle;
    hit.barycentric = {a, b};
    Surface s = eval_surface(world, ray, hit);
    sum += surface_emission(s, world.material_of(e.instance)) * s.alpha;
  }
  return sum / float(look_ups);
}

// Returns the number of texels of the emission's picture that a triangle covers.
float texels_covered(const Scene& scene, const Mesh& mesh, const TextureRef& reference,
                     uvec3 corner) {
  if (reference.texture < 0 || mesh.uv[reference.uv_set].empty()) return 1;
  int index = scene.textures[size_t(reference.texture)].image;
  if (index < 0) return 1;
  const Image& image = scene.images[size_t(index)];
  const auto& uv = mesh.uv[reference.uv_set];
  auto texel = [&](uint32_t v) {
    return vec2(reference.uv_transform * vec3(uv[v], 1)) *
           vec2(float(image.width), float(image.height));
  };
  vec2 a = texel(corner.y) - texel(corner.x), b = texel(corner.z) - texel(corner.x);
  return 0.5f * std::abs(a.x * b.y - a.y * b.x);
}

// Adds an instance's triangles with the emission of a uniform emitter, or an estimate of its mean.
void gather_instance(const World& world, uint32_t instance, LightTables& tables,
                     std::vector<float>& power) {
  const Mesh& mesh = world.mesh_of(instance);
  const Material& material = world.material_of(instance);
  tables.first_emitter[instance] = uint32_t(tables.emitters.size());
  bool uniform = !tables.plan.uses(TransportPart::emission_texture) ||
                 !tables.plan.materials[size_t(mesh.material)].emission_varies;
  const TextureRef& picture =
      material.unlit ? material.base_color_texture : material.emission_texture;
  // The budget bounds the work for big pictures on big meshes.
  float budget = 4e6f / float(std::max<size_t>(mesh.triangles.size(), 1));
  for (uint32_t t = 0; t < mesh.triangles.size(); t++) {
    EmitterTriangle e;
    e.instance = instance;
    e.triangle = t;
    e.corner = eval_position(world, instance, t, {0, 0});
    e.edge1 = eval_position(world, instance, t, {1, 0}) - e.corner;
    e.edge2 = eval_position(world, instance, t, {0, 1}) - e.corner;
    e.normal = eval_face(world, instance, t, &e.area);
    e.extent = max_component(glm::max(
        glm::abs(e.corner), glm::max(glm::abs(e.corner + e.edge1), glm::abs(e.corner + e.edge2))));
    if (world.any_apart()) {
      Face face = make_face(world.placed(instance), t);
      e.edge1 = face.edge1, e.edge2 = face.edge2, e.extent = face.extent;
    }
    e.uniform = uniform;
    e.double_sided = material.double_sided || material.unlit;
    vec3 mean{0};
    if (std::isfinite(e.area) && e.area > 0) {
      float look_ups =
          uniform
              ? 1
              : std::min(texels_covered(world.scene(), mesh, picture, mesh.triangles[t]), budget);
      mean = mean_emission(world, e, int(std::clamp(look_ups, uniform ? 1.0f : 4.0f, 256.0f)));
      e.emission = uniform ? mean : vec3(0);
      if (!uniform) add_emission_picture(world, look_ups, e, tables);
    }
    power.push_back(luminance(mean) * e.area * pi * (e.double_sided ? 2 : 1));
    tables.emitters.push_back(e);
  }
}

float power_of(const PunctualLight& light, float scene_radius) {
  float strength = luminance(light.intensity);
  switch (light.type) {
    case PunctualType::point: return strength * 4 * pi;
    case PunctualType::spot: return strength * 2 * pi * (1 - std::cos(light.outer_cone));
    case PunctualType::directional: return strength * pi * scene_radius * scene_radius;
  }
  return 0;
}

// Returns the share of the first of two kinds of light; neither is starved, since power says little
// about one place.
float share_of(double first, double second) {
  if (!(first > 0)) return 0;
  if (!(second > 0)) return 1;
  return float(std::clamp(first / (first + second), 0.25, 0.75));
}

}  // namespace

vec3 surface_emission(const Surface& surface, const Material& material) {
  return material.unlit ? surface.base_color : surface.emission;
}

TransportPlan make_plan(const World& world) {
  std::vector<const Mesh*> moving;
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++)
    if (world.is_moving(i)) moving.push_back(&world.mesh_of(i));
  return make_transport_plan(world.scene(), moving);
}

namespace {

// Returns how much brighter a factor makes a light; exactly itself if it is grey.
float brightness_of(vec3 factor) { return factor == vec3(factor.x) ? factor.x : luminance(factor); }

// Makes the choices among all sources that emit light, each with its probability.
void choose_sources(const Scene& scene, const EmittingSources& emitting,
                    std::span<const PunctualLight> more, LightTables& tables) {
  using enum TransportPart;
  const TransportPlan& plan = tables.plan;
  tables.emitter_choice =
      make_emitter_tree(tables.emitters, tables.emitter_power,
                        plan.uses(light_tree) ? LightChoice::by_place : LightChoice::by_strength);
  float radius = 0.5f * length(tables.bounds.high - tables.bounds.low);
  if (!std::isfinite(radius)) radius = 1;
  const EnvironmentLight& sky = tables.environment;
  double environment_power =
      sky.cells.cells.empty() ? 0 : double(sky.mean_luminance) * pi * pi * 4 * radius * radius;
  double sun_power = double(luminance(sky.sun_radiance)) * double(sky.sun_chord2) * pi * pi *
                     double(radius) * double(radius);
  environment_power += sun_power;
  double emitter_power = tables.emitter_choice.total * double(pi);
  tables.emitter_share = share_of(emitter_power, environment_power);

  double punctual_power = 0;
  std::vector<float> punctual_powers;
  tables.punctual.clear(), tables.cones.clear(), tables.punctual_index.clear();
  uint32_t index = 0;
  auto add = [&](const PunctualLight& light, vec3 factor, int spectrum) {
    float p = power_of(light, radius);
    bool finite =
        is_finite(light.intensity) && is_finite(light.position) && is_finite(light.direction);
    if (!(p > 0) || !std::isfinite(p) || !finite) return;
    index++;
    const float brightness = brightness_of(factor);
    if (!(brightness > 0)) return;
    p *= brightness;
    tables.punctual.push_back(light);
    tables.punctual.back().intensity *= factor;
    tables.punctual.back().spectrum = spectrum;
    tables.punctual_index.push_back(index - 1);
    tables.cones.push_back(make_spot_cone(light));
    punctual_powers.push_back(p);
    punctual_power += double(p);
  };
  if (plan.uses(punctual_lights)) {
    for (size_t i = 0; i < scene.lights.size(); i++)
      add(scene.lights[i], emitting.lights[i], emitting.light_spectra[i]);
    for (const PunctualLight& light : more) add(light, vec3(1), light.spectrum);
  }
  float sky_power =
      luminance(sky.radiance) > 0 ? sky.mean_luminance * 4 * pi * pi * radius * radius : 0.0f;
  tables.emission = make_emission_choice(tables, tables.emitter_power, punctual_powers,
                                         sky_power + float(sun_power), tables.bounds);
  tables.area_share = share_of(emitter_power + environment_power, punctual_power);
  add_punctual_choice(tables);
}

}  // namespace

Lights make_lights(const World& world, std::span<const PunctualLight> more) {
  TransportPlan plan = make_plan(world);
  if (!more.empty())
    plan.decisions[size_t(TransportPart::punctual_lights)] = {true, "lights beside the scene's"};
  return make_lights(world, plan, more);
}

Lights make_lights(const World& world, const TransportPlan& plan,
                   std::span<const PunctualLight> more) {
  using enum TransportPart;
  const Scene& scene = world.scene();
  auto tables = std::make_shared<LightTables>();
  tables->plan = plan;
  tables->first_emitter.assign(size_t(world.instance_count()), no_emitter);
  if (plan.uses(area_lights))
    for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++)
      if (!world.is_moving(i) && plan.materials[size_t(world.mesh_of(i).material)].emits)
        gather_instance(world, i, *tables, tables->emitter_power);
  tables->bounds = scene_bounds(scene);
  tables->lit_bounds = lit_bounds(scene);
  if (plan.uses(TransportPart::environment))
    tables->environment = make_environment_light(scene, plan.uses(environment_importance));
  choose_sources(scene, find_emitting(world), more, *tables);

  for (size_t i = 0; i < scene.materials.size(); i++) {
    const Material& m = scene.materials[i];
    const DielectricAlbedo* albedo =
        plan.materials[i].visible ? &dielectric_albedo(m.ior, m.transmission > 0 && m.thickness > 0)
                                  : nullptr;
    tables->materials.push_back(
        {albedo, plan.materials[i].pane, is_lambertian(m), plan.materials[i].metal});
    tables->any_lambertian |= plan.materials[i].visible && is_lambertian(m);
  }
  if (plan.uses(TransportPart::spectra) || plan.uses(dispersion))
    tables->spectral =
        scene.spectra.empty() ? plain_spectral_tables() : make_spectral_tables(scene);
  tables->casters = find_casters(world, plan, false);
  tables->any_pane = plan.uses(panes);
  if (tables->any_pane) tables->pane_boxes = make_pane_boxes(world, tables->materials);
  tables->any_solid = plan.uses(refraction);
  tables->any_tint = plan.uses(absorption);
  if (tables->any_solid) tables->solids = find_solid_bounds(world, plan);
  return {tables, std::make_shared<std::atomic<uint64_t>>(0), nullptr};
}

std::shared_ptr<const LightTables> relit(const LightTables& all, const Scene& scene,
                                         const EmittingSources& emitting) {
  auto tables = std::make_shared<LightTables>(all);
  for (size_t i = 0; i < tables->emitters.size(); i++) {
    EmitterTriangle& e = tables->emitters[i];
    const Mesh& mesh = scene.meshes[size_t(scene.instances[e.instance].mesh)];
    const vec3 factor = emitting.materials[size_t(mesh.material)];
    e.emission *= factor;
    tables->emitter_power[i] *= brightness_of(factor);
  }
  if (!emitting.sky) tables->environment = {};
  choose_sources(scene, emitting, {}, *tables);
  return tables;
}

std::vector<std::shared_ptr<const LightTables>> make_lamp_tables(const LightTables& all,
                                                                 const Scene& scene) {
  std::vector<std::shared_ptr<const LightTables>> tables;
  for (int lamp = -1; lamp < int(scene.lamps.size()); lamp++)
    tables.push_back(relit(all, scene, find_emitting_of(scene, lamp)));
  return tables;
}

std::vector<uint8_t> find_lamp_parts(const Scene& scene) {
  std::vector<uint8_t> parts(scene.materials.size(), 0);
  for (size_t lamp = 0; lamp < scene.lamps.size(); lamp++)
    for (int material : scene.lamps[lamp].materials) parts[size_t(material)] = uint8_t(lamp + 1);
  return parts;
}

namespace {

constexpr size_t most_picture_cells = size_t(1) << 20;  // cells of all emitters together

LightBounds bounds_of(const PunctualLight& light) {
  LightBounds b;
  b.low = b.high = light.position;
  b.strength = luminance(light.intensity);
  b.cos_spread = -1;
  if (light.type == PunctualType::spot) {
    b.axis = light.direction;
    b.cos_spread = std::cos(light.inner_cone);
    b.cos_reach = std::cos(std::max(light.outer_cone - light.inner_cone, 0.0f) + 1e-3f);
  }
  if (std::isfinite(light.range) && light.range > 0) b.range = light.range;
  return b;
}

}  // namespace

LightTree make_emitter_tree(std::span<const EmitterTriangle> emitters, std::span<const float> power,
                            LightChoice choice) {
  std::vector<LightBounds> bounds;
  bounds.reserve(emitters.size());
  for (size_t i = 0; i < emitters.size(); i++) {
    const EmitterTriangle& e = emitters[i];
    LightBounds b;
    vec3 second = e.corner + e.edge1, third = e.corner + e.edge2;
    b.low = glm::min(e.corner, glm::min(second, third));
    b.high = glm::max(e.corner, glm::max(second, third));
    b.axis = e.normal;
    b.two_sided = e.double_sided;
    b.strength = power[i] / (pi * (e.double_sided ? 2.0f : 1.0f));
    bounds.push_back(b);
  }
  return make_light_tree(bounds, choice);
}

void add_punctual_choice(LightTables& tables) {
  tables.few_punctual = {}, tables.near_choice = {}, tables.distant_choice = {};
  if (tables.punctual.size() <= size_t(FewLights::most)) {
    tables.few_punctual = make_few_lights(tables.punctual, tables.cones);
    return;
  }
  std::vector<LightBounds> near, distant;
  for (const PunctualLight& light : tables.punctual) {
    LightBounds b = bounds_of(light), dark;
    bool is_distant = light.type == PunctualType::directional;
    near.push_back(is_distant ? dark : b);
    distant.push_back(is_distant ? b : dark);
  }
  tables.near_choice = make_light_tree(near, LightChoice::by_place);
  tables.distant_choice = make_light_tree(distant, LightChoice::by_strength);
}

void add_emission_picture(const World& world, float texels, EmitterTriangle& emitter,
                          LightTables& tables) {
  if (tables.picture_cells >= most_picture_cells) return;
  const Material& material = world.material_of(emitter.instance);
  Ray ray;
  ray.origin = emitter.corner + emitter.normal;
  ray.direction = -emitter.normal;
  Hit hit;
  hit.t = 1;
  hit.instance = emitter.instance;
  hit.triangle = emitter.triangle;
  EmissionPicture picture = make_emission_picture(texels, [&](vec2 barycentric) {
    hit.barycentric = barycentric;
    Surface surface = eval_surface(world, ray, hit);
    return luminance(surface_emission(surface, material)) * surface.alpha;
  });
  if (picture.cells.cells.empty()) return;
  tables.picture_cells += picture.cells.cells.size();
  emitter.picture = int(tables.pictures.size());
  tables.pictures.push_back(std::move(picture));
}

namespace {

// `level`: how a lamp shines.
EmittingSources emitting(const Scene& scene, float others,
                         const std::function<LampLevel(size_t lamp)>& level) {
  EmittingSources emitting{std::vector<vec3>(scene.materials.size(), vec3(others)),
                           std::vector<vec3>(scene.lights.size(), vec3(others)),
                           {},
                           others > 0};
  for (const PunctualLight& light : scene.lights) emitting.light_spectra.push_back(light.spectrum);
  for (size_t i = 0; i < scene.lamps.size(); i++) {
    const Lamp& lamp = scene.lamps[i];
    const LampLevel set = level(i);
    const LampLight* dial = dialed(lamp, set);
    for (int material : lamp.materials) emitting.materials[size_t(material)] = factor_of(lamp, set);
    for (int light : lamp.lights) {
      emitting.lights[size_t(light)] = factor_of(lamp, set);
      if (dial && dial->spectrum >= 0) emitting.light_spectra[size_t(light)] = dial->spectrum;
    }
  }
  return emitting;
}

}  // namespace

EmittingSources find_emitting(const World& world) {
  const LampLevels& levels = world.lamp_levels();
  return emitting(world.scene(), 1, [&](size_t lamp) { return levels[lamp]; });
}

EmittingSources find_emitting_of(const Scene& scene, int lamp) {
  return emitting(scene, lamp < 0 ? 1 : 0,
                  [&](size_t other) { return LampLevel(int(other) == lamp ? lamp_full : 0); });
}

}  // namespace wellspring::light
