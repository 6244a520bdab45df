// SPDX-License-Identifier: Apache-2.0
#include "cache_visit_stage.h"

#include <algorithm>

#include "base/parallel.h"
#include "light/technique/technique.h"
#include "show/answer/events.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/state/lamps.h"
#include "show/state/make_show.h"

namespace wellspring::test {
namespace {

std::unique_ptr<Show> open_show(const std::string& folder, const std::string& technique) {
  ShowSettings settings;
  settings.technique = technique;
  return make_show(load_exhibit(folder), settings);
}

// Returns levels at which the lamps that have a place are off: daylight stays.
LampLevels dark_levels(const Exhibit& exhibit) {
  LampLevels levels = first_levels(exhibit);
  for (size_t i = 0; i < levels.size(); i++) {
    const auto is_placed = [&](int light) {
      return exhibit.scene.lights[size_t(light)].type != PunctualType::directional;
    };
    const std::vector<int>& lights = exhibit.scene.lamps[i].lights;
    if (!lights.empty() && std::ranges::all_of(lights, is_placed)) levels[i] = 0;
  }
  return levels;
}

}  // namespace

VisitStage::VisitStage(const std::string& folder, const std::string& technique)
    : show_(open_show(folder, technique)),
      lit_(first_levels(exhibit())),
      dark_(dark_levels(exhibit())),
      mind_(show_->cast.teller.mind),
      pose_(show_->cast.teller.pose) {}

void VisitStage::light(bool on) {
  change_.reset();
  const LampLevels before = show_->stage.switches.lit, &after = on ? lit_ : dark_;
  if (before == after) return;
  change_.emplace(exhibit().scene, show_->stage.switches.all, show_->stage.switches.cells, before,
                  after);
  light_world(show_->stage, after);
}

void VisitStage::begin(const VisitTrace& trace) {
  light(lamps_on(trace, 0));
  show_->cast.teller.mind = mind_;
  show_->cast.teller.pose = pose_;
  show_->cast.teller.voice = Voice{};
  if (trace.telling && !exhibit().stories.empty())
    tell(show_->cast.teller.voice, exhibit().stories.front());
}

void VisitStage::advance(const VisitTrace& trace, double time, float dt) {
  light(lamps_on(trace, time));
  const World& world = *show_->stage.world;
  int first = int(exhibit().scene.instances.size()), count = world.instance_count();
  before_.resize(size_t(count - first));
  for (int i = first; i < count; i++)
    before_[size_t(i - first)] = world.mesh_of(uint32_t(i)).positions;
  Show& show = *show_;
  if (show.cast.figures.empty()) return;
  // The figure behaves and moves as show/tick.cpp does it for one visitor.
  StorytellerInput input;
  input.time = time;
  input.dt = dt;
  input.speaking = speaking(show.cast.teller.voice);
  input.telling = !show.cast.teller.voice.story.empty();
  Guest guest;
  guest.id = 1;
  guest.head = vec3(eval_trace(trace, time).position - exhibit().scene.origin);
  input.guests.push_back(guest);
  StorytellerEvents events;
  tick_storyteller(show.cast.teller.mind, show.cast.teller.storyteller, input,
                   show.cast.teller.pose, events);
  advance_voice(show.cast.teller.voice, dt);
  pose_figure(*show.stage.world, show.cast.figures[show.cast.teller.index],
              storyteller_of(show.stage, show.cast, show.cast.teller)->character,
              show.cast.teller.pose, show.cast.teller.storyteller.placement, show.cast.scratch);
  show.stage.world->commit();
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

}  // namespace wellspring::test
