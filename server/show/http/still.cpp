// SPDX-License-Identifier: Apache-2.0
#include "show/http/still.h"

#include <algorithm>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>

#include "denoise/denoise.h"
#include "frame/jpeg.h"
#include "frame/tonemap.h"
#include "light/visible/guides.h"
#include "show/exhibit/exhibit_lamps.h"

namespace wellspring {

namespace {
constexpr size_t most_kept = 12;
constexpr int still_jpeg_quality = 90;
constexpr NetSize still_net = NetSize::base;
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
  const std::vector<char> lamps = first_lamps(exhibit_);
  for (size_t i = 0; i < lamps.size(); i++) world_->switch_lamp(int(i), lamps[i]);
  lights_ = make_lights(*world_);
  transport_.clamp = 0;
}

Frame StillRoom::render(const StillJob& order, std::string& comment) const {
  const Viewpoint& at = exhibit_.viewpoints[size_t(order.viewpoint)].view;
  View view = make_view(exhibit_.scene, order.position.value_or(at.position),
                        order.yaw.value_or(at.yaw), order.pitch.value_or(at.pitch),
                        order.fov.value_or(at.fov), order.width, order.height);
  StillSettings settings;
  settings.spp = order.spp;
  settings.transport = transport_;
  Frame frame = render_still(*technique_, *world_, lights_, view, settings);
  std::string problem;
  auto denoiser = order.denoise ? load_denoiser(still_net, problem, weights_) : nullptr;
  if (denoiser) {
    GuidePlanes guides = make_guides(*world_, lights_, view);
    denoiser->run({view.width, view.height, frame.color, guides.albedo, guides.normal},
                  frame.color);
  }
  comment = std::to_string(order.spp) + " samples a pixel by " + technique_->name +
            (denoiser ? std::string(", denoised by the network ") + net_name(still_net)
                      : ", not denoised");
  return frame;
}

std::string StillRoom::make(const StillJob& order) {
  std::lock_guard lock(mutex_);
  auto found = std::find_if(kept_.begin(), kept_.end(),
                            [&](const Kept& kept) { return kept.order == order; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    return kept_.front().jpeg;
  }
  std::vector<uint8_t> bytes;
  int cores = std::max(1, oneapi::tbb::info::default_concurrency() / 2);
  oneapi::tbb::task_arena arena(cores, 1, oneapi::tbb::task_arena::priority::low);
  arena.execute([&] {
    std::string comment;
    Image8 image;
    tonemap(render(order, comment), Tonemap{exhibit_.exposure}, image);
    encode_jpeg(image, still_jpeg_quality, true, bytes);
    add_jpeg_comment(comment, bytes);
  });
  kept_.push_front({order, std::string(bytes.begin(), bytes.end())});
  if (kept_.size() > most_kept) kept_.pop_back();
  return kept_.front().jpeg;
}

}  // namespace wellspring
