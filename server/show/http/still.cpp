// SPDX-License-Identifier: Apache-2.0
#include "show/http/still.h"

#include <algorithm>
#include <oneapi/tbb/task_arena.h>

#include "base/clock.h"
#include "denoise/denoise.h"
#include "frame/jpeg.h"
#include "frame/tonemap.h"
#include "light/visible/guides.h"
#include "show/exhibit/exhibit_lamps.h"

namespace wellspring {

namespace {
constexpr size_t most_kept_bytes = size_t(16) << 20;
constexpr int still_jpeg_quality = 90;
constexpr NetSize still_net = NetSize::base;
constexpr double slice = 0.02;  // seconds of the network, between looks whether it is given up
// Ends the loops of a picture that nobody waits for any more.
struct GivenUp {};

}  // namespace

StillRoom::StillRoom(const Show& show)
    : exhibit_(show.exhibit),
      technique_(show.still_technique),
      transport_(show.settings.transport),
      weights_(show.settings.weights) {
  // The moving meshes as they are now: at the show's start.
  std::vector<Mesh> moving;
  std::vector<uint32_t> moving_object;
  const int first = int(exhibit_.scene.instances.size()), count = show.world->instance_count();
  for (int i = first; i < count; i++) {
    moving.push_back(show.world->mesh_of(uint32_t(i)));
    moving_object.push_back(show.world->object_of(uint32_t(i)));
  }
  world_ = std::make_unique<World>(exhibit_.scene, std::move(moving), std::move(moving_object));
  for (int i = first; i < count; i++)  // one storyteller at a time
    world_->show(i - first, show.world->is_visible(uint32_t(i)));
  world_->commit();
  const LampLevels levels = first_levels(exhibit_);
  for (size_t i = 0; i < levels.size(); i++) world_->set_lamp(int(i), levels[i]);
  std::vector<PunctualLight> moving_lights;  // as they are at the show's start, too
  for (const ChangingLight& light : exhibit_.lights) {
    moving_lights.push_back(eval_light(light, 0));
    if (light.lamp >= 0)
      moving_lights.back().intensity *= brightness_of(levels[size_t(light.lamp)]);
  }
  lights_ = make_lights(*world_, moving_lights);
  transport_.clamp = 0;
}

std::optional<Frame> StillRoom::render(const StillJob& order, const std::function<bool()>& given_up,
                                       StillCosts& costs, std::string& comment) const {
  const auto ends = [&] { return given_up && given_up(); };
  Viewpoint at = exhibit_.viewpoints[size_t(order.viewpoint)].view;
  at.position = order.position.value_or(at.position);
  at.yaw = order.yaw.value_or(at.yaw);
  at.pitch = order.pitch.value_or(at.pitch);
  at.roll = order.roll.value_or(at.roll);
  at.fov = order.fov.value_or(at.fov);
  View view = make_view(exhibit_.scene, at, order.width, order.height);
  StillSettings settings;
  settings.spp = order.spp;
  settings.transport = transport_;
  settings.progress = [&](double) {
    if (ends()) throw GivenUp{};
  };
  const double began = thread_seconds_now();
  Frame frame;
  try {
    frame = render_still(*technique_, *world_, lights_, view, settings);
  } catch (const GivenUp&) {}
  costs.trace_seconds = thread_seconds_now() - began;
  if (frame.color.empty()) return {};
  std::string problem;
  auto denoiser = order.denoise ? load_denoiser(still_net, problem, weights_) : nullptr;
  if (denoiser) {
    GuidePlanes guides = make_guides(*world_, lights_, view);
    denoiser->start({view.width, view.height, frame.color, guides.albedo, guides.normal});
    while (denoiser->advance(slice))
      if (ends()) return {};
    denoiser->finish(frame.color);
    costs.denoise_seconds = thread_seconds_now() - began - costs.trace_seconds;
  }
  comment = std::to_string(order.spp) + " samples a pixel by " + technique_->name +
            (denoiser ? std::string(", denoised by the network ") + net_name(still_net)
                      : ", not denoised");
  return frame;
}

StillCosts StillRoom::measure(const StillJob& order) {
  StillCosts costs;
  std::string comment;
  oneapi::tbb::task_arena arena(1, 1, oneapi::tbb::task_arena::priority::low);
  arena.execute([&] {
    render(order, {}, costs, comment);  // what it needs is at hand then
    render(order, {}, costs, comment);
  });
  return costs;
}

std::optional<std::string> StillRoom::find(const StillJob& order) {
  std::lock_guard lock(mutex_);
  auto found = std::ranges::find(kept_, order, &Kept::order);
  if (found == kept_.end()) return {};
  kept_.splice(kept_.begin(), kept_, found);
  return kept_.front().jpeg;
}

std::string StillRoom::make(const StillJob& order, const std::function<bool()>& given_up, int cores,
                            StillCosts* costs) {
  if (auto kept = find(order)) return *kept;
  std::vector<uint8_t> bytes;
  StillCosts spent;
  oneapi::tbb::task_arena arena(cores, 1, oneapi::tbb::task_arena::priority::low);
  arena.execute([&] {
    std::string comment;
    const std::optional<Frame> frame = render(order, given_up, spent, comment);
    if (!frame) return;
    Image8 image;
    tonemap(*frame, Tonemap{exhibit_.exposure}, image);
    encode_jpeg(image, still_jpeg_quality, true, bytes);
    add_jpeg_comment(comment, bytes);
  });
  if (costs) *costs = spent;
  if (bytes.empty()) return {};
  std::lock_guard lock(mutex_);
  kept_.push_front({order, std::string(bytes.begin(), bytes.end())});
  size_t kept_bytes = 0;
  for (const Kept& kept : kept_) kept_bytes += kept.jpeg.size();
  for (; kept_.size() > 1 && kept_bytes > most_kept_bytes; kept_.pop_back())
    kept_bytes -= kept_.back().jpeg.size();
  return kept_.front().jpeg;
}

}  // namespace wellspring
