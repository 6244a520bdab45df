// SPDX-License-Identifier: Apache-2.0
// Writes what samples of an exhibit depend on besides its files: which lamps are on, what pieces
// show, how the storyteller and all else that moves stand. A worker that has the same files puts
// its world into that state and finds the same samples.
//
// Large pictures and volumes come to a worker piece by piece, as to a server: until it has those
// that a sample meets, it sees coarser ones.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "show/exhibit/pieces/piece_choices.h"
#include "show/state/cast.h"
#include "show/state/stage.h"
#include "workers/message.h"

namespace wellspring::show {

// Writes the state that the world is in. `shown`: what is shown of pieces.
std::string write_world_state(const ExhibitStage& stage, const ShowCast& cast,
                              const ShownPieces& shown);
// Puts the world into that state, while nothing reads it. Returns false if the bytes are not a
// state of this exhibit; the world stays as it was.
bool put_world_state(std::string_view bytes, ExhibitStage& stage, ShowCast& cast);

// Returns a number of what stands in the world and what can move there.
uint64_t number_scene(const ExhibitStage& stage);
// Returns the maps on which walks end, with all lamps full; null: there are none.
std::shared_ptr<const IlluminationMap> known_maps(const ExhibitStage& stage);
// Returns a number of the maps' light; 0: null. Takes milliseconds.
uint64_t number_light(const IlluminationMap* maps);
SampleBounds sample_bounds(const World& world);

}  // namespace wellspring::show
