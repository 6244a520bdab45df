// SPDX-License-Identifier: Apache-2.0
#include "show/state/make_show.h"

#include <algorithm>
#include <stdexcept>

#include "base/log.h"
#include "base/memory.h"
#include "base/worker.h"
#include "light/kept/bake_file.h"
#include "light/kept/map_file.h"
#include "light/sample/light_tables.h"
#include "show/exhibit/exhibit_objects.h"
#include "show/exhibit/pieces/exhibit_scans.h"
#include "show/exhibit/pieces/exhibit_volumes.h"
#include "show/moving/exhibit_scene.h"
#include "show/state/renderer.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"
#include "show/state/visitor_world.h"

namespace wellspring::show {

namespace {

// Puts the storyteller as it stands when it has just come.
void enter(const ExhibitStage& stage, Teller& teller) {
  const StorytellerPlace& place = stage.exhibit.storytellers[teller.index];
  teller.storyteller = {};
  teller.storyteller.character = &place.character;
  if (place.expressions) teller.storyteller.expressions = &*place.expressions;
  if (place.gestures) teller.storyteller.gestures = &*place.gestures;
  teller.storyteller.placement = place_storyteller(place, stage.exhibit.scene);
  teller.mind = {};
  teller.pose = make_rest_pose(place.character);
  StorytellerEvents events;
  tick_storyteller(teller.mind, teller.storyteller, StorytellerInput{}, teller.pose, events);
}

}  // namespace

void change_storyteller(const ExhibitStage& stage, const ShowCast& cast, Teller& teller,
                        size_t storyteller_index) {
  if (storyteller_index == teller.index || storyteller_index >= cast.figures.size()) return;
  hush(teller.voice);
  teller.index = storyteller_index;
  enter(stage, teller);
  teller.agent_sent_at = -1e9;
}

namespace {

// Returns light that this machine has baked, or that the package carries, whichever is better; else
// light of another scene, as far as its things stand where they stood.
LoadedMap find_maps(const ExhibitStage& stage, const ShowSettings& settings) {
  const uint64_t key = hash_scene(stage.exhibit.scene);
  const World& world = *stage.world;  // still objects are those of the scene
  LoadedMap own, shipped = load_map(world, shipped_light(stage.exhibit.folder), key);
  if (!settings.cache.empty())
    own = load_map(world, settings.cache + "/" + stage.exhibit.id + ".maps", key);
  auto worth = [](const LoadedMap& loaded) {
    return !loaded.map ? 2.0f : loaded.found == KeyedFile::read ? loaded.map->error : 1.0f;
  };
  return worth(own) < worth(shipped) ? own : shipped;
}

// Prepares the light that techniques need before the first sample: baked before, or coarse. Returns
// the maps that pictures show.
std::shared_ptr<const IlluminationMap> prepare(ExhibitStage& stage, const ShowSettings& settings) {
  const bool keeps_light = stage.lights.tables->plan.uses(TransportPart::kept_light);
  LoadedMap loaded;
  if (keeps_light && (stage.technique->uses_maps || stage.still_technique->uses_maps))
    loaded = find_maps(stage, settings);
  const bool fits = loaded.map && loaded.found == KeyedFile::read;
  if (loaded.map)
    log::info("illumination maps: {} texels, error {:.1f} %{}", loaded.map->nodes.light.size(),
              100 * loaded.map->error,
              fits ? "" : "; of another scene, until there are better ones");
  if (fits) stage.lights.known = loaded.map;
  const std::vector<vec3> places = eye_places(stage.exhibit);
  for (const Technique* technique : {stage.technique, stage.still_technique})
    if (technique->prepare) technique->prepare(*stage.world, places, stage.lights);
  return loaded.map ? loaded.map : stage.lights.known;
}

// Makes pictures show `maps`, and begins a baker that finds better ones.
void begin_maps(Show& show, std::shared_ptr<const IlluminationMap> maps) {
  const ShowSettings& settings = show.settings;
  const bool used = settings.display != Display::points && show.stage.technique->uses_maps &&
                    show.stage.still_technique->uses_maps;
  if (!used || !maps) return;
  BakerSettings baker;
  baker.known =
      show.stage.exhibit.lamps.empty() ? show.stage.lights.known : show.stage.switches.all.known;
  if (maps == baker.known) baker.shown_error = maps->error;
  use_maps(show.stage, show.visits, std::move(maps));
  if (settings.cache.empty() || !settings.bakes) return;
  baker.file = settings.cache + "/" + show.stage.exhibit.id;
  baker.as_kept = !settings.workers.channel.url.empty();
  baker.source = show.stage.exhibit.folder;
  baker.places = eye_places(show.stage.exhibit);
  baker.eyes = all_eye_places(show.stage.exhibit);
  const auto volumes = show.stage.world->volumes();
  baker.volumes.assign(volumes.begin(), volumes.end());
  show.stage.baker = std::make_unique<Baker>(show.stage.exhibit.scene, std::move(baker));
}

}  // namespace

std::unique_ptr<Show> make_show(Exhibit exhibit, const ShowSettings& settings) {
  auto show = std::make_unique<Show>();
  show->settings = settings;
  show->visits.seal =
      std::make_shared<Seal>(settings.cache.empty() ? "" : settings.cache + "/visits.key", true);
  show->stage.technique = find_technique(settings.technique);
  show->stage.still_technique = find_technique(settings.still_technique);
  for (const auto& [technique, name] :
       {std::pair(show->stage.technique, settings.technique),
        std::pair(show->stage.still_technique, settings.still_technique)})
    if (!technique) throw std::invalid_argument("unknown technique '" + name + "'");
  show->stage.exhibit = std::move(exhibit);
  Scene& scene = show->stage.exhibit.scene;
  std::vector<Mesh> moving;
  std::vector<uint32_t> moving_object;
  for (const StorytellerPlace& place : show->stage.exhibit.storytellers)
    show->cast.figures.push_back(make_figure(place.character, scene, moving, moving_object));
  for (const ExhibitProp& prop : show->stage.exhibit.props)
    show->cast.props.push_back(make_prop(prop, scene, moving, moving_object));
  for (const KioskSettings& kiosk : show->stage.exhibit.kiosks)
    for (const std::string& id : kiosk.held) {
      auto is_it = [&](const auto& one) { return one.first == id; };
      if (std::ranges::any_of(show->cast.held, is_it)) continue;
      Prop model = make_held_model(show->stage.exhibit, id, scene, moving, moving_object);
      if (!model.parts.empty()) show->cast.held.emplace_back(id, std::move(model));
    }
  show->cast.movers = make_movers(show->stage.exhibit, moving, moving_object);
  show->cast.plays.resize(show->stage.exhibit.animations.size());
  show->stage.world = std::make_unique<World>(scene, std::move(moving), std::move(moving_object));
  place_volumes(show->stage.exhibit, *show->stage.world);  // whose shadows light is found with
  place_scans(show->stage.exhibit, *show->stage.world);
  show->stage.lawns.begin(show->stage.exhibit, *show->stage.world);
  show->stage.skin = make_skin_light(*show->stage.world);
  if (!show->cast.figures.empty()) enter(show->stage, show->cast.teller);
  if (!show->cast.figures.empty() || !show->cast.props.empty() || !show->cast.held.empty())
    pose_world(show->stage, show->cast, show->time, show->cast.teller, show->cast.movers.posed);
  std::vector<Problem> problems;
  show->stage.roads = make_tour_roads(show->stage.exhibit, *show->stage.world, problems);
  if (!problems.empty()) throw ExhibitError(std::move(problems));
  check_cancelled();
  show->stage.questions = make_question_index(show->stage.exhibit);
  show->stage.lights = make_lights(*show->stage.world);
  show->stage.visibility = std::make_unique<VisibilityPass>(*show->stage.world, show->stage.lights);
  check_cancelled();
  StillPass& pass = show->drawing->pass;
  if (show->settings.weights.empty()) pass.problem = "no folder of weights was named";
  else pass.denoiser = load_denoiser(NetSize::small, pass.problem, show->settings.weights);
  auto maps = prepare(show->stage, show->settings);
  begin_lamps(show->stage);
  begin_maps(*show, std::move(maps));
  show->stage.volumes.begin(show->stage.exhibit, show->stage.lights, *show->stage.technique,
                            *show->stage.world);
  return_memory();  // loading needed more
  log::info("exhibit '{}': {} triangles, {} viewpoints, {} materials", show->stage.exhibit.id,
            triangle_count(scene), show->stage.exhibit.viewpoints.size(), scene.materials.size());
  return show;
}

Visitor& begin_visit(Show& show, std::shared_ptr<Link> link) {
  Visitor& visitor = show.visits.visitors.emplace_back();
  visitor.link = std::move(link);
  visitor.came_at = show.time;
  visitor.picture->cache = RenderCache({}, show.drawing->renderer.work.cache);
  visitor.picture->compositor = Compositor(show.drawing->renderer.work.compositor);
  visitor.picture->compositor.set_skin(&show.stage.skin, &show.stage.lights);
  return visitor;
}

}  // namespace wellspring::show
