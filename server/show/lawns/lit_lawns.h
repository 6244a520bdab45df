// SPDX-License-Identifier: Apache-2.0
// Keeps the lawns of an exhibit as pictures show them. All functions are called while nothing is
// drawn.
#pragma once
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lawn/response.h"
#include "picture/grass_view.h"
#include "show/exhibit/exhibit.h"
#include "show/lawns/lawn_light.h"

namespace wellspring::show {

class LitLawns {
 public:
  // Lets the exhibit's lawns grow on what stands still in the world.
  void begin(const Exhibit& exhibit, const World& world);
  // Takes the same lawns, with no blade bent, in the wind of its first moment.
  void begin(const LitLawns& grown);
  // Goes to a time, at which these walk. Wind and trails stand still until it is called.
  void step(double time, const Walkers& walkers);
  // Shows them in this light from now on. The last few lights are kept. `more`: as
  // make_lawn_light() has it; `hour`: the same hour has the same of these.
  void light(const World& world, const Lights& lights, const Technique& technique,
             std::span<const PunctualLight> more = {}, std::optional<double> hour = {});

  std::span<const ShownLawn> shown() const { return shown_; }
  bool moves() const;  // whether wind or a trail moves some blade

 private:
  struct Known {
    std::shared_ptr<const IlluminationMap> maps;
    std::shared_ptr<const LightTables> tables;
    std::optional<double> hour;
    std::vector<std::shared_ptr<const LawnLight>> lights;  // one for each lawn
  };
  void show(std::span<const ShownLawn> lawns);

  std::vector<std::shared_ptr<const Lawn>> lawns_;
  std::vector<LawnState> states_;
  std::vector<ShownLawn> shown_;
  std::list<Known> known_;  // the one used last comes first
};

}  // namespace wellspring::show
