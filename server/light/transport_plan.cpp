// SPDX-License-Identifier: Apache-2.0
#include "light/transport_plan.h"

#include <algorithm>
#include <cmath>

namespace wellspring::light {
namespace {

constexpr const char* names[] = {
    "area lights",     "light tree", "emission pictures", "punctual lights", "environment",
    "environment map", "panes",      "refraction",        "absorption",      "dispersion",
    "spectra",         "coats",      "caustics",          "kept light",      "dynamic lights"};
static_assert(std::size(names) == transport_parts);

// Holds what the decisions are made from.
struct Census {
  std::vector<MaterialUse> use;  // one for each material
  size_t triangles = 0;          // visible, instances counted
  size_t emitting = 0;           // visible triangles that stand still and emit
  size_t lit = 0;                // triangles that light makes a difference to
  size_t still_rough = 0;        // triangles that stand still and scatter
  size_t moving = 0;
  size_t lamps = 0, dark_lamps = 0;  // punctual lights with power, and without
  bool sky = false, sky_varies = false, sun = false;
  bool any_light() const { return emitting > 0 || lamps > 0 || sky || sun; }
};

bool emits(const PunctualLight& light) {
  bool finite =
      is_finite(light.intensity) && is_finite(light.position) && is_finite(light.direction);
  bool wide = light.type != PunctualType::spot || light.outer_cone > 0;
  return finite && wide && max_component(light.intensity) > 0;
}

void count_mesh(const Scene& scene, const Mesh& mesh, size_t instances, bool moves,
                TextureRanges& ranges, Census& census) {
  size_t m = size_t(mesh.material);
  if (mesh.triangles.empty() || instances == 0 || m >= scene.materials.size()) return;
  MaterialUse use = find_material_use(scene.materials[m], mesh, ranges);
  census.use[m] = merge(census.use[m], use);
  if (!use.visible) return;
  size_t triangles = mesh.triangles.size() * instances;
  census.triangles += triangles;
  if (moves) census.moving += triangles;
  if (use.emits && !moves) census.emitting += triangles;
  if (use.receives) census.lit += triangles;
  if (use.scatters && !moves) census.still_rough += triangles;
}

Census take_census(const Scene& scene, std::span<const Mesh* const> moving) {
  Census census;
  census.use.resize(scene.materials.size());
  TextureRanges ranges(scene);
  std::vector<size_t> instances(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances)
    if (size_t(instance.mesh) < instances.size()) instances[size_t(instance.mesh)]++;
  for (size_t i = 0; i < instances.size(); i++)
    count_mesh(scene, scene.meshes[i], instances[i], false, ranges, census);
  for (const Mesh* mesh : moving) count_mesh(scene, *mesh, 1, true, ranges, census);
  for (const PunctualLight& light : scene.lights)
    (emits(light) ? census.lamps : census.dark_lamps)++;
  const Environment& sky = scene.environment;
  census.sky = max_component(sky.radiance) > 0;
  bool picture = sky.image >= 0 && size_t(sky.image) < scene.images.size() &&
                 scene.images[size_t(sky.image)].width > 0;
  if (census.sky && picture) {
    TexelRange range = ranges.image(sky.image);
    census.sky = max_component(sky.radiance * vec3(range.high)) > 0;
    census.sky_varies = census.sky && vec3(range.low) != vec3(range.high);
  }
  census.sun = max_component(sky.sun.radiance) > 0 && sky.sun.angular_radius > 0;
  return census;
}

std::string count_of(size_t n, const char* one, const char* many) {
  const std::string digits = std::to_string(n);
  std::string text;
  for (size_t i = 0; i < digits.size(); i++) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text + " " + (n == 1 ? one : many);
}

// Returns a name from a file, short and without anything a terminal would interpret.
std::string shown_name(const std::string& name) {
  constexpr size_t longest = 40;
  std::string text = name.substr(0, longest);
  while (text.size() < name.size() && !text.empty() && (text.back() & 0x80)) text.pop_back();
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return "'" + text + (text.size() < name.size() ? "...'" : "'");
}

// Returns the materials in use that `is` holds for, by name: "'glass', 'water' and 3 more".
std::string materials_where(const Scene& scene, const Census& census, bool MaterialUse::*is) {
  std::vector<std::string> found;
  for (size_t i = 0; i < census.use.size(); i++)
    if (census.use[i].*is)
      found.push_back(scene.materials[i].name.empty() ? "material " + std::to_string(i)
                                                      : shown_name(scene.materials[i].name));
  constexpr size_t shown = 3;
  std::string text;
  for (size_t i = 0; i < std::min(found.size(), shown); i++) text += (i ? ", " : "") + found[i];
  if (found.size() > shown) text += " and " + std::to_string(found.size() - shown) + " more";
  return text;
}

bool any_where(const Census& census, bool MaterialUse::*is) {
  return std::any_of(census.use.begin(), census.use.end(),
                     [&](const MaterialUse& use) { return use.*is; });
}

// Counts the materials that ask for something which they cannot show: their factors, textures or
// alpha take it away again, or they are not in use.
size_t declared_in_vain(const Scene& scene, const Census& census, bool (*declares)(const Material&),
                        bool MaterialUse::*is) {
  size_t count = 0;
  for (size_t i = 0; i < census.use.size(); i++)
    count += declares(scene.materials[i]) && !(census.use[i].*is);
  return count;
}

class Deciding {
 public:
  Deciding(const Scene& scene, const Census& census, TransportPlan& plan)
      : scene_(scene), census_(census), plan_(plan) {}

