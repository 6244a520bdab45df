// SPDX-License-Identifier: Apache-2.0
#include "show/volumes/lit_volumes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <list>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "base/worker.h"
#include "show/exhibit/pieces/exhibit_volumes.h"

namespace wellspring::show {
namespace {

constexpr int turns = 24;         // turns of a volume for which light is kept apart
constexpr size_t most_kept = 64;  // lit presets of an exhibit
constexpr size_t most_lights = 256;

// Names a preset in a light.
struct LitKey {
  int piece = 0, layer = 0, turn = 0, tilt = 0;
  LampLevels lamps;
  bool operator==(const LitKey&) const = default;
};

struct LitPreset {
  LitKey key;
  std::shared_ptr<const DrawnPreset> drawn;
  std::shared_ptr<const ShownVolume> volume;  // null: the piece's own
};

// Holds the light of a room on a volume that is not turned, with those lamps.
struct KnownRoom {
  int piece = 0;
  LampLevels lamps;
  VolumeLight light;
};

struct Wanted {
  LitKey key;
  std::shared_ptr<const ShownVolume> own;     // the layer's; null: the piece's is drawn
  std::shared_ptr<const ShownVolume> volume;  // the piece's
  std::shared_ptr<const PieceNebula> nebula;  // null: it is a scan
  Preset preset;
  VolumeLight light;
};

float step_angle(int turn) { return 2 * pi * float(turn) / float(turns); }
int step_of(float turn) {
  const int step = int(std::lround(turn * float(turns) / (2 * pi))) % turns;
  return step < 0 ? step + turns : step;
}

}  // namespace

struct LitVolumes::Impl {
  std::vector<int> pieces;  // numbers in the exhibit, for each volume of the world
  std::vector<std::shared_ptr<const ShownVolume>> volumes;  // theirs
  std::list<KnownRoom> rooms;
  mutable std::mutex guard;    // guards what follows
  std::list<LitPreset> kept;   // the one used last comes first
  std::vector<Wanted> wanted;  // at most one a piece and layer: the newest
  bool working = false;        // the worker goes on until nothing is wanted
  std::atomic<uint64_t> made{0};
  Worker worker;  // the last member: it is waited for before the others end

