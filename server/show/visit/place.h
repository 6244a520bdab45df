// SPDX-License-Identifier: Apache-2.0
// Holds where one visitor is: the place and what moves it, by the visitor's own steps or by a tour,
// and the past motion that says where the visitor is heading.
#pragma once
#include <optional>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/visit/camera_path.h"
#include "show/visit/tour.h"
#include "world/view.h"
#include "world/world.h"

namespace wellspring::show {

// Lets a visitor look at an object from all sides, as if it were lifted out of its case: the eye
// goes round it, what stands before it is cut away, and it keeps the light of its place. The
// visitor stays where they stand meanwhile.

struct Around {
  int point = -1;       // index into Exhibit::points; -1: nothing
  bool leaves = false;  // the eye goes back to where the visitor stands
  float share = 0;      // share of the way there: 0 is where the visitor stands, 1 round the object
  dvec3 centre{0};      // absolute
  double radius = 0;    // metres, of a sphere around the object
  double distance = 0, wanted_distance = 0;  // metres from the centre to the eye
  vec2 look{0}, wanted_look{0};              // yaw and pitch of the eye, which looks at the centre
  Viewpoint view;                            // the object as it is seen
  float near = 0;                            // View::near
};

// Returns the bounds of all that belongs to the object as it stands now, relative to the scene's
// origin; empty: low above high.
Bounds object_bounds(const World& world, const PointOfInterest& point);

// Begins from the side of the object that is seen from `from`. `aspect`: the picture's width over
// its height.
void begin_around(const Exhibit& exhibit, int point, const Bounds& bounds, const Viewpoint& from,
                  float aspect, Around& around);
// Turns the object by `look`, as a visitor's head turns by that.
void turn_around(vec2 look, Around& around);
// Moves on by `dt` seconds, nearer by `forward` metres a second of the object's own size. `from`:
// where the visitor stands; `leaps`: at once. It ends by itself once it has gone back.
void advance_around(const Viewpoint& from, float forward, bool leaps, float dt, Around& around);

// Finds where a visitor is heading: what its view has done in the last moments, and where that
// leads by when a picture that is drawn now is seen.

struct Heading {
  struct PastView {
    double time = 0;
    View view;
  };
  // views of the last twentieth of a second, at most 32; at least the last one before
  std::vector<PastView> past;
};

// Notes the view at a later `time`. Returns true if it has leapt to another place, so that nothing
// seen before helps.
bool note_view(Heading& heading, double time, const View& view);

// Returns the view that is to be expected `seconds` after it was last noted, as `now`: straight on,
// and round the same axis. Keys start and stop at once, so that motion is measured over as short a
// time as inputs allow, which come in steps of their own; to expect less of motion the younger it
// is gains nothing more (cache.turns.unknown).
View expected_view(const Heading& heading, const View& now, double seconds);
// Returns by how many radians the view may turn away from there in `seconds` more or less.
float expected_turn(const Heading& heading, const View& now, double seconds);

struct EyeMotion {
  float speed = 0, turn = 0;  // metres and radians a second
};
EyeMotion motion_of(const Heading& heading, const View& now);

// Returns a view of all that a visitor may turn to within a moment, in an eighth of the pixels.
View wide_view(const View& now);
// Returns whether the visitor has moved away from what such a view shows well.
bool is_elsewhere(const View& wide, const View& now);

struct VisitorPlace {
  Viewpoint view;
  vec3 move{0};      // wish as last sent: right, up, forward
  vec3 velocity{0};  // the visitor's velocity, which follows `move` smoothly
  uint32_t seq = 0;  // number of the last input, camera or viewpoint message
  int viewpoint =
      0;  // index of the named viewpoint last jumped to, while the visitor stays there; else -1
  TourRide tour;
  Glide glide;
  int closer = -1;       // index into Exhibit::points of what the visitor went to look at
  Around around;         // object that is looked at from all sides, instead of from `view`
  bool comfort = false;  // the visitor leaps instead of gliding
  // These are noticed once a tick (show/draw/pace.h).
  View last_view;            // view in the last tick
  uint32_t camera_cuts = 0;  // number of cuts to other places, so that nothing seen before helps
  Heading heading;
  double moved_at = 0;  // show time of the last change of view
  bool leapt = false;   // the change was a leap to another place
};

// Moves a visitor by `dt` seconds: by its tour, whose narrator's voice that is, or walking by its
// own input, not too near to the `person` who stands there. Returns what the tour did.
TourStep move_visitor(VisitorPlace& place, Voice& narrator, const World& world,
                      const Exhibit& exhibit, const TourRoads& roads,
                      const std::optional<dvec3>& person, float dt);
// Ends being on the way to anything, and looking closer at it or round it.
void stand(VisitorPlace& place);
// Leaps to a viewpoint: a camera cut, after which nothing seen before helps.
void go_to_viewpoint(VisitorPlace& place, Voice& narrator, const Exhibit& exhibit, int viewpoint);

}  // namespace wellspring::show
