// SPDX-License-Identifier: Apache-2.0
// A whole exhibit as one still scene: for pictures of it without a running show.
#pragma once
#include "show/exhibit/exhibit.h"

namespace wellspring::show {

// The storyteller's placement in the world of `scene`.
mat4 place_storyteller(const StorytellerPlace& place, const Scene& scene);

// The exhibit's scene with its viewpoints as cameras and its storyteller standing where it stands,
// as it idles `time` seconds after nobody came; animations that loop have run so long, and lights
// that change are as they are then.
Scene make_exhibit_scene(Exhibit exhibit, double time);

}  // namespace wellspring::show
