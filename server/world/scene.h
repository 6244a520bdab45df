// SPDX-License-Identifier: Apache-2.0
// What exists: immutable once made, shared by every visitor and every thread. Plain data; indices,
// not pointers. Positions are relative to `origin`, so that a scene far from zero keeps its
// precision.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "world/emitter.h"
#include "world/material.h"

namespace wellspring::world {

// Indexed triangles of one material. `normals` is never empty (made from the faces if the file had
// none); uv, colors and tangents are empty or as long as positions.
struct Mesh {
  std::string name;
  std::vector<vec3> positions;
  std::vector<vec3> normals;   // unit length
  std::vector<vec4> tangents;  // w: sign of the bitangent
  std::vector<vec2> uv[2];
  std::vector<vec4> colors;  // linear, multiply base_color
  std::vector<uvec3> triangles;
  int material = 0;
};

struct Instance {
  int mesh = 0;
  mat4 to_world{1};     // relative to Scene::origin
  uint32_t object = 0;  // index into Scene::objects; the render cache never blends across objects
};

// A glTF camera or an exhibit's viewpoint.
struct Viewpoint {
  std::string name;
  dvec3 position{0};  // absolute world coordinates
  float yaw = 0;      // radians about +Y, 0 looks down -Z, positive turns left
  float pitch = 0;    // positive looks up
  float roll = 0;     // positive leans to its left, about the line of sight, after yaw and pitch
  float fov = 1.0f;   // vertical, radians
};

// Of the file's tree of nodes: what hangs together.
struct SceneNode {
  std::string name;
  int parent = -1;  // index into Scene::nodes
};

struct SceneMotion;  // world/motion/scene_motion.h

// What the animations of one of the scene's files can move.
struct PlacedMotion {
  std::shared_ptr<const SceneMotion> of;
  dmat4 to_world{1};           // absolute world coordinates of the file's
  std::vector<int> instances;  // of each mover, its place in Scene::instances; -1: taken out
};

struct Scene {
  std::string name;
  dvec3 origin{0};  // absolute world position of this scene's (0, 0, 0)
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;  // never empty: 0 is the default where a file had none
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<std::string> objects;  // names; objects[0] is "" (nothing)
  // Of objects and lights the node of the file that each comes from, as far as there is one.
  std::vector<SceneNode> nodes;
  std::vector<int> object_nodes, light_nodes;
  std::vector<PunctualLight> lights;
  std::vector<Lamp> lamps;  // what of them, and of emissive materials, can be switched
  int dynamic_lights = 0;   // that move or change over it, and are none of `lights`
  Environment environment;
  // The eye does not see the back faces of single-sided materials (glTF 2.0 section 3.9.5), but for
  // those that enclose a medium. Shadows, reflections and bounces of light do: what a wall's back
  // hides from light is dark, whoever looks.
  bool cull_back_faces = false;
  std::vector<Viewpoint> viewpoints;
  std::vector<PlacedMotion> motions;  // where they were asked for
  std::vector<std::string> warnings;  // what the file asks for that is not done, each said once
};

struct Bounds {
  vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
};
Bounds scene_bounds(const Scene& scene);
Bounds lit_bounds(const Scene& scene);      // of what is not unlit
size_t triangle_count(const Scene& scene);  // instances counted
// A light that can emit light: an emissive material in use, a punctual light or a lit environment.
bool has_light(const Scene& scene);

}  // namespace wellspring::world
