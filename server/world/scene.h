// SPDX-License-Identifier: Apache-2.0
// Describes all that exists in a scene: immutable once made, shared by every visitor and every
// thread. Plain data; indices, not pointers. Positions are relative to `origin`, so that a scene
// far from zero keeps its precision.
#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/vec.h"
#include "spectrum/spectrum.h"
#include "world/texture.h"

namespace wellspring::world {

// Names what a scene knows of light by wavelength, as indices into Scene::spectra; -1: nothing, and
// red, green and blue are all there is.
struct MaterialSpectra {
  int reflectance = -1;  // its colour is in the base colour's factor
  int index = -1;        // index of refraction
  int absorption = -1;   // per metre of the solid
  int emission = -1;     // relative power
  // The reflectance as it is in base_color: under D65, in linear Rec. 709, each channel above 0.
  vec3 base{1};
};

// Holds a quantity over wavelength. world/load/scene_spectra.h puts them into a scene.
struct SceneSpectrum {
  std::string name;
  Spectrum value;
};

// Defines light that is no surface: KHR_lights_punctual and the environment. Emissive surfaces are
// found by their material (light/sample/lights.h gathers them).

enum class PunctualType : uint8_t { point, spot, directional };

// Holds a punctual light. Photometric units are taken as radiometric one to one: 1 candela is 1
// W/sr, 1 lux is 1 W/m^2 per channel.
struct PunctualLight {
  std::string name;
  PunctualType type = PunctualType::point;
  vec3 position{0};          // point, spot
  vec3 direction{0, 0, -1};  // direction in which the light travels: spot, directional; unit length
  vec3 intensity{1};         // point, spot: W/sr; directional: W/m^2 on a facing surface
  float range = std::numeric_limits<float>::infinity();
  float inner_cone = 0, outer_cone = pi / 4;  // radians from the axis
  int spectrum = -1;  // relative power, index into Scene::spectra; `intensity` has its colour
};

// A lamp is what is switched together: a chandelier with all its candles, the spots of a show-case.
// Nothing belongs to two lamps. Lamps come into a scene by world/load/lamp.h.
// Holds one of the lights that a lamp can shine with.
struct LampLight {
  int spectrum = -1;  // relative power, index into Scene::spectra; -1: the lamp's own
  vec3 factor{1};     // its colour over the lamp's own; luminance stays
};
struct Lamp {
  std::string name;
  std::vector<int> lights;     // indices into Scene::lights
  std::vector<int> materials;  // indices into Scene::materials; only the lamp's surfaces have them
  std::vector<LampLight> dial{};  // other lights that it can shine with, at most most_dial_lights
};
inline constexpr size_t most_dial_lights = 16;

// Holds a disc at infinity, equally bright all over: the sun. No radiance: there is no sun.
struct SunDisc {
  vec3 direction{0, 1, 0};  // towards it, unit
  vec3 radiance{0};
  float angular_radius = 0;  // radians, at most pi / 2
};

// Holds light from infinity. No image: `radiance` from everywhere. With an image:
// latitude-longitude, +Y up, its middle column towards -Z, times `radiance`.
struct Environment {
  vec3 radiance{0};
  int image = -1;
  SunDisc sun{};  // added to the rest
};

// Describes the material of a surface: glTF 2.0 metallic-roughness (appendix B) with
// KHR_materials_transmission, ior, volume, emissive_strength, specular, clearcoat, sheen,
// anisotropy, dispersion and unlit. Factors are linear. Ambient occlusion maps are not used: a path
// tracer finds occlusion itself.

enum class AlphaMode : uint8_t { opaque, mask, blend };

struct Material {
  std::string name;
  vec4 base_color{1};
  TextureRef base_color_texture;
  float metallic = 1, roughness = 1;      // perceptual roughness; alpha = roughness^2
  TextureRef metallic_roughness_texture;  // G roughness, B metallic
  TextureRef normal_texture;
  float normal_scale = 1;
  vec3 emission{0};  // radiance: emissiveFactor * emissiveStrength
  TextureRef emission_texture;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;
  float ior = 1.5f;
  float transmission = 0;
  TextureRef transmission_texture;  // R
  float thickness = 0;              // 0: thin-walled
  TextureRef thickness_texture;     // G
  vec3 attenuation_color{1};
  float attenuation_distance = std::numeric_limits<float>::infinity();
  float dispersion = 0;  // 20 over the Abbe number
  float specular = 1;    // strength of the dielectric reflection; 0: a perfectly Lambertian surface
  TextureRef specular_texture;  // A
  vec3 specular_color{1};       // tints it at normal incidence
  TextureRef specular_color_texture;
  float clearcoat = 0, clearcoat_roughness = 0;
  TextureRef clearcoat_texture;            // R
  TextureRef clearcoat_roughness_texture;  // G
  TextureRef clearcoat_normal_texture;     // none: the coat is smooth, whatever lies below it
  float clearcoat_normal_scale = 1;
  vec3 sheen_color{0};
  float sheen_roughness = 0;
  TextureRef sheen_color_texture;
  TextureRef sheen_roughness_texture;             // A
  float anisotropy = 0, anisotropy_rotation = 0;  // 0..1; radians from the tangent
  TextureRef anisotropy_texture;                  // RG: direction, B: strength
  MaterialSpectra spectra{};
  // World::repaint() may change its colours and how its pictures lie: no conclusions may be drawn
  // from these.
  bool repaints = false;
  bool large_picture = false;  // its base colour is of an Image with `large`
};

// Returns whether the material's surfaces enclose a medium in which light is bent and tinted: then
// they are met from both sides.
inline bool encloses_medium(const Material& m) {
  return m.transmission > 0 && m.thickness > 0 && m.metallic < 1;
}

// Holds how a material looks for a while, as what is added to it.
struct Repaint {
  vec4 base_color{0};
  vec3 emission{0};
  mat3 uv{0.0f};  // added to the matrices of all its pictures' coordinates
  bool operator==(const Repaint&) const = default;
};

// Calls body(TextureRef&) for every picture a material may have.
template <class M, class Body>
void each_texture(M& m, Body&& body) {
  for (auto* use : {&m.base_color_texture, &m.metallic_roughness_texture, &m.emission_texture,
                    &m.transmission_texture, &m.thickness_texture, &m.specular_texture,
                    &m.specular_color_texture, &m.clearcoat_texture, &m.clearcoat_roughness_texture,
                    &m.sheen_color_texture, &m.sheen_roughness_texture, &m.anisotropy_texture,
                    &m.normal_texture, &m.clearcoat_normal_texture})
    body(*use);
}
// Returns `m` with these changes: colours stay within their ranges, numbers that are not finite
// change nothing.
Material repainted(const Material& m, const Repaint& change);
// Returns `m` with its own light times `factor`, of that relative power; -1: its own.
Material dimmed(const Material& m, vec3 factor, int spectrum = -1);

// Holds indexed triangles of one material. `normals` is never empty (made from the faces if the
// file had none); uv, colors and tangents are empty or as long as positions.
struct Mesh {
  std::string name;
  std::vector<vec3> positions;
  std::vector<vec3> normals;   // unit length
  std::vector<vec4> tangents;  // w: sign of the bitangent
  std::vector<vec2> uv[2];
  std::vector<vec4> colors;  // linear, multiply base_color
  std::vector<uvec3> triangles;
  int material = 0;
  // It stands for something finer that pictures lay over it (world/placed_scan.h): the eye does not
  // see it, all other rays do.
  bool stands_in = false;
};

struct Instance {
  int mesh = 0;
  mat4 to_world{1};     // relative to Scene::origin
  uint32_t object = 0;  // index into Scene::objects; the render cache never blends across objects
};

// Holds a glTF camera or an exhibit's viewpoint.
struct Viewpoint {
  std::string name;
  dvec3 position{0};  // absolute world coordinates
  float yaw = 0;      // radians about +Y, 0 looks down -Z, positive turns left
  float pitch = 0;    // positive looks up
  // Positive leans to the viewer's left, about the line of sight, after yaw and pitch.
  float roll = 0;
  float fov = 1.0f;  // vertical, radians
};

// Holds a node of the file's tree, which tells what hangs together.
struct SceneNode {
  std::string name;
  int parent = -1;  // index into Scene::nodes
};

struct SceneMotion;  // world/motion/scene_motion.h

// Places what the animations of one of the scene's files can move.
struct PlacedMotion {
  std::shared_ptr<const SceneMotion> of;
  dmat4 to_world{1};           // from the file's to absolute world coordinates
  std::vector<int> instances;  // each mover's index in Scene::instances; -1: taken out
};

struct Scene {
  std::string name;
  dvec3 origin{0};  // absolute world position of this scene's (0, 0, 0)
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;  // never empty: 0 is the default for a file without any
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<std::string> objects;  // names; objects[0] is "" (nothing)
  // The file's nodes, and the node from which each object and light comes, as far as there is one.
  std::vector<SceneNode> nodes;
  std::vector<int> object_nodes, light_nodes;
  std::vector<PunctualLight> lights;
  std::vector<SceneSpectrum> spectra;
  std::vector<Lamp> lamps;  // lights and emissive materials that can be switched
  int dynamic_lights = 0;   // number of lights that move or change, none of them in `lights`
  Environment environment;
  // The eye does not see the back faces of single-sided materials (glTF 2.0 section 3.9.5), except
  // those that enclose a medium. Shadows, reflections and bounces of light do: a place that a
  // wall's back hides from light is dark, whoever looks.
  bool cull_back_faces = false;
  std::vector<Viewpoint> viewpoints;
  std::vector<PlacedMotion> motions;  // empty unless they were asked for
  // Features that the file asks for and that are not done, each once.
  std::vector<std::string> warnings;
};

struct Bounds {
  vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
};
Bounds scene_bounds(const Scene& scene);
Bounds lit_bounds(const Scene& scene);      // bounds of all that is not unlit
size_t triangle_count(const Scene& scene);  // instances counted
// Returns whether anything emits light: an emissive material in use, a punctual light or a lit
// environment.
bool has_light(const Scene& scene);

}  // namespace wellspring::world
