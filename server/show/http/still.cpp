// SPDX-License-Identifier: Apache-2.0
#include "show/http/still.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <oneapi/tbb/task_arena.h>
#include <optional>
#include <shared_mutex>
#include <thread>
#include <vector>

#include "denoise/denoise.h"
#include "frame/frame.h"
#include "frame/tonemap.h"
#include "image/image.h"
#include "light/kept/binned_light.h"
#include "light/technique/technique.h"
#include "light/visible/guides.h"
#include "picture/laid_view.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/pieces/exhibit_scans.h"
#include "show/exhibit/pieces/exhibit_volumes.h"
#include "show/lawns/lit_lawns.h"
#include "show/lens/lens.h"
#include "show/state/renderer.h"
#include "show/state/show.h"
#include "show/workers/away_still.h"
#include "show/workers/world_state.h"
#include "wire/limits.h"

namespace wellspring::show {
namespace {
constexpr size_t most_stills_bytes = size_t(16) << 20;
constexpr int still_jpeg_quality = 90;
constexpr NetSize still_net = NetSize::base;
constexpr int laid_places = 16;  // places in a pixel at which what is laid over is seen
constexpr int most_brick_rounds = 20;
constexpr auto time_of_bricks = std::chrono::milliseconds(20);
constexpr double slice = 0.02;  // seconds of the network, between looks whether it is given up
// Ends the loops of a picture that nobody waits for any more.
struct GivenUp {};

}  // namespace

// Holds what pictures are made from.
struct StillRoom::Scenery {
  Scenery(const Show& show, std::function<double()> clock);
  std::optional<Frame> trace(const View& view, const StillJob& order, double seconds,
                             const std::function<bool()>& given_up, StillCosts& costs) const;
  std::vector<Sample> trace_piece(const cache::Piece& piece) const;
  View view_of(const StillJob& order) const;
  std::optional<Frame> render(const StillJob& order, const View& view,
                              const std::function<bool()>& given_up, double denoise_seconds,
                              StillCosts& costs, StillPicture& picture) const;
  // Does the same with nothing laid over.
  std::optional<Frame> reconstruct(const StillJob& order, const View& view,
                                   const std::function<bool()>& given_up, double denoise_seconds,
                                   StillCosts& costs, StillPicture& picture) const;
  void lay_over(const View& view, const std::function<bool()>& given_up, Frame& frame) const;
  bool add_glass(StillJob order, const std::function<bool()>& given_up, double denoise_seconds,
                 StillCosts& costs, StillPicture& picture, Image8& image) const;
  std::string comment(const StillPicture& picture) const;
  // Puts what is chosen of pieces into the world; nobody else may look at it then.
  void show_chosen(const PieceChoices& choices) const;

