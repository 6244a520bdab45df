// SPDX-License-Identifier: Apache-2.0
#include "show/workers/workshop.h"

#include <algorithm>

#include "base/clock.h"
#include "base/log.h"
#include "light/kept/bake_file.h"
#include "light/kept/map_file.h"
#include "light/technique/technique.h"
#include "show/exhibit/json_fields.h"
#include "show/state/lamps.h"
#include "show/workers/world_state.h"

namespace wellspring::show {

namespace {

constexpr size_t most_fetched = 3;  // exhibits in memory

}  // namespace

Workshop::Workshop(std::string version, std::string worker, const std::string& cache,
                   uint64_t most_bytes, LoadShow load)
    : version_(std::move(version)),
      worker_(std::move(worker)),
      load_(std::move(load)),
      fetch_(cache + "/packages", most_bytes) {}

void Workshop::add(const std::string& folder, const std::string& cache) {
  add_room(load_(folder, cache), "");
}

void Workshop::add_room(std::unique_ptr<Show> show, std::string from) {
  const auto is_old = [&](const Room& one) { return !one.from.empty(); };
  if (!from.empty() && std::ranges::count_if(rooms_, is_old) >= int(most_fetched)) {
    const auto oldest = std::ranges::min_element(
        rooms_, {}, [&](const Room& one) { return is_old(one) ? one.used : 1e300; });
    rooms_.erase(oldest);
  }
  Room room;
  room.scene = number_scene(show->stage);
  room.light = number_light(known_maps(show->stage).get());
  room.show = std::move(show);
  room.from = std::move(from);
  room.used = seconds_now();
  rooms_.push_back(std::move(room));
}

Refusal Workshop::prepare(const TraceOrder& order, double waited, Room*& room) {
  if (order.same.version != version_) return Refusal::version;
  if (order.exact && order.same.instructions != instruction_set()) return Refusal::instructions;
  const auto is_of = [&](const Room& one) { return one.show->stage.exhibit.id == order.exhibit; };
  const auto found = std::ranges::find_if(
      rooms_, [&](const Room& one) { return is_of(one) && one.scene == order.same.scene; });
  if (found == rooms_.end())
    return begin_fetch(order, PackageFetch::What::package,
                       std::ranges::any_of(rooms_, is_of) ? Refusal::scene : Refusal::exhibit);
  room = &*found;
  room->used = seconds_now();
  if (order.same.light != room->light)
    return begin_fetch(order, PackageFetch::What::maps, Refusal::light);
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

// Returns what is said of the order: `why`, or that what it needs is on its way.
Refusal Workshop::begin_fetch(const TraceOrder& order, PackageFetch::What what, Refusal why) {
  if (loading_) return loading_->exhibit == order.exhibit ? Refusal::fetching : why;
  const bool maps = what == PackageFetch::What::maps;
  if (maps ? order.same.light == 0 : order.same.scene == other_scene_) return why;
  const bool was_busy = fetch_.busy();
  if (!fetch_.begin(order.server, order.exhibit, what, seconds_now()))
    return fetch_.is_full() ? Refusal::disk : why;
  if (was_busy) return Refusal::fetching;
  for (const Room& room : rooms_)
    if (room.show->stage.exhibit.id == order.exhibit) fetch_.use(room.show->stage.exhibit.folder);
  light_ = order.same.light, scene_ = order.same.scene;
  return why;
}

void Workshop::advance() {
  if (loading_) {
    if (loader_.busy()) return;
    if (!loading_->show) {
      log::warn("'{}' was fetched and cannot be loaded: {}", loading_->exhibit, loading_->problem);
      other_scene_ = scene_;
    } else {
      add_room(std::move(loading_->show), loading_->folder);
      log::info("'{}' is loaded as its server has it", loading_->exhibit);
      if (rooms_.back().scene != scene_) {
        log::warn("'{}': the server shows something else than its files hold", loading_->exhibit);
        other_scene_ = scene_;
      }
    }
    loading_.reset();
  }
  const std::optional<PackageFetch::Result> fetched = fetch_.take_result();
  if (!fetched || !fetched->problem.empty()) return;
  if (fetched->what == PackageFetch::What::maps) return use_maps(*fetched);
  loading_ = Loading{fetched->folder, fetched->exhibit, nullptr, {}};
  loader_.run([this] {
    Loading& now = *loading_;
    try {
      now.show = load_(now.folder + "/" + now.exhibit, now.folder);
    } catch (const ExhibitError& error) {
      for (const Problem& problem : error.problems)
        if (problem.fatal && now.problem.empty()) now.problem = to_string(problem);
    } catch (const std::exception& error) {
      now.problem = error.what();
    }
  });
}

// The maps that orders name may be those of either file.
void Workshop::use_maps(const PackageFetch::Result& fetched) {
  for (Room& room : rooms_) {
    ExhibitStage& stage = room.show->stage;
    if (stage.exhibit.id != fetched.exhibit || room.scene != scene_) continue;
    for (const std::string& file : fetched.maps) {
      const LoadedMap loaded = load_map(*stage.world, file, hash_scene(stage.exhibit.scene));
      if (!loaded.map || number_light(loaded.map.get()) != light_) continue;
      use_better_maps(stage, room.show->visits, loaded.map);
      room.light = light_;
      room.state.clear();
      log::info("illumination maps of '{}' came from its server", fetched.exhibit);
      return;
    }
  }
}

TraceAnswer Workshop::answer(const TraceOrder& order, double waited) {
  TraceAnswer answer{order.server, order.number, worker_, Refusal::none, float(waited), 0, {}};
  Room* room = nullptr;
  answer.refusal = prepare(order, waited, room);
  if (answer.refusal != Refusal::none) return answer;
  const double began = seconds_now();
  answer.samples.resize(order.requests.size());
  Lights lights = room->show->stage.lights;
  if (order.plain) lights.maps.reset();
  trace(*find_technique(order.technique), *room->show->stage.world, lights, order.transport,
        order.requests, answer.samples);
  answer.traced = float(seconds_now() - began);
  return answer;
}

}  // namespace wellspring::show
