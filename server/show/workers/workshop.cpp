// SPDX-License-Identifier: Apache-2.0
#include "show/workers/workshop.h"

#include <algorithm>

#include "base/clock.h"
#include "light/technique/technique.h"
#include "show/workers/world_state.h"

namespace wellspring::show {

Workshop::Workshop(std::string version, std::string worker)
    : version_(std::move(version)), worker_(std::move(worker)) {}

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
  if (order.same.light != room->light) return Refusal::light;
  const ExhibitStage& stage = room->show->stage;
  const Technique* technique = find_technique(order.technique);
  const bool is_prepared = technique && (!technique->prepare || technique == stage.technique ||
                                         technique == stage.still_technique);
  if (!is_prepared || technique->begin_pass) return Refusal::technique;
  if (1000 * waited > order.worth_ms) return Refusal::late;
  if (order.state == room->state) return Refusal::none;
  if (!put_world_state(order.state, room->show->stage, room->show->cast)) return Refusal::state;
  room->state = order.state;
  return Refusal::none;
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