  const Exhibit& exhibit;
  const Technique* technique;
  TransportSettings transport;
  std::string weights;
  std::unique_ptr<World> world;
  Lights lights;
  AwayScene away;  // workers are told this
  std::function<double()> clock;
  mutable LitVolumes volumes;
  LitLawns lawns;
  // Pictures that show other pieces than at first have the world alone.
  mutable std::shared_mutex looks;
};

StillRoom::StillRoom(const Show& show, std::function<double()> clock)
    : scenery_(std::make_unique<Scenery>(show, std::move(clock))) {}

StillRoom::~StillRoom() = default;
bool StillRoom::denoises() const { return !scenery_->weights.empty(); }

StillRoom::Scenery::Scenery(const Show& show, std::function<double()> given_clock)
    : exhibit(show.stage.exhibit),
      technique(show.stage.lights.known ? show.stage.technique : show.stage.still_technique),
      transport(show.settings.transport),
      weights(show.settings.weights),
      clock(std::move(given_clock)) {
  // The moving meshes as they are now: at the show's start.
  const World& before = *show.stage.world;
  std::vector<Mesh> moving;
  std::vector<uint32_t> moving_object;
  const int first = int(exhibit.scene.instances.size()), count = before.instance_count();
  for (int i = first; i < count; i++) {
    moving.push_back(before.mesh_of(uint32_t(i)));
    moving_object.push_back(before.object_of(uint32_t(i)));
  }
  world = std::make_unique<World>(exhibit.scene, std::move(moving), std::move(moving_object));
  for (int i = first; i < count; i++) world->show(i - first, before.is_visible(uint32_t(i)));
  world->commit();
  const LampLevels levels = first_levels(exhibit);
  const std::vector<vec3> factors = lamp_factors(exhibit.scene, levels);
  for (size_t i = 0; i < levels.size(); i++) world->set_lamp(int(i), levels[i]);
  std::vector<PunctualLight> moving_lights;  // as they are at the show's start, too
  for (const ChangingLight& light : exhibit.lights) {
    moving_lights.push_back(eval_light(light, 0));
    if (light.lamp >= 0) moving_lights.back().intensity *= factors[size_t(light.lamp)];
  }
  lights = make_lights(*world, moving_lights);
  lights.lamps_seen = show.stage.lights.lamps_seen;
  lights.known = show.stage.lights.known;
  if (const auto& all = show.stage.switches.all.known; all && !levels.empty())
    lights.known = relit(*all, find_layer_colors(exhibit.scene, levels));
  if (!lights.known) transport.clamp = 0;  // it is the reference
  away = {show.drawing->workers.crew.get(), write_world_state(show.stage, show.cast, {}),
          number_light(known_maps(show.stage).get())};
  volumes.begin(exhibit, lights, *technique, *world), place_scans(exhibit, *world);
  lawns.begin(show.stage.lawns), lawns.light(*world, lights, *technique);
}

void StillRoom::Scenery::show_chosen(const PieceChoices& choices) const {
  show_pieces(exhibit, {choices, ""}, *world);
  const uint64_t before = volumes.arrivals();
  volumes.show(exhibit, choices, lights, *technique, *world);
  volumes.wait();
  if (volumes.arrivals() != before) volumes.show(exhibit, choices, lights, *technique, *world);
}

// One sample a pixel, and as many more as there is time for by what that took.
std::optional<Frame> StillRoom::Scenery::trace(const View& view, const StillJob& order,
                                               double seconds,
                                               const std::function<bool()>& given_up,
                                               StillCosts& costs) const {
  StillSettings settings;
  settings.spp = 1;
  settings.transport = transport;
  settings.progress = [&](double) {
    if (given_up && given_up()) throw GivenUp{};
  };
  fetch_pieces(*world, lights, view);
  const double began = clock();
  Frame frame;
  try {
    frame = render_still(*technique, *world, lights, view, settings);
    const double each = clock() - began;
    const int most = order.spp > 0 ? order.spp : max_still_spp;
    const double fit = each > 0 ? (seconds - each) / each : most;
    const int more = int(std::clamp(fit, 0.0, double(most - 1)));
    if (more > 0) {
      static const AwayScene nobody;
      const bool as_at_first = order.pieces.empty() && !order.lens.at;
      AwayStill elsewhere(as_at_first ? away : nobody, view, {technique, transport},
                          most - 1 - more,
                          [&](const cache::Piece& piece) { return trace_piece(piece); });
      settings.progress = [&](double) {
        if (given_up && given_up()) throw GivenUp{};
        elsewhere.ask();
      };
      settings.spp = more;
      settings.seed++;
      const Frame others = render_still(*technique, *world, lights, view, settings);
      for (size_t i = 0; i < frame.color.size(); i++)
        frame.color[i] = (frame.color[i] + float(more) * others.color[i]) / float(1 + more);
      costs.elsewhere = int(elsewhere.add_to(frame, 1 + more)) - (1 + more);
    }
    costs.spp = 1 + more;
  } catch (const GivenUp&) {}
  costs.trace_seconds = clock() - began;
  if (costs.spp == 0) return {};
  return frame;
}

std::vector<Sample> StillRoom::Scenery::trace_piece(const cache::Piece& piece) const {
  std::vector<Sample> samples(piece.requests.size());
  light::trace(*technique, *world, lights, piece.order.transport, piece.requests, samples);
  return samples;
}

View StillRoom::Scenery::view_of(const StillJob& order) const {
  Viewpoint at = exhibit.viewpoints[size_t(order.viewpoint)].view;
  at.position = order.position.value_or(at.position);
  at.yaw = order.yaw.value_or(at.yaw);
  at.pitch = order.pitch.value_or(at.pitch);
  at.roll = order.roll.value_or(at.roll);
  at.fov = order.fov.value_or(at.fov);
  return make_view(exhibit.scene, at, order.width, order.height);
}

std::optional<Frame> StillRoom::Scenery::render(const StillJob& order, const View& view,
                                                const std::function<bool()>& given_up,
                                                double denoise_seconds, StillCosts& costs,
                                                StillPicture& picture) const {
  auto frame = reconstruct(order, view, given_up, denoise_seconds, costs, picture);
  if (frame) lay_over(view, given_up, *frame);
  return frame;
}

// Lays over what is no mesh; waits for bricks that volumes lack, as long as any come.
void StillRoom::Scenery::lay_over(const View& view, const std::function<bool()>& given_up,
                                  Frame& frame) const {
  const bool bricks = std::ranges::any_of(
      world->volumes(), [](const PlacedVolume& one) { return one.shown().bricks != nullptr; });
  LaidWork work;
  for (int round = bricks ? 0 : 1;; round++) {
    Frame laid = frame;
    const uint64_t before = volumes.arrivals();
    LaidLayer().lay_over(
        laid_things(*world, &lights, lights.known, exhibit.exposure, lawns.shown()), view,
        round == 0 ? 1 : laid_places, work, laid);
    if (round == 0) std::this_thread::sleep_for(time_of_bricks);
    const bool more = volumes.arrivals() != before || round == 0;
    if (more && round < most_brick_rounds && !(given_up && given_up())) continue;
    frame = std::move(laid);
    return;
  }
}

std::optional<Frame> StillRoom::Scenery::reconstruct(const StillJob& order, const View& view,
                                                     const std::function<bool()>& given_up,
                                                     double denoise_seconds, StillCosts& costs,
                                                     StillPicture& picture) const {
  auto frame = trace(view, order, order.seconds - denoise_seconds, given_up, costs);
  if (!frame) return {};
  picture.spp = costs.spp + costs.elsewhere;
  if (!order.denoise) return frame;
  const double began = clock();
  std::string problem;
  auto denoiser = !weights.empty() ? load_denoiser(still_net, problem, weights) : nullptr;
  if (!denoiser) {
    picture.denoised = StillPicture::Denoised::no_weights;
    return frame;
  }
  GuidePlanes guides = make_guides(*world, lights, view);
  denoiser->start({view.width, view.height, frame->color, guides.albedo, guides.normal});
  while (denoiser->advance(slice))
    if (given_up && given_up()) return {};
  denoiser->finish(frame->color);
  costs.denoise_seconds = clock() - began;
  picture.denoised = StillPicture::Denoised::yes;
  return frame;
}

// Lays a round picture of two radii a side, with a ring around it, over the middle of the glass.
static void lay_glass(const Image8& glass, vec2 middle, Image8& image) {
  constexpr float ring = 0.03f;  // share of the radius
  constexpr uint8_t gold[] = {217, 179, 106};
  const float radius = 0.5f * float(glass.width);
  const int left = int(middle.x - radius), top = int(middle.y - radius);
  for (int y = std::max(0, -top); y < std::min(glass.height, image.height - top); y++)
    for (int x = std::max(0, -left); x < std::min(glass.width, image.width - left); x++) {
      const float off = glm::length(vec2(float(x) + 0.5f, float(y) + 0.5f) - radius) / radius;
      if (off > 1) continue;
      const uint8_t* from =
          off > 1 - ring ? gold : &glass.rgb[3 * (size_t(y) * size_t(glass.width) + size_t(x))];
      std::copy_n(from, 3,
                  &image.rgb[3 * (size_t(y + top) * size_t(image.width) + size_t(x + left))]);
    }
}

// Returns false if the picture was given up.
bool StillRoom::Scenery::add_glass(StillJob order, const std::function<bool()>& given_up,
                                   double denoise_seconds, StillCosts& costs, StillPicture& picture,
                                   Image8& image) const {
  const View whole = view_of(order);
  if (!look_through(exhibit, order.lens, order.pieces).empty()) return true;
  if (order.lens.depth > 0)
    cut_ahead(exhibit, order.lens, lens_ray(whole, order.lens), order.pieces);
  show_chosen(order.pieces);
  const View view = lens_view(whole, order.lens, zoom_of(*world, whole, order.lens), 2);
  const double share = double(view.width) * view.height / order.pixels();
  order.seconds *= share;
  StillCosts spent;
  const auto frame = render(order, view, given_up, share * denoise_seconds, spent, picture);
  costs.trace_seconds += spent.trace_seconds, costs.denoise_seconds += spent.denoise_seconds;
  if (!frame) return false;
  Image8 glass;
  tonemap(*frame, Tonemap{exhibit.exposure}, glass);
  lay_glass(glass, *order.lens.at * vec2(float(image.width), float(image.height)), image);
  return true;
}

std::string StillRoom::Scenery::comment(const StillPicture& picture) const {
  const std::string samples =
      std::to_string(picture.spp) + " samples a pixel by " + technique->name;
  switch (picture.denoised) {
    case StillPicture::Denoised::yes:
      return samples + ", denoised by the network " + net_name(still_net);
    case StillPicture::Denoised::no_weights:
      return samples + ", not denoised: the network's weights are missing";
    default: return samples + ", not denoised";
  }
}

StillCosts StillRoom::measure(const StillJob& order) {
  StillCosts costs;
  StillPicture picture;
  oneapi::tbb::task_arena arena(1, 1, oneapi::tbb::task_arena::priority::low);
  arena.execute([&] {
    const View view = scenery_->view_of(order);
    scenery_->render(order, view, {}, 0, costs, picture);  // brings what the measured one needs
    scenery_->render(order, view, {}, 0, costs, picture);
  });
  return costs;
}

std::optional<StillPicture> StillRoom::find(const StillJob& order) {
  std::lock_guard lock(mutex_);
  auto found = std::ranges::find(kept_, order, &Kept::order);
  if (found == kept_.end()) return {};
  kept_.splice(kept_.begin(), kept_, found);
  return kept_.front().picture;
}

StillPicture StillRoom::make(const StillJob& order, const std::function<bool()>& given_up,
                             int cores, double denoise_seconds, StillCosts* costs) {
  if (auto kept = find(order)) return *kept;
  std::vector<uint8_t> bytes;
  StillCosts spent;
  oneapi::tbb::task_arena arena(cores, 1, oneapi::tbb::task_arena::priority::low);
  StillPicture picture;
  const Exhibit& exhibit = scenery_->exhibit;
  const bool others = !order.pieces.empty() || order.lens.at;
  std::unique_lock alone(scenery_->looks, std::defer_lock);
  std::shared_lock together(scenery_->looks, std::defer_lock);
  if (others) alone.lock();
  else together.lock();
  if (others) scenery_->show_chosen(order.pieces);
  arena.execute([&] {
    const std::optional<Frame> frame = scenery_->render(order, scenery_->view_of(order), given_up,
                                                        denoise_seconds, spent, picture);
    if (!frame) return;
    Image8 image;
    tonemap(*frame, Tonemap{exhibit.exposure}, image);
    if (order.lens.at &&
        !scenery_->add_glass(order, given_up, denoise_seconds, spent, picture, image))
      return;
    encode_jpeg(image, still_jpeg_quality, true, bytes);
    add_jpeg_comment(scenery_->comment(picture), bytes);
  });
  if (others) scenery_->show_chosen({});
  if (costs) *costs = spent;
  if (bytes.empty()) return {};
  picture.jpeg.assign(bytes.begin(), bytes.end());
  std::lock_guard lock(mutex_);
  kept_.push_front({order, std::move(picture)});
  size_t kept_bytes = 0;
  for (const Kept& kept : kept_) kept_bytes += kept.picture.jpeg.size();
  for (; kept_.size() > 1 && kept_bytes > most_stills_bytes; kept_.pop_back())
    kept_bytes -= kept_.back().picture.jpeg.size();
  return kept_.front().picture;
}

}  // namespace wellspring::show
