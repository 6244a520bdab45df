// SPDX-License-Identifier: Apache-2.0
// Switches the lamps of a running exhibit, and sets its hour of the day. A visitor switches a lamp
// for themselves, or for everybody if the exhibit says that it is shared; the hour is everyone's
// own.
//
// A wish is noted at once and sent to pages; the light follows between two pictures, a fifth of a
// second after the last change at the earliest, so that nobody makes it flash more than three times
// a second (WCAG 2.2, success criterion 2.3.1: six changes). The world has one state at a time: it
// is put into the visitor's before each picture, and the light that was found in each state is
// kept. Each visitor's cache follows a change before its next picture, and samples that were asked
// for in the old light are not taken any more.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "light/virtual/direct_light.h"
#include "show/state/show.h"

namespace wellspring::show {

// Returns for each object whether some of its light depends on the view, which maps do not hold.
std::vector<char> shining_objects(const Scene& scene);
// Makes pictures show maps of all lamps from now on. Call it while nothing is drawn.
void use_maps(ExhibitStage& stage, ShowVisits& visits, std::shared_ptr<const IlluminationMap> maps);
// Does the same with maps of the scene as it is: walks end on them, too.
void use_better_maps(ExhibitStage& stage, ShowVisits& visits,
                     std::shared_ptr<const IlluminationMap> maps);
// Puts the lamps as they are at first. show.stage.lights were made, and are prepared, while all
// lamps were full.
void begin_lamps(ExhibitStage& stage);
// Return what the visitor wants: how the exhibit's lamps are switched, by the visitor's own wish or
// the house's; the hour of the day (none: the exhibit's own); and the levels of the scene's lamps
// that follow from both.
std::vector<LampSwitch> switches_of(const ExhibitStage& stage, const ShowVisits& visits,
                                    const Visitor& visitor);
std::optional<double> hour_of(const Show& show, const Visitor& visitor);
LampLevels lamps_of(const Show& show, const Visitor& visitor);
// Switches a lamp; pages whose visitors see it are informed with the next tick. Returns false if
// there is no such lamp.
bool switch_lamp(Show& show, Visitor& visitor, std::string_view name, LampSwitch to);
// Sets the hour; none: back to the exhibit's own. The visitor's page is informed with the next
// tick. Returns false if the exhibit has no day.
bool set_hour(const ExhibitStage& stage, Visitor& visitor, std::optional<double> hour);
// Returns whether the visitor's light is to follow the wishes now.
bool lamps_wait(const Show& show, const Visitor& visitor);
// Makes the visitor's light follow from the next picture on. Call it while none is drawn for that
// visitor.
void light_lamps(Show& show, Visitor& visitor);
// Puts the world and its lights into that state. Only while the renderer is idle.
void light_world(ExhibitStage& stage, const LampLevels& lamps);
// Makes the visitor's cache follow the world's present light. Whoever draws calls it before
// anything is drawn for a visitor.
void follow_lamps(ExhibitStage& stage, Visitor& visitor);
// Forgets how far a picture at rest has come, since it shows something else from now on.
void look_anew(VisitorPicture& picture);
// Drops the light of states that nobody sees any more, and changes that nobody has yet to follow.
// Only while the renderer is idle.
void forget_lights(ExhibitStage& stage, const ShowVisits& visits);

// Finds a visitor's lights that move or change (light/virtual/direct_light.h): those of
// exhibit.json, at the visitor's hour of the day, and those that the visitor's storyteller carries.

// Values of DynamicLight::id: lights of exhibit.json and carried lights are numbered from the first
// and the last of these on; the sun has the one between.
inline constexpr uint32_t first_changing_light = 1, sun_of_the_day = 1000, first_carried = 2000;

// Returns the lights as they are at `time`, seconds of the show. If the exhibit has none, the list
// is empty and costs nothing.
DynamicLights dynamic_lights_of(const Show& show, const Visitor& visitor, double time);
// Returns those that may shine on what the view shows; a light of finite range shines only within
// that range.
DynamicLights dynamic_lights_in(const View& view, DynamicLights lights);

}  // namespace wellspring::show
