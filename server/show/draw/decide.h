// SPDX-License-Identifier: Apache-2.0
// Decides what is drawn when: one decision a tick, from plain values. The tick gathers them
// (show/draw/pace.h) and carries the decision out (show/draw/carry_out.h). Nothing here depends on
// a Show, so that every rule is a row of a table in the test.
//
// Moving things come first, and their light, then what is begun, then glasses, then samples that
// were asked for, then the reconstruction that is under way, else a picture: of those who want one,
// whoever has had least of the renderer's time, so that nobody has more of it than others by asking
// for more. But equal time is not equal pictures: if a visitor's view costs more, or turns to what
// no keyframe shows, so that it cannot be warped, pictures would stay away for long. Walkers who
// were shown none for half a second therefore come first, whoever has waited longest; when that is
// so for all of them, each gets as many pictures.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "show/state/renderer.h"

namespace wellspring::show {

// Decides by measured costs how many samples a picture is given, and how large a keyframe is drawn.

struct DrawingCosts {
  double samples_per_second = 0;  // all cores
  double drawing_seconds = 0;     // visibility and shading of a picture, all cores
  double display_seconds = 0;     // other work on a picture: reprojection, tone mapping
  // likewise for a picture drawn while the visitor moves; 0: never measured
  double light_seconds = 0;
};

// Returns the samples of a picture. `seconds`: time for all its work. In a picture for a visitor
// who `stands`, at least a quarter of the time goes to light.
int sample_budget(double seconds, size_t pixels, const DrawingCosts& costs, bool stands);

// Returns how many of so many samples at rest are to find changes of the light.
int samples_to_watch(int samples);

// Holds a plan of keyframes for a moving visitor: their sides over those of the visitor's picture,
// and the seconds until the next one, in which samples have the time that drawing leaves.
struct KeyframePlan {
  float scale = 1;
  double period = 0;
};
// Plans the next keyframe. Resolution falls if keyframes would come late, since what a warp does
// not show is worse than what it shows softly. `seconds`: what drawing one of scale `before` took,
// as often as there are visitors who move; resolution climbs back only if there is time to spare.
// longest_period: seconds, beyond which keyframes come late.
KeyframePlan plan_keyframe(double seconds, float before, double longest_period);

// Says how a page that draws by itself shows more and more wrong, the longer it uses one keyframe.
// The fields are shares of the picture, a second.
struct Ageing {
  float uncovered = 0;  // appear beside what is nearer, in no keyframe
  float turned_to = 0;  // come in from the side, where the wide keyframe has few pixels
};
// Returns the seconds that one keyframe may be used until that shows. A visitor who passes near
// things needs many keyframes; one who turns within the wide keyframe's reach, few.
double longest_period(const Ageing& ageing);
// This is the period for pictures that are finished by the server.
inline constexpr double finished_period = 1 / 10.0;  // beyond, turns and near things uncover much
// Returns the cost of drawing a keyframe of that scale, over one of scale 1. Points and triangles
// do not get fewer with the pixels: 0.52 at a half and 0.36 at 3/8 (castle, one core).
double keyframe_cost(float scale);

// Returns how much of its pace a tour's camera keeps, 0 to 1, so that keyframes follow its turns:
// `turn` radians of a picture `fov` radians wide from one keyframe to the next.
float tour_pace(float turn, float fov);

// Returns whether the reference (`path`) answers: if the visitor has stood for a while, and most
// places have so many answers of the quicker technique, whose single samples are less noisy, that
// those of the reference are no noise to speak of. `before`: the reference answered for the picture
// before. `guessed`: share of the picture's light that no point holds; `known`: share of the pixels
// with that many answers (CacheStats::converged).
bool wants_reference(double seconds_at_rest, bool before, float guessed, float known);

// Holds the facts about one visitor that the decision depends on. Times are show times, rates
// pictures a second.
struct VisitorDrawState {
  bool welcomed = false;
  bool at_work = false;    // the renderer is at work on a picture of the visitor, or on its samples
  bool can_take = false;   // the visitor's browser and socket can take a picture
  bool stands = false;     // nothing moved the visitor's view for a moment
  bool new_place = false;  // nothing was drawn yet of the visitor's present place
  bool same_view = false;  // the last picture was drawn for the visitor's present view
  bool at_once = false;    // a picture at rest is to be there at once (show/lens/pieces.h)
  bool other_light = false;  // lamps, hour or very large pictures have changed since that picture
  bool sees_moving = false;  // something that can move may be in view
  bool drew_moving = false;  // something that can move may have been in that picture
  bool unshown = false;      // the last picture has not been sent yet
  bool backdrop = false;     // the last picture is without moving things
  bool in_pass = false;      // a reconstruction of the visitor's picture is under way
  bool lens_moves = false;   // the visitor moves a glass
  bool lens_due = false;     // the visitor's glass is to show something new
  double lens_at = -1e9;     // when it was last drawn
  double came_at = -1e9;     // when the visit began
  // when the last picture, and the last moving things, were ordered
  double drawn_at = -1e9, posed_at = -1e9;
  double shown_at = -1e9;  // when the browser was last sent a picture
  double moved_at = 0;     // when the view changed last
  double picture_rate = 1, drawing_rate = 1, moving_rate = 1;
  double asked_seconds = 0;  // seconds of all cores for samples that it has asked for
  double served = 0;         // seconds of the renderer's time: VisitorPicture::served
  RestState rest;
};

// Holds the state of the renderer, and of what all visitors share.
struct RendererState {
  bool idle = true;              // it has nothing in hand
  int drawn = -1;                // whose picture is begun, index of the states; -1: nobody's
  bool traces = false;           // the next step of that picture is to trace samples
  bool can_reconstruct = false;  // there is a network
  bool in_pass = false;          // a reconstruction of somebody's picture is under way
  bool has_skin = false;         // moving things keep light on their skin
  double skin_at = -1e9;         // when skin light was last ordered
  double skin_interval = 0.2;    // seconds from then until it is due again
  uint64_t skin_turn = 0;        // number of times that it was ordered
  double served = 0;             // Renderer::served
  int waiting = 0;               // visitors who waited for a picture when the tick began
};

enum class Drawing : uint8_t {
  nothing,
  moving,   // moving things in the visitor's picture
  skin,     // light on moving things
  go_on,    // the next step of the picture that is begun
  lens,     // picture of the visitor's glass
  samples,  // samples that visitors have asked for
  pass,     // a slice of the reconstruction
  picture,  // the visitor's next picture
};

struct Decision {
  Drawing what = Drawing::nothing;
  int visitor = -1;    // index of the states: whose, for moving, skin, go_on and picture
  bool hurry = false;  // for go_on: others wait, so samples that are not traced yet are left out
  PictureKind kind = PictureKind::moving;  // for picture: what is wanted of it
  double served = 0;                       // for picture: Renderer::served from then on
  bool operator==(const Decision&) const = default;
};

Decision decide(double now, std::span<const VisitorDrawState> states,
                const RendererState& renderer);

// Says, before the storyteller is moved, for whose pictures that is to be done.
struct Demand {
  int waiting = 0;      // number of visitors; not counted: those who only gain by more samples
  bool moving = false;  // moving things are due for somebody
  bool operator==(const Demand&) const = default;
};
Demand find_demand(double now, std::span<const VisitorDrawState> states,
                   const RendererState& renderer);

// ---- The rules, each by itself.

// Returns whether the last picture stays as it is, and moving things are laid over it.
bool has_backdrop(const VisitorDrawState& state);
// Returns whether moving things are due, and the browser could take a picture.
bool wants_moving(double now, const VisitorDrawState& state);
// Returns who is next to have the light found on the moving things that they may see, in turn; that
// light is kept once for all. -1: it is not due, or nobody sees any.
int next_to_light(double now, std::span<const VisitorDrawState> states,
                  const RendererState& renderer);
// Returns whether a picture is due, and the browser could take it.
bool wants_picture(double now, const VisitorDrawState& state);
// Returns whether the visitor's picture is a reconstruction and stays: only samples are wanted.
bool keeps_picture(const VisitorDrawState& state);
// Returns whether the next picture is to become a reconstruction.
bool wants_pass(double now, const VisitorDrawState& state, const RendererState& renderer);

}  // namespace wellspring::show