  VolumeLight light_of(int number, const Lights& lights, const Technique& technique, World& world);
  std::optional<LitPreset> find(const LitKey& key);
  std::optional<LitPreset> find_like(const LitKey& key) const;
  std::shared_ptr<const ShownVolume> find_tilted(const LitKey& key) const;
  void keep(LitPreset made);
  void want(Wanted wish);
  void make_wanted();
};

// Returns the light that falls on volume `number` of the world while it is not turned. Its own
// matter is not in the way: a light grid tells that.
VolumeLight LitVolumes::Impl::light_of(int number, const Lights& lights, const Technique& technique,
                                       World& world) {
  const int piece = pieces[size_t(number)];
  for (const KnownRoom& room : rooms)
    if (room.piece == piece && room.lamps == world.lamp_levels()) return room.light;
  const VolumeLook look = world.volumes()[size_t(number)].look;
  world.show_volume(number, {});
  const VolumeLight light = room_light(world, lights, technique, world.volumes()[size_t(number)]);
  world.show_volume(number, look);
  rooms.push_front({piece, world.lamp_levels(), light});
  if (rooms.size() > most_lights) rooms.pop_back();
  return light;
}

std::optional<LitPreset> LitVolumes::Impl::find(const LitKey& key) {
  std::lock_guard lock(guard);
  const auto found = std::ranges::find(kept, key, &LitPreset::key);
  if (found == kept.end()) return {};
  kept.splice(kept.begin(), kept, found);
  return *found;
}

// Returns the same preset in another light, that of the same lamps first.
std::optional<LitPreset> LitVolumes::Impl::find_like(const LitKey& key) const {
  std::lock_guard lock(guard);
  const LitPreset* other = nullptr;
  for (const LitPreset& one : kept) {
    if (one.key.piece != key.piece || one.key.layer != key.layer) continue;
    if (one.key.lamps == key.lamps && one.key.tilt == key.tilt) return one;
    if (!other) other = &one;
  }
  return other ? std::optional(*other) : std::nullopt;
}

// Returns the nebula's volume of that tilt, if it was made for another preset or light.
std::shared_ptr<const ShownVolume> LitVolumes::Impl::find_tilted(const LitKey& key) const {
  std::lock_guard lock(guard);
  for (const LitPreset& one : kept)
    if (one.key.piece == key.piece && one.key.tilt == key.tilt) return one.volume;
  return {};
}

void LitVolumes::Impl::keep(LitPreset made_now) {
  std::lock_guard lock(guard);
  kept.push_front(std::move(made_now));
  if (kept.size() > most_kept) kept.pop_back();
  made++;
}

void LitVolumes::Impl::want(Wanted wish) {
  bool begins = false;
  {
    std::lock_guard lock(guard);
    const auto same = std::ranges::find_if(wanted, [&](const Wanted& one) {
      return one.key.piece == wish.key.piece && one.key.layer == wish.key.layer;
    });
    if (same != wanted.end()) *same = std::move(wish);
    else wanted.push_back(std::move(wish));
    begins = !std::exchange(working, true);
  }
  if (begins) worker.run([this] { make_wanted(); });
}

void LitVolumes::Impl::make_wanted() {
  while (true) {
    std::optional<Wanted> next;
    {
      std::lock_guard lock(guard);
      if (wanted.empty()) {
        working = false;
        return;
      }
      next = std::move(wanted.front());
      wanted.erase(wanted.begin());
    }
    if (find(next->key)) continue;
    std::shared_ptr<const ShownVolume> volume = next->own;
    if (next->nebula && next->key.tilt != 0) {
      volume = find_tilted(next->key);
      if (!volume) volume = solve_nebula(*next->nebula, glm::radians(float(next->key.tilt)));
    }
    keep({next->key,
          std::make_shared<const DrawnPreset>(volume ? *volume : *next->volume, next->preset,
                                              next->light),
          volume});
  }
}

LitVolumes::LitVolumes() : impl_(std::make_unique<Impl>()) {}
LitVolumes::~LitVolumes() = default;

void LitVolumes::begin(const Exhibit& exhibit, const Lights& lights, const Technique& technique,
                       World& world) {
  std::vector<PlacedVolume> placed;
  for (size_t i = 0; i < exhibit.pieces.size(); i++) {
    const ExhibitPiece& piece = exhibit.pieces[i];
    if (!piece.volume || piece.layers.empty()) continue;
    impl_->pieces.push_back(int(i));
    impl_->volumes.push_back(piece.volume);
    placed.push_back(place_volume(exhibit, piece));
  }
  world.place_volumes(std::move(placed));
  if (impl_->pieces.empty()) return;
  show(exhibit, {}, lights, technique, world);
  wait();
  show(exhibit, {}, lights, technique, world);
}

void LitVolumes::show(const Exhibit& exhibit, const PieceChoices& choices, const Lights& lights,
                      const Technique& technique, World& world) {
  for (size_t i = 0; i < impl_->pieces.size(); i++) {
    const int number = impl_->pieces[i];
    const ExhibitPiece& piece = exhibit.pieces[size_t(number)];
    const PieceChoice choice = choice_of(choices, size_t(number));
    const PlacedVolume& placed = world.volumes()[i];
    // A look that is not made yet is wanted, and the one before stays meanwhile.
    auto lit = [&](int layer) {
      const LitKey key{number, layer, step_of(choice.turn), choice.tilt, world.lamp_levels()};
      if (auto found = impl_->find(key)) return found;
      VolumeLight light = impl_->light_of(int(i), lights, technique, world);
      light.to_lamp =
          mat3(glm::rotate(mat4(1), -step_angle(key.turn), vec3(0, 1, 0))) * light.to_lamp;
      const PieceLayer& of = piece.layers[size_t(layer)];
      impl_->want({key, of.volume, piece.volume, piece.nebula, *of.preset, light});
      return impl_->find_like(key);
    };
    VolumeLook look = placed.look;
    if (const auto found = lit(choice.layer))
      look.preset = found->drawn, look.volume = found->volume;
    look.over = nullptr, look.share = 0;
    if (choice.by != Blend::none && choice.over != choice.layer)
      // Both are seen of one volume.
      if (const auto over = lit(choice.over); over && over->volume == look.volume)
        look.over = over->drawn, look.share = choice.share;
    look.cuts = cuts_of(box_of(*piece.volume), piece.scale, choice);
    look.turn = choice.turn;
    if (!(look == placed.look)) world.show_volume(int(i), std::move(look));
  }
}

void LitVolumes::wait() { impl_->worker.wait(); }

uint64_t LitVolumes::arrivals() const {
  uint64_t sum = impl_->made;
  for (const auto& volume : impl_->volumes) sum += volume->arrivals();
  return sum;
}

}  // namespace wellspring::show
