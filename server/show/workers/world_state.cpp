// SPDX-License-Identifier: Apache-2.0
#include "show/workers/world_state.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/bytes.h"
#include "base/rng.h"
#include "light/kept/bake_file.h"
#include "light/sample/illumination_map.h"
#include "show/state/lamps.h"
#include "show/state/visitor_world.h"

namespace wellspring::show {
namespace {

constexpr size_t most_lamps = 4096, most_pieces = 4096, most_joints = 2048, most_times = 4096,
                 most_language_bytes = 16;

void put_choice(const PieceChoice& choice, ByteWriter& out) {
  out.put(int32_t(choice.layer)), out.put(int32_t(choice.over)), out.put(uint8_t(choice.by));
  out.put(choice.share), out.put(choice.turn), out.put(choice.low), out.put(choice.high);
  out.put(choice.plane), out.put(choice.glass_plane), out.put(int32_t(choice.tilt));
}

void take_choice(ByteReader& in, PieceChoice& choice) {
  int32_t layer = 0, over = 0, tilt = 0;
  uint8_t by = 0;
  in.take(layer), in.take(over), in.take(by);
  in.take(choice.share), in.take(choice.turn), in.take(choice.low), in.take(choice.high);
  in.take(choice.plane), in.take(choice.glass_plane), in.take(tilt);
  choice.layer = layer, choice.over = over, choice.tilt = tilt, choice.by = Blend(by);
}

void put_pose(const Pose& pose, ByteWriter& out) {
  out.put(pose.translation);
  out.put_all(pose.rotations), out.put_all(pose.displacers);
  out.put_all(pose.translations), out.put_all(pose.stretches);
}

void take_pose(ByteReader& in, Pose& pose) {
  in.take(pose.translation);
  in.take_all(pose.rotations, most_joints), in.take_all(pose.displacers, most_joints);
  in.take_all(pose.translations, most_joints), in.take_all(pose.stretches, most_joints);
}

struct WorldState {
  LampLevels lamps;
  ShownPieces shown;
  PosedBy by;
};

bool read_state(std::string_view bytes, WorldState& state) {
  ByteReader in(bytes);
  in.take_all(state.lamps, most_lamps);
  state.shown.choices.resize(in.take_count(most_pieces, 4));
  for (PieceChoice& choice : state.shown.choices) take_choice(in, choice);
  in.take_text(state.shown.language, most_language_bytes);
  PosedBy& by = state.by;
  uint32_t storyteller = 0;
  uint8_t visible = 0;
  int32_t prop = 0, shown = 0;
  in.take(by.time), in.take(storyteller), in.take(visible);
  take_pose(in, by.pose);
  in.take(by.placement), in.take(prop), in.take(by.held.size), in.take(by.held.glow);
  in.take(by.held.to_world), in.take_all(by.times, most_times), in.take(shown);
  in.take(by.shown.to_world), in.take(by.shown.size), in.take(by.shown.flame);
  by.storyteller = storyteller, by.visible = visible, by.held.prop = prop, by.shown_model = shown;
  return in.ended();
}

bool is_choice(const ExhibitPiece& piece, const PieceChoice& choice) {
  const int layers = std::max(int(piece.layers.size()), 1);
  const auto finite = [](auto v) {
    return glm::all(glm::lessThan(glm::abs(v), decltype(v)(1e6f)));
  };
  return choice.layer >= 0 && choice.layer < layers && choice.over >= 0 && choice.over < layers &&
         choice.by <= Blend::difference && choice.share >= 0 && choice.share <= 1 &&
         finite(vec3(choice.turn, float(std::abs(choice.tilt)), 0)) && finite(choice.low) &&
         finite(choice.high) && finite(choice.plane) && finite(choice.glass_plane) &&
         std::abs(int64_t(choice.tilt)) <= 360;
}

// Returns whether all of these numbers are finite and of a usual size.
bool are_usual(const void* numbers, size_t count) {
  const auto* all = static_cast<const float*>(numbers);
  return std::all_of(all, all + count, [](float v) { return std::abs(v) < 1e7f; });
}
template <class T>
bool are_usual(const std::vector<T>& values) {
  return are_usual(values.data(), values.size() * sizeof(T) / sizeof(float));
}

bool are_usual(const PosedBy& by) {
  const Pose& pose = by.pose;
  const float sizes[] = {by.held.size, by.held.glow, by.shown.size, by.shown.flame};
  const auto is_time = [](double time) { return std::abs(time) < 1e9; };
  return are_usual(sizes, 4) && are_usual(&pose.translation, 3) && are_usual(pose.rotations) &&
         are_usual(pose.displacers) && are_usual(pose.translations) && are_usual(pose.stretches) &&
         are_usual(&by.placement, 16) && are_usual(&by.held.to_world, 16) &&
         are_usual(&by.shown.to_world, 16) && is_time(by.time) &&
         std::ranges::all_of(by.times, is_time);
}

// Returns whether a state is one of this exhibit.
bool fits(const WorldState& state, const ExhibitStage& stage, const ShowCast& cast) {
  const Exhibit& exhibit = stage.exhibit;
  const PosedBy& by = state.by;
  const LampLevels& lamps = state.lamps;
  if (lamps.size() != stage.switches.lit.size()) return false;
  const size_t pieces = state.shown.choices.size();
  if (pieces > 0 && pieces != exhibit.pieces.size()) return false;
  for (size_t i = 0; i < pieces; i++)
    if (!is_choice(exhibit.pieces[i], state.shown.choices[i])) return false;
  const std::string& language = state.shown.language;
  if (!language.empty() && !std::ranges::count(exhibit.piece_languages, language)) return false;
  if (by.times.size() != cast.movers.posed.size()) return false;
  if (!are_usual(by) || by.held.prop >= int(exhibit.props.size()) ||
      by.shown_model >= int(cast.held.size()))
    return false;
  if (cast.figures.empty()) return true;
  if (by.storyteller >= cast.figures.size()) return false;
  const Pose rest = make_rest_pose(exhibit.storytellers[by.storyteller].character);
  const size_t joints = rest.rotations.size();
  const auto none_or_all = [&](size_t count) { return count == 0 || count == joints; };
  return by.pose.rotations.size() == joints &&
         by.pose.displacers.size() == rest.displacers.size() &&
         none_or_all(by.pose.translations.size()) && none_or_all(by.pose.stretches.size());
}

// Mixes bytes into a number, eight at a time.
void mix(const void* data, size_t size, uint64_t& number) {
  const auto* bytes = static_cast<const char*>(data);
  for (size_t i = 0; i < size; i += 8) {
    uint64_t word = 0;
    std::memcpy(&word, bytes + i, std::min<size_t>(size - i, 8));
    number = mix64(number ^ word);
  }
  number = mix64(number ^ size);
}
template <class T>
void mix_all(const std::vector<T>& values, uint64_t& number) {
  mix(values.data(), values.size() * sizeof(T), number);
}

}  // namespace

std::string write_world_state(const ExhibitStage& stage, const ShowCast& cast,
                              const ShownPieces& shown) {
  ByteWriter out;
  out.put_all(stage.switches.lit);
  out.put(uint32_t(shown.choices.size()));
  for (const PieceChoice& choice : shown.choices) put_choice(choice, out);
  out.put_text(shown.language);
  const PosedBy& by = cast.posed_by;
  out.put(by.time), out.put(uint32_t(by.storyteller)), out.put(uint8_t(by.visible));
  put_pose(by.pose, out);
  out.put(by.placement), out.put(int32_t(by.held.prop)), out.put(by.held.size);
  out.put(by.held.glow), out.put(by.held.to_world);
  out.put_all(by.times.empty() ? cast.movers.posed : by.times);  // empty: as they first are
  out.put(int32_t(by.shown_model)), out.put(by.shown.to_world), out.put(by.shown.size);
  out.put(by.shown.flame);
  return std::move(out).bytes();
}

bool put_world_state(std::string_view bytes, ExhibitStage& stage, ShowCast& cast) {
  WorldState state;
  if (!read_state(bytes, state) || !fits(state, stage, cast)) return false;
  light_world(stage, state.lamps);
  show_pieces_of(stage, state.shown);
  PosedBy& by = state.by;
  Teller& teller = cast.teller;
  teller.index = by.storyteller;
  teller.visible = by.visible;
  teller.pose = std::move(by.pose);
  teller.storyteller.placement = by.placement;
  teller.held = by.held;
  pose_world(stage, cast, by.time, teller, by.times, {by.shown_model, by.shown});
  return true;
}

uint64_t number_scene(const ExhibitStage& stage) {
  uint64_t number = hash_scene(stage.exhibit.scene);
  for (int i = 0; i < stage.world->instance_count(); i++) {
    if (!stage.world->is_moving(uint32_t(i))) continue;
    const Mesh& mesh = stage.world->mesh_of(uint32_t(i));
    for (uint64_t count : {uint64_t(mesh.positions.size()), uint64_t(mesh.triangles.size())})
      number = mix64(number ^ count);
  }
  return number;
}

std::shared_ptr<const IlluminationMap> known_maps(const ExhibitStage& stage) {
  const Lights& all = stage.exhibit.lamps.empty() ? stage.lights : stage.switches.all;
  return all.maps ? all.maps : all.known;
}

uint64_t number_light(const IlluminationMap* maps) {
  if (!maps) return 0;
  uint64_t number = maps->tiles.size();
  const auto mix_nodes = [&](const IlluminationNodes& nodes) {
    mix_all(nodes.light, number), mix_all(nodes.slope, number);
  };
  mix_nodes(maps->nodes);
  if (maps->normals) mix_all(*maps->normals, number);
  if (maps->layers)
    for (const IlluminationNodes& nodes : *maps->layers) mix_nodes(nodes);
  mix(&maps->error, sizeof maps->error, number);
  return std::max<uint64_t>(number, 1);
}

SampleBounds sample_bounds(const World& world) {
  SampleBounds bounds{uint32_t(world.scene().objects.size()), {}};
  for (int i = 0; i < world.instance_count(); i++)
    bounds.triangles.push_back(uint32_t(world.mesh_of(uint32_t(i)).triangles.size()));
  return bounds;
}

}  // namespace wellspring::show