  void decide(TransportPart part, bool used, std::string yes, std::string no) {
    plan_.decisions[size_t(part)] = {used, used ? std::move(yes) : std::move(no)};
  }
  // Decides a part that some material in use asks for. `declares`: whether a material's plain
  // factors ask for it.
  void by_material(TransportPart part, bool MaterialUse::*is, const char* yes, const char* no,
                   bool (*declares)(const Material&)) {
    size_t vain = declared_in_vain(scene_, census_, declares, is);
    std::string but;
    if (vain > 0)
      but = "; " + count_of(vain, "material that asks", "materials that ask") +
            " for it cannot show it or " + (vain == 1 ? "is" : "are") + " not in use";
    decide(part, any_where(census_, is), yes + (": " + materials_where(scene_, census_, is)),
           no + but);
  }

 private:
  const Scene& scene_;
  const Census& census_;
  TransportPlan& plan_;
};

void decide_lights(const Scene& scene, const Census& c, Deciding& d) {
  using enum TransportPart;
  const std::string unlit = "no surface in use is lit by anything";
  std::string emitters = count_of(c.emitting, "emitting triangle", "emitting triangles");
  bool area = c.emitting > 0 && c.lit > 0;
  d.decide(area_lights, area, emitters + ": " + materials_where(scene, c, &MaterialUse::emits),
           c.emitting > 0 ? unlit : "no surface in use emits light");
  d.decide(light_tree, area && c.emitting > 2, "a choice among " + emitters,
           area ? "a choice of one or two triangles needs no tree" : "there are no area lights");
  d.decide(emission_texture, area && any_where(c, &MaterialUse::emission_varies),
           "emission varies over " + materials_where(scene, c, &MaterialUse::emission_varies),
           area ? "every emitter has one radiance all over" : "there are no area lights");
  std::string dark =
      c.dark_lamps ? " (" + count_of(c.dark_lamps, "light", "lights") + " without power)" : "";
  d.decide(
      punctual_lights, c.lamps > 0 && c.lit > 0,
      count_of(c.lamps, "point, spot or distant light", "point, spot and distant lights") + dark,
      c.lamps > 0 ? unlit : "the scene has none that shines" + dark);
  d.decide(environment, c.sky || c.sun,
           c.sun ? "light comes from infinity, with a sun" : "light comes from infinity",
           "nothing shines from infinity");
  d.decide(environment_importance, (c.sky_varies || c.sun) && c.lit > 0,
           c.sun ? "the sun's disc is brighter than the rest"
                 : "the sky's picture is brighter here than there",
           !c.sky && !c.sun ? "nothing shines from infinity"
           : !c.sky_varies  ? "the sky is equally bright everywhere: scattering finds it best"
                            : unlit);
}

void decide_materials(Deciding& d) {
  using enum TransportPart;
  d.by_material(panes, &MaterialUse::pane, "thin smooth glass",
                "no thin smooth glass: shadow rays only ask whether anything is in between",
                [](const Material& m) { return m.transmission > 0 && !(m.thickness > 0); });
  d.by_material(refraction, &MaterialUse::solid, "solids that transmit",
                "nothing transparent has an inside: walks keep no medium",
                [](const Material& m) { return m.transmission > 0 && m.thickness > 0; });
  d.by_material(absorption, &MaterialUse::absorbs, "tinted inside", "no solid is tinted inside",
                [](const Material& m) { return std::isfinite(m.attenuation_distance); });
  d.by_material(dispersion, &MaterialUse::disperses, "splits colours",
                "nothing splits colours: walks have no wavelength",
                [](const Material& m) { return m.dispersion > 0; });
  d.by_material(
      spectra, &MaterialUse::spectral, "known by wavelength",
      "no surface is known by wavelength: three colours are all, and a lamp's are those of "
      "its light",
      [](const Material& m) { return knows_wavelengths(m); });
  d.by_material(
      coats, &MaterialUse::coated, "clearcoat or sheen", "no clearcoat, no sheen",
      [](const Material& m) { return m.clearcoat > 0 || max_component(m.sheen_color) > 0; });
}

void decide_results(const Scene& scene, const Census& c, Deciding& d) {
  using enum TransportPart;
  bool casts = any_where(c, &MaterialUse::sharp), receives = any_where(c, &MaterialUse::scatters);
  d.decide(caustics, casts && receives && c.any_light(),
           "smooth enough to focus light: " + materials_where(scene, c, &MaterialUse::sharp),
           !c.any_light() ? "no light"
           : !casts       ? "every surface is too rough to focus light"
                          : "no rough surface to see them on");
  std::string except =
      c.moving
          ? "; " + count_of(c.moving, "moving triangle is", "moving triangles are") + " lit afresh"
          : "";
  d.decide(kept_light, c.still_rough > 0 && c.any_light(),
           "lights and " + count_of(c.still_rough, "rough triangle", "rough triangles") +
               " stand still" + except,
           !c.any_light() ? "no light"
           : c.moving > 0 ? "no rough surface stands still"
                          : "no rough surface to keep light on");
  d.decide(
      dynamic_lights, scene.dynamic_lights > 0,
      count_of(size_t(scene.dynamic_lights), "light moves or changes", "lights move or change") +
          ": found anew for each picture",
      "no light moves or changes: nothing of a picture is lit anew");
}

}  // namespace

const char* transport_part_name(TransportPart part) {
  return size_t(part) < transport_parts ? names[size_t(part)] : "";
}

TransportPlan make_transport_plan(const Scene& scene, std::span<const Mesh* const> moving) {
  Census census = take_census(scene, moving);
  TransportPlan plan;
  Deciding decide(scene, census, plan);
  decide_lights(scene, census, decide);
  decide_materials(decide);
  decide_results(scene, census, decide);
  plan.materials = std::move(census.use);
  return plan;
}

namespace {

// Returns notes on a part that techniques treat differently.
std::span<const char* const> technique_notes(TransportPart part) {
  static constexpr const char* dispersion[] = {
      "path, direct, gather: the eye's walk carries wavelengths from the first such surface on",
      "gather: light that is kept has a colour, not a wavelength",
      "instant_radiosity: photons and walks of light carry wavelengths, and so do the eye's; where "
      "both "
      "do, hues within 1/8 of the spectrum meet"};
  static constexpr const char* caustics[] = {
      "path: by rays that come upon the light; gather: in its kept light as well; direct: "
      "none",
      "instant_radiosity: photons, spread over a radius that shrinks from pass to pass"};
  static constexpr const char* kept[] = {"gather alone asks for it"};
  static constexpr const char* dynamic[] = {
      "pictures of the show: a shadow ray a pixel, and multires_splatting of what is scattered "
      "once",
      "other techniques are given them as they are at one moment"};
  if (part == TransportPart::dynamic_lights) return dynamic;
  if (part == TransportPart::dispersion) return dispersion;
  if (part == TransportPart::caustics) return caustics;
  if (part == TransportPart::kept_light) return kept;
  return {};
}

}  // namespace

std::string explain(const TransportPlan& plan) {
  size_t widest = 0;
  for (const char* name : names) widest = std::max(widest, std::string(name).size());
  std::string text;
  for (bool used : {true, false}) {
    text += used ? "used\n" : "left out\n";
    bool any = false;
    for (size_t i = 0; i < transport_parts; i++) {
      if (plan.decisions[i].used != used) continue;
      any = true;
      std::string name = transport_part_name(TransportPart(i));
      text +=
          "  " + name + std::string(widest + 2 - name.size(), ' ') + plan.decisions[i].why + "\n";
      if (!used) continue;
      for (const char* note : technique_notes(TransportPart(i)))
        text += std::string(widest + 6, ' ') + note + "\n";
    }
    if (!any) text += "  nothing\n";
  }
  return text;
}

}  // namespace wellspring::light
