// SPDX-License-Identifier: Apache-2.0
#include "corrected_visit.h"

#include "base/load_error.h"
#include "base/rng.h"
#include "light/kept/bake_file.h"
#include "light/kept/map_file.h"
#include "light/technique/technique.h"
#include "picture/compose_drawn.h"
#include "picture/compositor.h"
#include "show/exhibit/exhibit_objects.h"

namespace wellspring::test {
namespace {

constexpr int still_after = 15;  // pictures, as the show's quarter of a second

}  // namespace

CorrectedStage::CorrectedStage(Exhibit of) : exhibit(std::move(of)), world(exhibit.scene) {
  world.commit();
  lights = make_lights(world);
  find_technique("gather")->prepare(world, eye_places(exhibit), lights);
  const std::string file = shipped_light(exhibit.folder);
  lights.maps = load_map(world, file, hash_scene(exhibit.scene)).map;
  if (!lights.maps) throw LoadError(file, "", "it has no light of this scene");
  shining = find_shining(exhibit.scene);
  groups = group_shining(exhibit.scene, shining);
  visibility = std::make_unique<VisibilityPass>(world, lights);
}

std::vector<uint8_t> find_shining_pixels(const CorrectedStage& stage, const View& view) {
  std::vector<uint8_t> found(size_t(view.width) * size_t(view.height));
  stage.visibility->see(view, vec2(0.5f), [&](const VisibleRun& run) {
    const size_t at = size_t(run.y) * size_t(view.width) + size_t(run.x);
    for (int i = 0; i < run.count; i++) {
      const uint32_t object = run.object[i];
      found[at + size_t(i)] = object < stage.shining.size() && stage.shining[object] > 0;
    }
  });
  return found;
}

CorrectedVisit::CorrectedVisit(const CorrectedStage& stage, const CorrectedWay& way)
    : stage_(stage), way_(way), corrections_(way.groups ? stage.groups : std::vector<uint32_t>()) {
  compositor_.set_maps(stage.lights.maps);
  std::vector<float> weights(stage.shining.size(), 1.0f);
  for (size_t i = 0; i < weights.size(); i++)
    if (stage.shining[i] > 0) weights[i] = way.weight;
  cache_.set_weights(weights);
}

void CorrectedVisit::show(const View& view, int budget, int frame, Frame& shown) {
  if (frame == 0 || view != last_) moved_ = frame;
  last_ = view;
  const bool passing = frame - moved_ < still_after;
  const uint64_t seed = mix64(uint64_t(frame + 1) * 0x9e3779b9u);
  cache_.resize(view.width, view.height);
  cache_.move_points(stage_.world);
  cache_.project(view);
  cache_.attend();
  corrective_.clear();
  const bool corrects = way_.order != CorrectedWay::Order::none && (passing || way_.at_rest);
  if (corrects) {
    const int most = int(way_.share * float(budget));
    corrections_.begin(view, *stage_.visibility, stage_.shining);
    if (way_.order == CorrectedWay::Order::corrective)
      corrections_.request({}, most, seed, corrective_);
    else corrections_.request_evenly(most, seed, corrective_);
  }
  cache_.plan(view, budget - int(corrective_.size()), seed, requests_);
  requests_.insert(requests_.end(), corrective_.begin(), corrective_.end());
  samples_.resize(requests_.size());
  TransportSettings transport;
  transport.max_depth = 8, transport.clamp = 4;
  trace(*find_technique("gather"), stage_.world, stage_.lights, transport, requests_, samples_);
  cache_.remember(view, requests_, samples_);
  if (corrects) corrections_.remember(view, requests_, samples_);
  if (passing) return draw(view, shown);
  compositor_.follow_changes(cache_);
  compositor_.add_samples(view, requests_, samples_);
  compositor_.draw_still(cache_, view, *stage_.visibility, shown);
}

// Draws as Compositor::draw(), with the samples of shining objects.
void CorrectedVisit::draw(const View& view, Frame& shown) {
  fit_frame(view.width, view.height, shown);
  fit_frame(view.width, view.height, light_);
  cache_.lend_light();
  cache_.scratch().start(cells_bytes(view.width, view.height));
  take_cells(cells_, view.width, view.height, cache_.scratch());
  const ShownPoints points = read_surface(view, cache_.points(), cache_.image(), cells_, light_);
  corrections_.show(view, light_);
  const bool known = fill_cells(view, cells_);
  filter_cells(view, cells_);
  compose_drawn(view, *stage_.visibility, cells_, known, light_, {.maps = stage_.lights.maps.get()},
                shown);
  cache_.end_frame(points);
}

}  // namespace wellspring::test
