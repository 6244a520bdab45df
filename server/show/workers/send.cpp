// SPDX-License-Identifier: Apache-2.0
#include "show/workers/send.h"

#include <algorithm>

#include "light/technique/technique.h"
#include "picture/still/reconstruct_still.h"
#include "show/state/visitor_picture.h"
#include "show/workers/world_state.h"
#include "workers/crew.h"

namespace wellspring::show {
namespace {

// Differs from the seeds of samples that are traced here, which are numbers of links.
constexpr uint64_t away_sequence = 0x776f726b65727321ull;

Visitor* find_visitor(ShowVisits& visits, uint64_t id) {
  for (Visitor& visitor : visits.visitors)
    if (visitor.link->id == id) return &visitor;
  return nullptr;
}

std::vector<Sample> trace_here(const Show& show, const cache::Piece& piece) {
  std::vector<Sample> samples(piece.requests.size());
  trace(*piece.order.technique, *show.stage.world, show.stage.lights, piece.order.transport,
        piece.requests, samples);
  return samples;
}

}  // namespace

void begin_workers(Show& show) {
  const CrewSettings& settings = show.settings.workers;
  if (settings.channel.url.empty()) return;
  CrewSettings own = settings;
  own.package = show.stage.exhibit.folder;
  if (!show.settings.cache.empty())
    own.maps = show.settings.cache + "/" + show.stage.exhibit.id + ".maps";
  show.drawing->workers.crew =
      std::make_unique<Crew>(std::move(own), show.stage.exhibit.id, number_scene(show.stage),
                             sample_bounds(*show.stage.world));
}

void mind_workers(Show& show) {
  if (Crew* crew = show.drawing->workers.crew.get()) crew->advance();
}

void take_deliveries(Show& show) {
  Crew* crew = show.drawing->workers.crew.get();
  if (!crew) return;
  for (CrewSamples& delivery : crew->take()) {
    Visitor* visitor = find_visitor(show.visits, delivery.asker);
    if (!visitor) continue;
    Broker& broker = delivery.rests ? visitor->picture->away : visitor->picture->broker;
    for (Answer& answer : delivery.answers) broker.answer(std::move(answer));
  }
}

int room_of_workers(const Show& show, bool rests) {
  const Crew* crew = show.drawing->workers.crew.get();
  return crew ? crew->room(rests) : 0;
}

int send_waiting(Show& show, const PictureJob& job, Visitor& visitor, bool rests, int most) {
  ShowCrew& workers = show.drawing->workers;
  if (!workers.crew || most <= 0) return 0;
  if (auto maps = known_maps(show.stage); maps != workers.maps) {
    workers.light = number_light(maps.get());
    workers.maps = std::move(maps);
  }
  const Errand errand{visitor.link->id, rests, show.cast.pose_number,
                      write_world_state(show.stage, show.cast, job.pieces), workers.light};
  Broker& broker = rests ? visitor.picture->away : visitor.picture->broker;
  return workers.crew->send(broker, errand, most,
                            [&](const cache::Piece& piece) { return trace_here(show, piece); });
}

void ask_away(Show& show, const PictureJob& job, const Technique& technique,
              const TransportSettings& transport, DrawingWork& work, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  if (picture.away_view != job.view || picture.away_by != &technique) {
    picture.away.forget();
    picture.away_view = job.view, picture.away_by = &technique;
    picture.away_asked = 0;
  }
  const int most = std::min(job.away, away_requests.most_waiting);
  if (most <= 0 || technique.begin_pass) return;
  work.away.clear();
  plan_still(job.view, picture.away_asked, most, visitor.link->id ^ away_sequence, work.away);
  picture.away_asked += uint64_t(most);
  picture.away.ask(job.view, {&technique, transport}, work.away);
  send_waiting(show, job, visitor, true, most);
}

void add_away(const Show& show, const PictureJob& job, VisitorPicture& picture,
              std::vector<Request>& requests, std::vector<Sample>& samples) {
  for (const Answer& answer : picture.away.collect()) {
    if (answer.piece.view != job.view) continue;
    const size_t before = samples.size();
    requests.insert(requests.end(), answer.piece.requests.begin(), answer.piece.requests.end());
    samples.insert(samples.end(), answer.samples.begin(), answer.samples.end());
    if (answer.pose != show.cast.pose_number)
      follow_meshes(*show.stage.world, std::span(samples).subspan(before));
  }
}

}  // namespace wellspring::show
