// SPDX-License-Identifier: Apache-2.0
// Holds an H-Anim humanoid ready to be posed (ISO/IEC 19774-1): joints, a skin (or rigid segments,
// which are skins with one joint each), displacers, and how the surfaces look. It is plain data,
// immutable once loaded.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "avatar/figure/motion.h"

namespace wellspring::avatar {

struct Joint {
  std::string name;  // H-Anim v2 name ("l_shoulder"); aliases and prefixes of the file resolved
  int parent = -1;   // always smaller than the joint's own index; -1: the root
  vec3 center{0};    // humanoid space at rest, metres
  // Turn of the joint in the file, relative to its parent. It is no part of the rest pose, which is
  // the H-Anim default pose (no joint turned); a Pose of these rotations shows the figure as the
  // file does.
  quat rest_rotation{1, 0, 0, 0};
  std::vector<vec2> limits;            // empty, or lower/upper radians for x, y, z (joint_limits.h)
  quat limit_orientation{1, 0, 0, 0};  // orientation of the limits' axes
  vec3 stiffness{0};                   // reluctance to turn about x, y, z, 0..1
};

struct Segment {
  std::string name;
  int joint = 0;
};

struct Site {
  std::string name;
  int joint = 0;
  vec3 position{0};  // humanoid space at rest
};

// Says how joints bend the skin: by blended matrices, as all file formats mean it, or by blended
// dual quaternions, which keep the volume of a twisted limb.
enum class Skinning : uint8_t { linear, dual_quaternion };

// Moves some vertices by weight * displacement: a closed lid, a smile, a mouth shape.
struct Displacer {
  std::string name;
  std::vector<uint32_t> vertices;   // indices into Character::positions
  std::vector<vec3> displacements;  // humanoid space at rest
};

// Describes how a part of the figure looks (X3D 4 PhysicalMaterial; older Material is converted).
struct Appearance {
  std::string name;
  vec3 base_color{0.8f};
  float metallic = 0, roughness = 0.7f, alpha = 1;
  vec3 emission{0};
  std::string texture;  // path of an image beside the file; empty: none
  std::string normal_texture, metallic_roughness_texture, emission_texture;  // paths, too
  float normal_scale = 1;
  bool double_sided = false;
  bool clear_colors = false;  // vertices' colours let light through if their alpha is below 1
  // Index of the material in the figure's material_file, if it has one; that material says more
  // than the fields above.
  int material = -1;
  bool lambertian =
      false;  // a shading model that is not physical: shown without gloss, lit as all else
};

// Holds triangles of one look.
struct Part {
  std::string name;
  int appearance = 0;
  std::vector<uvec3> triangles;  // indices into Character::positions
};

struct JointWeight {
  uint16_t joint = 0;
  float weight = 0;
};

// Says how far an eye follows the place looked at (VRMC_vrm-1.0, lookAt.md): by `output` if that is
// `most` radians or more to the side, evenly less before; radians of its socket, or the weight of a
// shape. Eyes drawn as flat discs must not leave the head. most 0: the author has not said.
struct EyeRange {
  float most = 0, output = 0;
};
struct EyeRanges {
  EyeRange inner, outer, up, down;
  bool by_shapes = false;  // eyes look by displacers even if they have joints
};

// Adds to a look by a displacer's whole weight: an expression that blushes, glows or shows other
// parts of a picture (VRM's material binds).
struct AppearanceChange {
  int displacer = 0, appearance = 0;
  vec4 base_color{0};
  vec3 emission{0};
  mat3 uv{0.0f};  // added to the matrix of texture coordinates
};

// Names displacers that are driven by themselves, and may be forbidden while an expression shows.
enum class ExpressionGroup : uint8_t { blink, gaze, mouth };
inline constexpr size_t expression_groups = 3;
enum class ExpressionOverride : uint8_t { none, block, blend };
// This is the rule of a displacer (expression_rules.h).
struct ExpressionRule {
  int displacer = 0;
  bool binary = false;  // shown wholly above one half, else not at all
  int group = -1;       // an ExpressionGroup it belongs to
  std::array<ExpressionOverride, expression_groups> overrides{};
};

// This is a joint that hangs and swings (spring_bones.h); numbers as in VRMC_springBone.
struct SpringBone {
  int joint = 0;
  vec3 tail{0};  // way from the joint's centre to the bone's end at rest, never zero
  float stiffness = 1, drag = 0.5f, radius = 0;
  vec3 gravity{0};  // direction times power, humanoid space
  int center = -1;  // joint above it in whose frame its inertia counts; -1: humanoid space
  std::vector<int> colliders;  // indices into Character::spring_colliders
};

// This is a joint that turns as another does, or towards it (joint_constraints.h,
// VRMC_node_constraint-1.0).
struct JointConstraint {
  enum class Kind : uint8_t { roll, aim, rotation };
  int joint = 0, source = 0;
  Kind kind = Kind::rotation;
  float weight = 1;          // share of the turn that it takes, 0..1
  vec3 axis{0};              // axis rolled about, or aimed: unit, humanoid space at rest
  quat between{1, 0, 0, 0};  // roll and rotation: from axes of the source's turn to the joint's
};

// This is what swinging bones keep clear of: a ball, a capsule from `place` to `tail`, or half a
// space.
struct SpringCollider {
  int joint = 0;
  vec3 place{0}, tail{0};  // humanoid space at rest
  vec3 normal{0};          // normal of the half space's border, unit; zero: ball or capsule
  float radius = 0;
  bool inside = false;  // keeps what it meets inside
};

struct Character {
  std::string name;
  int loa = -1;  // level of articulation as found in the joints
  std::vector<Joint> joints;
  std::vector<Segment> segments;
  std::vector<Site> sites;
  std::vector<Displacer> displacers;
  std::vector<Appearance> appearances;
  std::vector<Part> parts;
  // Vertices, shared by all parts; at rest, in humanoid space (metres, +Y up, facing +Z, feet at y
  // = 0).
  std::vector<vec3> positions;
  std::vector<vec3> normals;
  std::vector<vec2> uv;  // empty, or one a vertex; (0, 0) is the picture's top left, as in glTF
  std::vector<vec2> second_uv;  // the same for pictures of a material_file that ask for them
  std::vector<vec4> colors;     // empty, or one a vertex; multiply the looks' colours
  std::string material_file;    // glTF file whose materials Appearance::material names; empty: none
  // Joints that move vertex v: weights[first_weight[v] .. first_weight[v + 1]), sum 1.
  std::vector<uint32_t> first_weight;
  std::vector<JointWeight> weights;
  Skinning skinning = Skinning::linear;
  EyeRanges eye_ranges;
  std::vector<AppearanceChange> appearance_changes;
  std::vector<ExpressionRule> expression_rules;  // one a displacer at most; empty: nothing is asked
  std::vector<JointConstraint> constraints;      // in the order in which to follow them
  std::vector<SpringBone> springs;               // by joint, parents first
  std::vector<SpringCollider> spring_colliders;
  std::vector<Motion> motions;
  // Entries of the file about its maker and licence: "author" -> "Jane Doe".
  std::vector<std::pair<std::string, std::string>> metadata;
  std::vector<std::string> warnings;  // unknown or unsupported things, each said once
};

int find_joint(const Character& character, std::string_view name);      // -1: none
int find_displacer(const Character& character, std::string_view name);  // -1: none

// Decides how much of the storyteller runs. Walls stand around it at two distances; the zone of the
// nearest viewer says what is needed, and the rest is not computed. A wall is crossed inwards and
// outwards at different distances, so that somebody standing on it does not make the figure
// flicker. Source: the storyteller and kiosk paper, "glass walls" (no expressions when very
// distant, voice and Perlin's face in the middle, all of MPEG-4 near); the distances are ours.
//
//                            none (beyond 8 m)   medium (3 to 8 m)         full (within 3 m)
//   body, gestures           yes, without fingers yes                      yes
//   head's gaze              yes                 yes                       yes
//   eyes                     -                   yes, no saccades          yes
//   blink, speech            -                   yes                       yes
//   face                     -                   Perlin's flexes           all expressions
//   noise                    -                   of the body               of face and body
//   hair and cloth (springs) -                   yes                       yes
//   lazy mirror, empathy     -                   -                         yes

// A level of detail.
enum class Detail : uint8_t { none, medium, full };
const char* to_string(Detail detail);

struct DetailWalls {
  float near = 3, far = 8;   // metres
  float hysteresis = 0.25f;  // metres to both sides of a wall
};

// Returns the zone of a viewer at `distance` who was in zone `before`. NaN: no change.
Detail next_detail(Detail before, float distance, const DetailWalls& walls = {});

// Counts what has been computed since the storyteller began; a figure far away shows it by counts
// that stand still.
struct StorytellerWork {
  uint64_t ticks = 0, fingers = 0, eyes = 0, saccades = 0, blinks = 0, visemes = 0, flexes = 0,
           flex_noise = 0, body_noise = 0, expressions = 0, mirror = 0, empathy = 0, springs = 0;
  bool operator==(const StorytellerWork&) const = default;
};

}  // namespace wellspring::avatar
