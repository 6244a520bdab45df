// SPDX-License-Identifier: Apache-2.0
// A whole exhibit as one still scene: for pictures of it without a running show.
#pragma once
#include "show/exhibit/exhibit.h"
#include "world/world.h"

namespace wellspring::show {

// The exhibit's animations move these in a World: a moving mesh each.

// Bounds the places of something while it moves, relative to the scene's origin.
struct Reach {
  vec3 centre{0};
  float radius = 0;  // metres; 0: nothing moves
};

struct Movers {
  std::vector<int> moving;     // for each of Exhibit::movers one of the World's moving meshes
  std::vector<Reach> reach;    // one for each of Exhibit::animations
  std::vector<double> posed;   // the times of these for which the world stands
  std::vector<char> mirrored;  // for each mover: its mesh was turned round when the world was made
  bool empty() const { return moving.empty(); }
};

// Appends their meshes, as they are when every animation begins, and the objects they belong to.
Movers make_movers(const Exhibit& exhibit, std::vector<Mesh>& moving,
                   std::vector<uint32_t>& moving_object);

// Moves them to where the animations have them at these times, seconds of each. True: something
// did; call World::commit() afterwards.
bool pose_movers(const Exhibit& exhibit, const std::vector<double>& times, Movers& movers,
                 World& world);

// The same as a mesh of exhibit.movers[mover].
Mesh mover_mesh(const Exhibit& exhibit, size_t mover, const std::vector<double>& times);

// How far an animation has come. One that loops runs by the show's clock; one that is started by
// touch runs to its end and stays there, until it is touched again and runs back.

// Holds the state of an animation that is started by touch. Times are show times.
struct Play {
  bool on = false;      // it is at its end, or on the way there
  double from = 0;      // seconds of the animation, at the last touch
  double since = -1e9;  // when that was
};

// Seconds of the animation.
double time_of(const ExhibitAnimation& animation, const Play& play, double now);
bool is_running(const ExhibitAnimation& animation, const Play& play, double now);
void set_on(const ExhibitAnimation& animation, bool on, double now, Play& play);

// The storyteller's placement in the world of `scene`.
mat4 place_storyteller(const StorytellerPlace& place, const Scene& scene);

// The exhibit's scene with its viewpoints as cameras and its storyteller standing where it stands,
// as it idles `time` seconds after nobody came; animations that loop have run so long, and lights
// that change are as they are then.
Scene make_exhibit_scene(Exhibit exhibit, double time);

}  // namespace wellspring::show
