// SPDX-License-Identifier: Apache-2.0
// The lamps of a running exhibit. All visitors share them: whoever switches one does it for
// everybody.
//
// What is wanted changes at once and is told to everybody; the light follows when the renderer is
// idle, a fifth of a second after the last change at the earliest, so that nobody makes it flash
// more than three times a second (WCAG 2.2, success criterion 2.3.1: six changes). Each visitor's
// cache learns of it before its next picture, and what was asked for in the old light is not taken
// any more.
#pragma once
#include <string_view>

#include "show/state/show.h"

namespace wellspring {

// Puts the lamps as they are at first. show.lights were made, and are prepared, while all were on.
// Maps of the exhibit's scene, of all lamps, from now on. While nothing is drawn.
void use_maps(Show& show, std::shared_ptr<const IlluminationMap> maps);
void begin_lamps(Show& show);
// Everybody hears of it with the next tick. False: there is no such lamp.
bool switch_lamp(Show& show, std::string_view name, bool on);
// Is the light to follow now?
bool lamps_wait(const Show& show);
// The world and its lights as they are wanted; milliseconds. Only while the renderer is idle.
void light_lamps(Show& show);
// Before anything is drawn for a visitor, by whoever draws: its cache forgets what another light
// was.
void follow_lamps(Show& show, Visitor& visitor);
// What only visitors need who have yet to follow is kept no longer. Only while the renderer is
// idle.
void invalidate_light_steps(Show& show);

}  // namespace wellspring
