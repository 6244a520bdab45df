// SPDX-License-Identifier: Apache-2.0
#include "show/lawns/lit_lawns.h"

#include <algorithm>

#include "base/log.h"
#include "show/exhibit/pieces/exhibit_lawns.h"

namespace wellspring::show {
namespace {

constexpr size_t most_known = 6;  // lights

Bounds bounds_of(const Lawn& lawn) {
  Bounds bounds;
  for (const LawnTile& tile : lawn.tile)
    if (tile.count > 0)
      bounds.low = min(bounds.low, tile.low), bounds.high = max(bounds.high, tile.high);
  return bounds;
}

}  // namespace

void LitLawns::begin(const Exhibit& exhibit, const World& world) {
  lawns_.clear();
  std::vector<ShownLawn> lawns;
  for (const ExhibitLawn& one : exhibit.lawns) {
    lawns_.push_back(grow_lawn(one, world));
    if (lawns_.back()->blades == 0)
      log::warn("exhibit '{}': no ground for lawn '{}'", exhibit.id, one.id);
    ShownLawn shown;
    shown.wind = one.wind, shown.object = one.object;
    lawns.push_back(shown);
  }
  show(lawns);
}

void LitLawns::begin(const LitLawns& grown) {
  lawns_ = grown.lawns_;
  show(grown.shown_);
}

void LitLawns::show(std::span<const ShownLawn> lawns) {
  states_.clear();
  for (const auto& one : lawns_) states_.push_back(make_lawn_state(*one));
  shown_.assign(lawns.begin(), lawns.end());
  for (size_t i = 0; i < shown_.size(); i++) {
    shown_[i].lawn = lawns_[i].get(), shown_[i].state = &states_[i];
    shown_[i].bounds = bounds_of(*lawns_[i]), shown_[i].light = nullptr;
  }
}

void LitLawns::step(double time, const Walkers& walkers) {
  for (size_t i = 0; i < shown_.size(); i++) {
    const bool moved = shown_[i].wind.strength > 0 || !states_[i].active.empty();
    step_lawn(states_[i], *lawns_[i], shown_[i].wind, walkers, time);
    if (moved || !states_[i].active.empty()) shown_[i].moment++;
  }
}

void LitLawns::light(const World& world, const Lights& lights, const Technique& technique,
                     std::span<const PunctualLight> more, std::optional<double> hour) {
  if (shown_.empty()) return;
  const auto& maps = lights.maps ? lights.maps : lights.known;
  auto same = [&](const Known& one) {
    return one.maps == maps && one.tables == lights.tables && one.hour == hour;
  };
  const auto found = std::ranges::find_if(known_, same);
  if (found == known_.end()) {
    Known known{maps, lights.tables, hour, {}};
    for (const auto& one : lawns_)
      known.lights.push_back(make_lawn_light(world, lights, technique, *one, more));
    known_.push_front(std::move(known));
    if (known_.size() > most_known) known_.pop_back();
  } else {
    known_.splice(known_.begin(), known_, found);
  }
  for (size_t i = 0; i < shown_.size(); i++) shown_[i].light = known_.front().lights[i];
}

bool LitLawns::moves() const {
  for (size_t i = 0; i < shown_.size(); i++)
    if (lawns_[i]->blades > 0 && (shown_[i].wind.strength > 0 || !states_[i].active.empty()))
      return true;
  return false;
}

}  // namespace wellspring::show
