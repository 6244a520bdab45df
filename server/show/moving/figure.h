// SPDX-License-Identifier: Apache-2.0
// A Character in a World: one moving mesh a part, with that part's vertices only.
//   std::vector<Mesh> moving; std::vector<uint32_t> objects;
//   Figure figure = make_figure(character, scene, moving, objects);
//   World world(scene, moving, objects);
//   each tick: pose_figure(world, figure, character, pose, placement, scratch); world.commit();
#pragma once
#include "avatar/figure/skin.h"
#include "world/world.h"

namespace wellspring::show {

struct FigurePart {
  int moving = 0;                  // which of the World's moving meshes
  std::vector<uint32_t> vertices;  // vertices of the character, in the mesh's order
};

// A look that expressions change, as it is now.
struct FigurePaint {
  int appearance = 0, material = 0;  // indices into the character's, into the scene's
  Repaint change;
};

struct Figure {
  std::vector<FigurePart> parts;
  std::vector<FigurePaint> paints;  // paints of the looks in use alone
  uint32_t object = 0;              // in Scene::objects, named as the character
  // Working memory of pose_figure.
  std::vector<vec3> positions, normals, part_positions, part_normals;
  std::vector<AppearanceChange> appearance_changes;
};

// Appends the character's materials, pictures and its object to `scene`, and its meshes (at rest,
// in humanoid space) to `moving`. Pictures that cannot be read leave a warning in the scene. Called
// once.
Figure make_figure(const Character& character, Scene& scene, std::vector<Mesh>& moving,
                   std::vector<uint32_t>& moving_object);

// Skins the character, moves its meshes and repaints what looks differently than before; call
// World::commit() afterwards. Once a tick; all cores.
void pose_figure(World& world, Figure& figure, const Character& character, const Pose& pose,
                 const mat4& placement, SkinScratch& scratch);

void show_figure(World& world, const Figure& figure, bool visible);

}  // namespace wellspring::show
