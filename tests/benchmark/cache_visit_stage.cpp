// SPDX-License-Identifier: Apache-2.0
#include "cache_visit_stage.h"

#include "base/clock.h"
#include "base/log.h"
#include "base/parallel.h"
#include "light/bake/bake_file.h"
#include "light/bake/coarse_light.h"
#include "light/bake/finish_bake.h"
#include "light/bake/map_file.h"
#include "show/exhibit/eye_places.h"
#include "light/technique/technique.h"
#include "show/exhibit/exhibit_load.h"
#include "show/answer/events.h"
#include "show/state/make_show.h"

namespace wellspring {
namespace {

std::unique_ptr<Show> open_show(const std::string& folder, const std::string& technique,
                                bool lamps) {
  Exhibit exhibit = load_exhibit(folder);
  if (!lamps)
    std::erase_if(exhibit.scene.lights, [](const PunctualLight& light) {
      return light.type != PunctualType::directional;
    });
  ShowSettings settings;
  settings.technique = technique;
  return make_show(std::move(exhibit), settings);
}

std::shared_ptr<const IlluminationMap> find_baked(const Show& show, const std::string& file,
                                                  double seconds) {
  const Scene& scene = show.exhibit.scene;
  const uint64_t key = hash_scene(scene);
  const World world(scene);
  if (LoadedMap kept = load_map(world, file, key); kept.found == KeyedFile::read) return kept.map;
  const std::vector<vec3> places = eye_places(show.exhibit);
  const BakeScene baked = make_bake_scene(world, places);
  Bake bake = begin_bake(world, places);
  const double began = seconds_now();
  go_on(baked, bake, [&] { return seconds_now() - began > seconds && bake.passes > 0; });
  auto maps = finish_map(world, all_eye_places(show.exhibit), bake);
  log::info("{}: {} passes, error {:.1f} %", file, bake.passes, 100 * maps->error);
  save_map(world, *maps, file, key);
  return maps;
}

}  // namespace

VisitStage::VisitStage(const std::string& folder, const std::string& technique)
    : folder_(folder), technique_(technique), lit_(open_show(folder, technique, true)) {
  now_ = lit_.get();
  mind_ = lit_->teller.mind;
  pose_ = lit_->teller.pose;
}

Show& VisitStage::dark() {
  if (!dark_) dark_ = open_show(folder_, technique_, false);
  return *dark_;
}

void VisitStage::use_maps(const std::string& folder, double seconds) {
  maps_folder_ = folder;
  bake_seconds_ = seconds;
}

std::shared_ptr<const IlluminationMap> VisitStage::maps() {
  if (maps_folder_.empty()) return nullptr;
  const bool lit = now_ == lit_.get();
  auto& maps = lit ? lit_maps_ : dark_maps_;
  if (!maps)
    maps = find_baked(*now_, maps_folder_ + (lit ? "/lit.maps" : "/dark.maps"), bake_seconds_);
  return maps;
}

void VisitStage::begin(const VisitTrace& trace) {
  now_ = lamps_on(trace, 0) ? lit_.get() : &dark();
  now_->teller.mind = mind_;
  now_->teller.pose = pose_;
  now_->teller.voice = Voice{};
  if (trace.telling && !exhibit().stories.empty())
    tell(now_->teller.voice, exhibit().stories.front());
}

void VisitStage::advance(const VisitTrace& trace, double time, float dt) {
  Show* before = now_;
  now_ = lamps_on(trace, time) ? lit_.get() : &dark();
  switched_ = now_ != before;
  if (switched_) {
    now_->teller.mind = before->teller.mind;
    now_->teller.pose = before->teller.pose;
    now_->teller.voice = before->teller.voice;
  }
  int first = int(exhibit().scene.instances.size()), count = before->world->instance_count();
  before_.resize(size_t(count - first));
  for (int i = first; i < count; i++)
    before_[size_t(i - first)] = before->world->mesh_of(uint32_t(i)).positions;
  Show& show = *now_;
  if (show.figures.empty()) return;
  // As show/tick.cpp behaves and animates for one visitor.
  StorytellerInput input;
  input.time = time;
  input.dt = dt;
  input.speaking = speaking(show.teller.voice);
  input.telling = !show.teller.voice.story.empty();
  Guest guest;
  guest.id = 1;
  guest.head = vec3(eval_trace(trace, time).position - exhibit().scene.origin);
  input.guests.push_back(guest);
  StorytellerEvents events;
  tick_storyteller(show.teller.mind, show.teller.storyteller, input, show.teller.pose, events);
  advance_voice(show.teller.voice, dt);
  pose_figure(*show.world, show.figures[show.teller.index],
              storyteller_of(show, show.teller)->character, show.teller.pose,
              show.teller.storyteller.placement, show.scratch);
  show.world->commit();
}

View VisitStage::view(const VisitTrace& trace, double time, int width, int height) const {
  Viewpoint at = eval_trace(trace, time);
  return make_view(exhibit().scene, at.position, at.yaw, at.pitch, at.fov, width, height);
}

void VisitStage::see(const View& view, TrueView& seen) const {
  const Technique& emission = *find_technique("direct");  // at one edge: what is seen, no light
  TransportSettings transport;
  transport.max_depth = 1;
  size_t pixels = size_t(view.width) * size_t(view.height);
  seen.view = view;
  seen.object.resize(pixels);
  seen.position.resize(pixels);
  seen.hit.resize(pixels);
  seen.where.assign(pixels, Hit{});
  seen.corner.resize(size_t(view.width + 1) * size_t(view.height + 1));
  auto look = [&](float x, float y) {
    Request request;
    request.ray = view_ray(view, x, y);
    return emission.trace(world(), lights(), transport, request);
  };
  parallel_ranges(view.height + 1, 4, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x <= view.width; x++) {
        Sample corner = look(float(x), float(y));
        seen.corner[size_t(y) * size_t(view.width + 1) + size_t(x)] =
            (corner.flags & sample_hit) ? corner.object : 0;
        if (x == view.width || y == view.height) continue;
        size_t pixel = size_t(y) * size_t(view.width) + size_t(x);
        Sample sample = look(float(x) + 0.5f, float(y) + 0.5f);
        seen.hit[pixel] = (sample.flags & sample_hit) != 0;
        seen.object[pixel] = seen.hit[pixel] ? sample.object : 0;
        seen.position[pixel] = sample.position;
        if (sample.flags & sample_moving)
          seen.where[pixel] = {sample.distance, sample.instance, sample.triangle,
                               sample.barycentric};
      }
  });
}

vec3 VisitStage::moved_back(const Hit& hit) const {
  const std::vector<vec3>& vertices = before_[hit.instance - exhibit().scene.instances.size()];
  uvec3 corner = world().mesh_of(hit.instance).triangles[hit.triangle];
  vec2 b = hit.barycentric;
  return (1 - b.x - b.y) * vertices[corner.x] + b.x * vertices[corner.y] + b.y * vertices[corner.z];
}

}  // namespace wellspring
