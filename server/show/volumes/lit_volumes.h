// SPDX-License-Identifier: Apache-2.0
// Keeps the presets of an exhibit's volumes as they look in the light of the room, and makes them
// on a thread of its own: a light grid takes some tenths of a second, and no picture waits for it.
#pragma once
#include <cstdint>
#include <memory>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "show/volumes/room_light.h"

namespace wellspring::show {

class LitVolumes {
 public:
  LitVolumes();
  ~LitVolumes();

  // Puts the exhibit's volumes into the world, each with its first preset in the light that is
  // there. Takes some tenths of a second for each. While nothing is drawn.
  void begin(const Exhibit& exhibit, const Lights& lights, const Technique& technique,
             World& world);
  // Shows volumes as they are chosen, in the light that is there. Until a preset was made for that
  // light, it is shown in another one, or the one before stays. Likewise.
  void show(const Exhibit& exhibit, const PieceChoices& choices, const Lights& lights,
            const Technique& technique, World& world);
  // Waits until all that show() has asked for is made.
  void wait();
  // Returns how often something was made since the beginning, or read of volumes that are larger
  // than memory: then pictures may show it.
  uint64_t arrivals() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::show
