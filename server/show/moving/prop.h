// SPDX-License-Identifier: Apache-2.0
// A thing that a storyteller holds, in a World: a moving mesh for each of its materials' meshes,
// hidden while nobody holds it.
#pragma once
#include "show/exhibit/exhibit.h"
#include "world/world.h"

namespace wellspring::show {

struct PropPart {
  int moving = 0;                        // which of the World's moving meshes
  std::vector<vec3> positions, normals;  // in the fist's frame (avatar/body/hold.h)
  bool shines = false;                   // it is seen to emit: a flame
  vec3 foot{0};  // foot of a flame, which grows from here along the fist's y
  bool shown = false;
};

struct Prop {
  std::vector<PropPart> parts;
  std::vector<vec3> positions, normals;  // working memory of pose_prop
};

// How it is seen.
struct PropPose {
  mat4 to_world{1};  // from the fist's frame
  float size = 0;    // 0..1, about the hand; 0: not at all
  float flame = 0;   // about 0..1: what shines grows from its foot; 0: it is not lit
};

// Appends its materials, pictures and object to `scene`, and its meshes to `moving`.
Prop make_prop(const ExhibitProp& prop, Scene& scene, std::vector<Mesh>& moving,
               std::vector<uint32_t>& moving_object);

// The same of a thing that guests hold to a kiosk's camera: the exhibit's prop of that id, else its
// object. In its own frame its middle is at 0 and +z is its front, as in its file, or by its node's
// axes. It is at most 0.3 m long. No parts: there is no such thing, or it has more than 20,000
// triangles.
Prop make_held_model(const Exhibit& exhibit, const std::string& id, Scene& scene,
                     std::vector<Mesh>& moving, std::vector<uint32_t>& moving_object);

// Moves, shows and hides it. True: something changed; call World::commit() afterwards.
bool pose_prop(World& world, Prop& prop, const PropPose& pose);

}  // namespace wellspring::show
