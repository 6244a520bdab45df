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
#include <cstdint>
#include <span>

#include "show/state/reconstruction.h"

namespace wellspring::show {

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
