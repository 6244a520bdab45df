// SPDX-License-Identifier: Apache-2.0
#include "show/draw/late_samples.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "base/clock.h"
#include "cache/broker.h"
#include "light/technique/technique.h"
#include "picture/compose_drawn.h"
#include "picture/still/reconstruct_still.h"
#include "show/draw/decide.h"
#include "show/draw/pace.h"
#include "show/lens/pieces.h"
#include "show/state/renderer.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"
#include "show/state/visitor_world.h"
#include "show/workers/send.h"

namespace wellspring::show {

std::vector<Broker*> request_samples(Show& show) {
  Renderer& renderer = show.drawing->renderer;
  std::vector<Broker*> brokers;
  renderer.seconds = 0;
  Visitor* first = nullptr;  // visitors who see another world wait for the next turn
  for (Visitor& visitor : show.visits.visitors) {
    if (visitor.picture->broker_seconds <= 0) continue;
    if (!first) go_on_in_world_of(show, *(first = &visitor));
    else if (!see_the_same(show.cast, show.visits, *first, visitor)) continue;
    brokers.push_back(&visitor.picture->broker);
    renderer.asking.push_back(visitor.link->id);
    renderer.seconds += std::exchange(visitor.picture->broker_seconds, 0.0);
    visitor.picture->at_work = true;
  }
  return brokers;
}

void trace_samples(const ExhibitStage& stage, const ShowCast& cast,
                   std::span<Broker* const> brokers, Renderer& renderer) {
  std::mutex guard;
  double began = seconds_now();
  renderer.traced = trace_waiting(brokers, *stage.world, stage.lights, cast.pose_number,
                                  began + renderer.seconds, guard);
  renderer.traced_seconds = seconds_now() - began;
}

void finish_samples(Show& show) {
  Renderer& renderer = show.drawing->renderer;
  show.totals.samples += renderer.traced;
  if (renderer.traced > 0 && renderer.traced_seconds > 0)
    smooth(show.drawing->samples_per_second,
           float(double(renderer.traced) / renderer.traced_seconds));
  const double each = renderer.traced_seconds / double(renderer.asking.size());
  for (uint64_t id : std::exchange(renderer.asking, {})) {
    Visitor& visitor = visitor_of(show.visits, id);
    smooth(visitor.times.trace, float(1000 * each));
    visitor.picture->at_work = false;
    visitor.picture->served += each * charge_weight(show.visits, show.time, visitor);
  }
}

namespace {

constexpr float predicted_share = 0.3f;  // share of the samples, at most
constexpr float barely_covered = 0.1f;   // share of the pixels that points cover
constexpr size_t least_slice = 2048;     // number of samples
// Seconds of tracing at a time: the first while it may be given up, the second when moving things
// are due soon.
constexpr double longest_slice = 0.025, least_slice_seconds = 0.006;
constexpr double spread_from = 0.8;  // samples a pixel
constexpr float more_asked = 1.2f;   // times what is measured to fit into the time: no core is idle

// Returns whether answers may come after the picture: a walking visitor is shown those of the
// picture before, and is shown it the sooner. A place never seen yet, or a still camera's picture,
// waits for its own.
bool may_be_late(const ShowSettings& settings, const RenderCache& cache, const Technique& technique,
                 int samples) {
  return settings.late_samples && settings.display != Display::points && !technique.begin_pass &&
         samples <= BrokerSettings{}.most_waiting && cache.covered() > barely_covered;
}

TransportSettings transport_of(const ShowSettings& settings, const PictureJob& job) {
  TransportSettings transport = settings.transport;
  if (!job.settled) transport.clamp = settings.moving_clamp;
  return transport;
}

// Returns whether samples are spread evenly, but for some, aimed at points, to find what changes.
// If pictures are reconstructed, the first samples serve the drawn picture that a reconstruction
// begins with.
bool spreads_samples(const PictureJob& job, const Technique& technique) {
  return job.learns && !technique.begin_pass && job.rest.samples >= spread_from &&
         !has_all_samples(job.rest);
}

// Returns how many samples are traced at a time.
size_t slice_of_samples(const ShowDrawing& drawing) {
  double seconds = std::clamp(drawing.renderer.until_moving, least_slice_seconds, longest_slice);
  return size_t(std::max(seconds * double(drawing.samples_per_second), double(least_slice)));
}

// Returns the same view in as many pixels as there are samples.
View pass_view(const View& view, int samples) {
  const double pixels = double(view.width) * double(view.height);
  const double side = std::sqrt(std::min(std::max(double(samples), 1.0) / pixels, 1.0));
  View pass = view;
  pass.width = std::max(int(view.width * side), 1);
  pass.height = std::max(int(view.height * side), 1);
  return pass;
}

// Requests a sample for each pixel of a pass.
void plan_pass(const View& pass, uint64_t seed, uint32_t index, std::vector<Request>& requests) {
  std::vector<PixelSample> which;
  which.reserve(size_t(pass.width) * size_t(pass.height));
  for (int y = 0; y < pass.height; y++)
    for (int x = 0; x < pass.width; x++) which.push_back({x, y, int(index)});
  requests.resize(which.size());
  make_pixel_requests(pass, seed, which, requests);
}

// Gives requests of a pass the pixels of `view` that their rays run through.
void name_pixels(const View& view, std::vector<Request>& requests) {
  for (Request& request : requests) {
    Projected at = project_point(view, request.ray.origin + request.ray.direction);
    bool inside = at.x >= 0 && at.y >= 0 && at.x < float(view.width) && at.y < float(view.height);
    request.pixel = inside ? uint32_t(at.y) * uint32_t(view.width) + uint32_t(at.x) : no_pixel;
  }
}

void spread_samples(const View& view, int count, Visitor& visitor, std::vector<Request>& requests) {
  VisitorPicture& picture = *visitor.picture;
  uint64_t& asked = picture.costs.asked;
  const PointImage& image = picture.cache.image();
  if (image.weight.empty()) {
    plan_still(view, asked, count, visitor.link->id, requests);
    asked += uint64_t(count);
  } else {
    asked = plan_still(view, asked, count, visitor.link->id, image, picture.compositor.samples(),
                       requests);
  }
}

}  // namespace

void take_answers(const ExhibitStage& stage, const ShowCast& cast, VisitorPicture& picture) {
  land(picture.broker.collect(), *stage.world, cast.pose_number, picture.cache);
}

void plan_samples(Show& show, const PictureJob& job, const Technique& technique, DrawingWork& work,
                  Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  RenderCache& cache = picture.cache;
  follow_lamps(show.stage, visitor);
  follow_pieces(visitor.pieces.shown, picture);
  cache.set_attention(job.attention);
  cache.set_weights(job.weights ? std::span(*job.weights) : std::span<const float>());
  cache.set_reference(job.settled);
  picture.compositor.set_reconstructed(job.learns);
  cache.resize(job.expected.width, job.expected.height);
  cache.move_points(*show.stage.world);
  take_answers(show.stage, show.cast, picture);
  cache.project(job.view);
  if (technique.finish_pass) {
    work.pass = pass_view(job.view, job.samples);
    return plan_pass(work.pass, visitor.link->id, uint32_t(job.tick), work.requests);
  }
  cache.attend();
  const bool still = is_still(job);
  int most_asked = int(more_asked * float(job.samples));
  if (!still) most_asked += std::clamp(BrokerSettings{}.most_waiting - most_asked, 0, job.away);
  bool late = !still && may_be_late(show.settings, cache, technique, most_asked);
  int asked = late ? most_asked : job.samples;
  work.ahead.clear();
  if (job.ahead != job.view && !technique.begin_pass)
    cache.predict(job.ahead, int(predicted_share * float(asked)), job.seed, work.ahead);
  const int planned = asked - int(work.ahead.size());
  const bool spread = spreads_samples(job, technique);
  const int aimed = spread ? samples_to_watch(planned) : planned;
  cache.plan(job.view, aimed, job.seed, work.requests);
  if (spread) spread_samples(job.view, planned - aimed, visitor, work.requests);
  work.requests.insert(work.requests.end(), work.ahead.begin(), work.ahead.end());
  picture.costs.late = late;
}

bool begin_samples(Show& show, const PictureJob& job, const Technique& technique, DrawingWork& work,
                   Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  work.samples.clear();
  work.traced = 0;
  if (picture.costs.late) {
    picture.broker.ask(job.view, {&technique, transport_of(show.settings, job)}, work.requests);
    send_waiting(show, job, visitor, false, job.away);
    return false;
  }
  if (is_still(job))
    ask_away(show, job, technique, transport_of(show.settings, job), work, visitor);
  picture.broker.forget();  // answers that were still on their way
  work.pose = show.cast.pose_number;
  if (technique.begin_pass)
    technique.begin_pass(*show.stage.world, transport_of(show.settings, job),
                         technique.finish_pass ? work.pass : job.view, pass_seed(visitor.link->id),
                         uint32_t(job.tick), show.stage.lights);
  return true;
}

bool trace_slice(Show& show, const PictureJob& job, const Technique& technique, DrawingWork& work) {
  size_t all = work.requests.size(), count = all - work.traced;
  if (!technique.begin_pass) count = std::min(count, slice_of_samples(*show.drawing));
  work.samples.resize(all);
  trace(technique, *show.stage.world, show.stage.lights, transport_of(show.settings, job),
        std::span(work.requests).subspan(work.traced, count),
        std::span(work.samples).subspan(work.traced, count));
  work.traced += count;
  if (technique.finish_pass)
    technique.finish_pass(*show.stage.world, show.stage.lights, work.pass, work.samples);
  return work.traced < all;
}

void remember_traced(const Show& show, const PictureJob& job, const Technique& technique,
                     DrawingWork& work, Visitor& visitor) {
  VisitorPicture& picture = *visitor.picture;
  if (picture.costs.late) return;
  work.requests.resize(work.traced);
  work.samples.resize(work.traced);
  if (technique.finish_pass) name_pixels(job.view, work.requests);
  if (show.cast.pose_number != work.pose) follow_meshes(*show.stage.world, work.samples);
  if (show.settings.display == Display::points)
    for (Sample& sample : work.samples) sample.glow = vec3(0);  // points show all light
  picture.costs.samples = work.samples.size();
  if (is_still(job)) add_away(show, job, picture, work.requests, work.samples);
  picture.cache.remember(job.view, work.requests, work.samples);
  // A picture that is drawn, not reconstructed, has a use for the samples only when it is kept for
  // long.
  if (!is_still(job) || !(job.learns || picture.cache.is_still())) return;
  picture.compositor.follow_changes(picture.cache);
  picture.compositor.add_samples(job.view, work.requests, work.samples);
  picture.costs.kept_samples = mean_count(picture.compositor.samples());
}

}  // namespace wellspring::show
