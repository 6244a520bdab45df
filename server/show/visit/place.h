// SPDX-License-Identifier: Apache-2.0
// Where one visitor is: the place and what moves it, by its own steps or by a tour, and what of its
// motion is remembered to tell where it is heading.
#pragma once
#include <optional>

#include "show/exhibit/exhibit.h"
#include "show/visit/around.h"
#include "show/visit/glide.h"
#include "show/visit/heading.h"
#include "show/visit/tour.h"
#include "world/view.h"
#include "world/world.h"

namespace wellspring::show {

struct VisitorPlace {
  Viewpoint view;
  vec3 move{0};      // as last asked for: right, up, forward
  vec3 velocity{0};  // what the visitor does: follows `move` smoothly
  uint32_t seq = 0;  // of the last input, camera or viewpoint message
  int viewpoint =
      0;  // index of the named viewpoint last jumped to, while the visitor stays there; else -1
  TourRide tour;
  Glide glide;
  int closer = -1;       // index into Exhibit::points: what the visitor went to look at
  Around around;         // what is looked at from all sides, instead of from `view`
  bool comfort = false;  // leaps instead of gliding
  // Noticed once a tick (show/draw/pace.h).
  View last_view;            // of the last tick
  uint32_t camera_cuts = 0;  // to other places, so that nothing seen before helps
  Heading heading;
  double moved_at = 0;  // show time of the last change of view
};

// Moves a visitor by `dt` seconds: by its tour, whose narrator's voice that is, or walking by its
// own input, not too near to the `person` who stands there. Returns what the tour did.
TourStep move_visitor(VisitorPlace& place, Voice& narrator, const World& world,
                      const Exhibit& exhibit, const TourRoads& roads,
                      const std::optional<dvec3>& person, float dt);
// Neither on the way to anything nor looking closer at it, or round it, any more.
void stand(VisitorPlace& place);
// There is then nothing left to be seen of where the visitor was.
void go_to_viewpoint(VisitorPlace& place, Voice& narrator, const Exhibit& exhibit, int viewpoint);

}  // namespace wellspring::show
