// SPDX-License-Identifier: Apache-2.0
#include "show/workers/workshop.h"

#include <algorithm>
#include <filesystem>

#include "base/clock.h"
#include "base/log.h"
#include "base/write_file.h"
#include "light/kept/bake_file.h"
#include "light/kept/map_file.h"
#include "light/technique/technique.h"
#include "show/state/lamps.h"
#include "show/workers/world_state.h"

namespace wellspring::show {

namespace {
constexpr double ask_again = 2, fetch_again = 10;  // seconds
constexpr int most_files = 2;                      // CrewSettings::map_files
}  // namespace

Workshop::Workshop(std::string version, std::string worker, std::string cache)
    : version_(std::move(version)), worker_(std::move(worker)), cache_(std::move(cache)) {}

void Workshop::add(std::unique_ptr<Show> show) {
  Room room;
  room.scene = number_scene(show->stage);
  room.light = number_light(known_maps(show->stage).get());
  room.show = std::move(show);
  rooms_.push_back(std::move(room));
}

Refusal Workshop::prepare(const TraceOrder& order, double waited, Room*& room) {
  if (order.same.version != version_) return Refusal::version;
  if (order.same.instructions != instruction_set()) return Refusal::instructions;
  const auto found = std::ranges::find_if(
      rooms_, [&](const Room& one) { return one.show->stage.exhibit.id == order.exhibit; });
  if (found == rooms_.end()) return Refusal::exhibit;
  room = &*found;
  if (order.same.scene != room->scene) return Refusal::scene;
  if (order.same.light != room->light) {
    begin_fetch(order, *room);
    return Refusal::light;
  }
  const ExhibitStage& stage = room->show->stage;
  const Technique* technique = find_technique(order.technique);
  const bool is_prepared = technique && (!technique->prepare || technique == stage.technique ||
                                         technique == stage.still_technique);
  if (!is_prepared || technique->begin_pass) return Refusal::technique;
  if (1000 * waited > order.worth_ms) return Refusal::late;
  if (!room->state.empty() && order.state == room->state) return Refusal::none;
  if (!put_world_state(order.state, room->show->stage, room->show->cast)) return Refusal::state;
  room->state = order.state;
  return Refusal::none;
}

void Workshop::begin_fetch(const TraceOrder& order, const Room& room) {
  const double now = seconds_now();
  if (order.same.light == 0 || fetch_.next.light != 0 || now - fetch_.ended < fetch_again) return;
  fetch_ = {{order.server, order.same.light, 0, 0}, size_t(&room - rooms_.data()), {}, -1e9, -1e9};
}

std::optional<MapQuestion> Workshop::ask_for_maps(double now) {
  if (fetch_.next.light == 0 || now - fetch_.asked < ask_again) return std::nullopt;
  fetch_.asked = now;
  return fetch_.next;
}

void Workshop::take(const MapPart& part) {
  MapQuestion& next = fetch_.next;
  if (next.light == 0 || part.server != next.server || part.light != next.light ||
      part.which != next.which || part.offset != next.offset)
    return;
  fetch_.bytes += part.bytes;
  next.offset = fetch_.bytes.size();
  fetch_.asked = -1e9;
  if (next.offset < part.size && !part.bytes.empty()) return;
  if (use_fetched() || ++next.which == most_files) next.light = 0, fetch_.ended = seconds_now();
  next.offset = 0;
  fetch_.bytes.clear();
}

// Returns whether these are the maps that orders name.
bool Workshop::use_fetched() {
  if (fetch_.bytes.empty()) return false;
  Room& room = rooms_[fetch_.room];
  ExhibitStage& stage = room.show->stage;
  const std::string file = cache_ + "/" + stage.exhibit.id + "." + worker_ + ".maps";
  try {
    std::filesystem::create_directories(cache_);
    write_file(file, std::span<const char>(fetch_.bytes));
  } catch (const std::exception& error) {
    log::warn("maps cannot be kept: {}", error.what());
    return false;
  }
  const LoadedMap loaded = load_map(*stage.world, file, hash_scene(stage.exhibit.scene));
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (!loaded.map || number_light(loaded.map.get()) != fetch_.next.light) return false;
  use_better_maps(stage, room.show->visits, loaded.map);
  room.light = fetch_.next.light;
  room.state.clear();
  log::info("illumination maps of '{}' came from its server: {} bytes", stage.exhibit.id,
            fetch_.bytes.size());
  return true;
}

TraceAnswer Workshop::answer(const TraceOrder& order, double waited) {
  TraceAnswer answer{order.server, order.number, worker_, Refusal::none, float(waited), 0, {}};
  Room* room = nullptr;
  answer.refusal = prepare(order, waited, room);
  if (answer.refusal != Refusal::none) return answer;
  const double began = seconds_now();
  answer.samples.resize(order.requests.size());
  trace(*find_technique(order.technique), *room->show->stage.world, room->show->stage.lights,
        order.transport, order.requests, answer.samples);
  answer.traced = float(seconds_now() - began);
  return answer;
}

}  // namespace wellspring::show
