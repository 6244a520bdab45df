// SPDX-License-Identifier: Apache-2.0
// The lamps of a running exhibit, and its hour of the day. Who switches a lamp does it for
// themselves, or for everybody where the exhibit says that it is shared; the hour is everyone's
// own.
//
// What is wanted changes at once and is told; the light follows between two pictures, a fifth of a
// second after the last change at the earliest, so that nobody makes it flash more than three times
// a second (WCAG 2.2, success criterion 2.3.1: six changes). The world has one state at a time: it
// is put into the visitor's before each picture, and what is known of the light in each state is
// kept. Each visitor's cache learns of a change before its next picture, and what was asked for in
// the old light is not taken any more.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "light/dynamic/direct_light.h"
#include "show/state/show.h"

namespace wellspring::show {

// Tells of each object whether some of its light depends on the view, which maps do not know.
std::vector<char> shining_objects(const Scene& scene);
// Pictures show maps of all lamps from now on. While nothing is drawn.
void use_maps(Show& show, std::shared_ptr<const IlluminationMap> maps);
// The same of maps of the scene as it is: walks end on them, too.
void use_better_maps(Show& show, std::shared_ptr<const IlluminationMap> maps);
// Puts the lamps as they are at first. show.lights were made, and are prepared, while all were
// full.
void begin_lamps(Show& show);
// As the visitor wants them: which of the exhibit's are on, by the visitor's own wish or the
// house's; the hour of the day (nothing: the exhibit's own); and what levels of the scene's lamps
// follow from both.
std::vector<char> switches_of(const Show& show, const Visitor& visitor);
std::optional<double> hour_of(const Show& show, const Visitor& visitor);
LampLevels lamps_of(const Show& show, const Visitor& visitor);
// Who sees it hears of it with the next tick. False: there is no such lamp.
bool switch_lamp(Show& show, Visitor& visitor, std::string_view name, bool on);
// Nothing: back to the exhibit's own. Who sees it hears of it with the next tick. False: the
// exhibit has no day.
bool set_hour(const Show& show, Visitor& visitor, std::optional<double> hour);
// Is the visitor's light to follow now?
bool lamps_wait(const Show& show, const Visitor& visitor);
// It follows from the next picture on. While none is drawn for that visitor.
void light_lamps(Show& show, Visitor& visitor);
// The world and its lights in that state. Only while the renderer is idle.
void light_world(Show& show, const LampLevels& lamps);
// Before anything is drawn for a visitor, by whoever draws: its cache forgets what another light
// was.
void follow_lamps(Show& show, Visitor& visitor);
// What nobody sees any more, or has yet to follow, is kept no longer. Only while the renderer is
// idle.
void forget_lights(Show& show);

// The lights of a visitor that move or change (light/dynamic/direct_light.h): those of
// exhibit.json, at the visitor's hour of the day, and those that the visitor's teller carries.

// DynamicLight::id: of exhibit.lights their place there and this, and of the others.
inline constexpr uint32_t first_changing_light = 1, sun_of_the_day = 1000, first_carried = 2000;

// As they are at `time`, seconds of the show. Empty, at no cost, where the exhibit has none.
DynamicLights dynamic_lights_of(const Show& show, const Visitor& visitor, double time);
// Those that may shine on what the view shows: one of finite range only within that.
DynamicLights dynamic_lights_in(const View& view, DynamicLights lights);

}  // namespace wellspring::show
