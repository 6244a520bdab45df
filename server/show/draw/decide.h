// SPDX-License-Identifier: Apache-2.0
// What is drawn when: one decision a tick, from plain values. The tick gathers them
// (show/draw/pace.h) and carries the decision out (show/draw/carry_out.h). Nothing here knows a
// Show, so that every rule is a row of a table in the test.
//
// What moves comes first, and its light, then what is begun, then samples that were asked for, then
// the reconstruction that is under way, else a picture: of those who want one, whoever has had
// least of the renderer's time, so that nobody has more of it than others by asking for more. But
// equal time is not equal pictures: where what is seen costs more, or turns away from what is
// known, so that it cannot be warped, pictures would stay away for long. Walkers who were shown
// none for half a second therefore come first, whoever has waited longest; when that is so for all
// of them, each gets as many pictures.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "show/state/renderer.h"

namespace wellspring::show {

// How many samples a picture is given, and how large a keyframe is drawn, decided by what was
// measured.

struct DrawingCosts {
  double samples_per_second = 0;  // all cores
  double drawing_seconds = 0;     // visibility and shading of a picture, all cores
  double display_seconds = 0;     // what a picture takes besides: reprojection, tone mapping
  double light_seconds = 0;       // the same of one drawn for who moves; 0: never measured
};

// `seconds`: what there is for all. Of a picture for who `stands` at least a quarter of the time
// goes to light.
int sample_budget(double seconds, size_t pixels, const DrawingCosts& costs, bool stands);

// Of so many samples at rest, those that are to find changes of the light.
int samples_to_watch(int samples);

// A keyframe for who moves: the sides that it is drawn with, over those of the visitor's picture,
// and the seconds until the next one, in which samples have the time that drawing leaves.
struct KeyframePlan {
  float scale = 1;
  double period = 0;
};
// Resolution falls where keyframes would come late, since what a warp does not know is worse than
// what it shows softly. `seconds`: what drawing one of scale `before` took, as often as there are
// visitors who move; it climbs back only where there is time to spare. longest_period: seconds,
// beyond which they come late.
KeyframePlan plan_keyframe(double seconds, float before, double longest_period);

// A page that draws by itself shows more and more wrong, the longer a keyframe has to do. These are
// shares of the picture, a second.
struct Ageing {
  float uncovered = 0;  // appear beside what is nearer, and nothing knows them
  float turned_to = 0;  // come in from the side, and the wide keyframe has them in few pixels
};
// Seconds that one may be used for until that shows. Who passes near things needs many; who turns
// within the wide keyframe's reach, few.
double longest_period(const Ageing& ageing);
// For pictures that are finished by the server.
inline constexpr double finished_period = 1 / 10.0;  // beyond, turns and near things uncover much
// What drawing a keyframe of that scale takes, over one of scale 1. Points and triangles do not get
// fewer with the pixels: 0.52 at a half and 0.36 at 3/8 (castle, one core).
double keyframe_cost(float scale);

// How much of its pace a tour's camera keeps, 0 to 1, so that keyframes follow its turns: `turn`
// radians of a picture `fov` radians wide from one keyframe to the next.
float tour_pace(float turn, float fov);

// Whether the reference (`path`) answers: who has stood for a while, when most places have so many
// answers of the quicker technique, whose single samples tell more, that those of the reference are
// no noise to speak of. `before`: it did for the picture before. `guessed`: share of its light that
// no point told; `known`: share of the pixels with that many (CacheStats::converged).
bool wants_reference(double seconds_at_rest, bool before, float guessed, float known);

// What of one visitor the decision depends on. Times are show times, rates pictures a second.
struct VisitorDrawState {
  bool welcomed = false;
  bool at_work = false;      // the renderer is at a picture of it, or at its samples
  bool can_take = false;     // its browser and socket can take a picture
  bool stands = false;       // nothing moved its view for a moment
  bool new_place = false;    // nothing was drawn yet of where it is now
  bool same_view = false;    // the last picture was drawn for the view that it has now
  bool other_light = false;  // lamps or the hour have changed since that picture
  bool sees_moving = false;  // something that can move may be in view
  bool drew_moving = false;  // and may have been in that picture
  bool unshown = false;      // that picture has not been sent yet
  bool backdrop = false;     // it is without what moves
  bool in_pass = false;      // a reconstruction of it is under way
  double came_at = -1e9;     // when the visit began
  double drawn_at = -1e9, posed_at = -1e9;  // when the last picture, and what moves, was ordered
  double shown_at = -1e9;                   // when the browser was sent one
  double moved_at = 0;                      // when the view changed last
  double picture_rate = 1, drawing_rate = 1, moving_rate = 1;
  double asked_seconds = 0;  // of all cores, for samples that it has asked for
  double served = 0;         // of the renderer's time: VisitorPicture::served
  RestState rest;
};

// What of the renderer, and of what all visitors share.
struct RendererState {
  bool idle = true;              // it has nothing in hand
  bool background = true;        // pictures are drawn while ticks go on; else the tick draws all
  int drawn = -1;                // whose picture is begun, index of the states; -1: nobody's
  bool traces = false;           // the next step of that are samples
  bool can_reconstruct = false;  // there is a network
  bool in_pass = false;          // a reconstruction of somebody's picture is under way
  bool has_skin = false;         // what moves keeps light on its skin
  double skin_at = -1e9;         // when that was last ordered
  double skin_interval = 0.2;    // seconds from then until it is due again
  uint64_t skin_turn = 0;        // how often
  double served = 0;             // Renderer::served
  int waiting = 0;               // visitors who waited for a picture when the tick began
};

enum class Drawing : uint8_t {
  nothing,
  moving,   // what moves in the visitor's picture
  skin,     // light on what moves
  go_on,    // the next step of what is begun
  samples,  // that visitors have asked for
  pass,     // a slice of the reconstruction
  picture,  // the visitor's next
};

// What a picture is drawn for.
enum class Purpose : uint8_t {
  shown,
  reconstruction,  // begins one, and is not shown
  samples,         // only these, as the reconstruction that is shown stays
};

struct Decision {
  Drawing what = Drawing::nothing;
  int visitor = -1;    // index of the states: whose, of moving, skin, go_on and picture
  bool hurry = false;  // of go_on: others wait, so samples that are not traced yet are left out
  Purpose purpose = Purpose::shown;  // of picture
  double served = 0;                 // of picture: Renderer::served from then on
  bool operator==(const Decision&) const = default;
};

Decision decide(double now, std::span<const VisitorDrawState> states,
                const RendererState& renderer);

// Before the storyteller is moved: for whose pictures that is to be done.
struct Demand {
  int waiting = 0;      // visitors; who only gains by more samples is not counted
  bool moving = false;  // what moves is due for somebody
  bool operator==(const Demand&) const = default;
};
Demand find_demand(double now, std::span<const VisitorDrawState> states,
                   const RendererState& renderer);

// ---- The rules, each by itself.

// The last picture stays as it is, and what moves is laid over it.
bool has_backdrop(const VisitorDrawState& state);
// What moves is due, and the browser could take a picture.
bool wants_moving(double now, const VisitorDrawState& state);
// Light on what moves, which is kept once, is due: who may see it, in turn; -1: it is not, or
// nobody.
int next_to_light(double now, std::span<const VisitorDrawState> states,
                  const RendererState& renderer);
// A picture is due, and the browser could take it.
bool wants_picture(double now, const VisitorDrawState& state, const RendererState& renderer);
// Its picture is a reconstruction and stays: only samples are wanted.
bool keeps_picture(const VisitorDrawState& state);
// The next picture is to become a reconstruction.
bool wants_pass(double now, const VisitorDrawState& state, const RendererState& renderer);

}  // namespace wellspring::show
