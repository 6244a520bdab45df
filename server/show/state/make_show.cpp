// SPDX-License-Identifier: Apache-2.0
#include "show/state/make_show.h"

#include <stdexcept>

#include "base/log.h"
#include "base/worker.h"
#include "light/kept/bake_file.h"
#include "light/kept/map_file.h"
#include "light/sample/light_tables.h"
#include "show/exhibit/exhibit_objects.h"
#include "show/moving/exhibit_scene.h"
#include "show/state/lamps.h"
#include "show/state/visitor_world.h"

namespace wellspring::show {

namespace {

// Puts the storyteller as it stands when it has just come.
void enter(const Show& show, Teller& teller) {
  const StorytellerPlace& place = show.exhibit.storytellers[teller.index];
  teller.storyteller = {};
  teller.storyteller.character = &place.character;
  if (place.expressions) teller.storyteller.expressions = &*place.expressions;
  if (place.gestures) teller.storyteller.gestures = &*place.gestures;
  teller.storyteller.placement = place_storyteller(place, show.exhibit.scene);
  teller.mind = {};
  teller.pose = make_rest_pose(place.character);
  StorytellerEvents events;
  tick_storyteller(teller.mind, teller.storyteller, StorytellerInput{}, teller.pose, events);
}

}  // namespace

void change_storyteller(const Show& show, Teller& teller, size_t storyteller_index) {
  if (storyteller_index == teller.index || storyteller_index >= show.figures.size()) return;
  hush(teller.voice);
  teller.index = storyteller_index;
  enter(show, teller);
  teller.agent_sent_at = -1e9;
}

namespace {

// Returns light that this machine has baked, or that the package carries, whichever is better; else
// light of another scene, as far as its things stand where they stood.
LoadedMap find_maps(const Show& show) {
  const uint64_t key = hash_scene(show.exhibit.scene);
  const World& world = *show.world;  // still objects are those of the scene
  LoadedMap own, shipped = load_map(world, shipped_light(show.exhibit.folder), key);
  if (!show.settings.cache.empty())
    own = load_map(world, show.settings.cache + "/" + show.exhibit.id + ".maps", key);
  auto worth = [](const LoadedMap& loaded) {
    return !loaded.map ? 2.0f : loaded.found == KeyedFile::read ? loaded.map->error : 1.0f;
  };
  return worth(own) < worth(shipped) ? own : shipped;
}

// Prepares the light that techniques need before the first sample: baked before, or coarse. Returns
// the maps that pictures show.
std::shared_ptr<const IlluminationMap> prepare(Show& show) {
  const bool keeps_light = show.lights.tables->plan.uses(TransportPart::kept_light);
  LoadedMap loaded;
  if (keeps_light && (show.technique->uses_maps || show.still_technique->uses_maps))
    loaded = find_maps(show);
  const bool fits = loaded.map && loaded.found == KeyedFile::read;
  if (loaded.map)
    log::info("illumination maps: {} texels, error {:.1f} %{}", loaded.map->nodes.light.size(),
              100 * loaded.map->error,
              fits ? "" : "; of another scene, until there are better ones");
  if (fits) show.lights.known = loaded.map;
  const std::vector<vec3> places = eye_places(show.exhibit);
  for (const Technique* technique : {show.technique, show.still_technique})
    if (technique->prepare) technique->prepare(*show.world, places, show.lights);
  return loaded.map ? loaded.map : show.lights.known;
}

// Makes pictures show `maps`, and begins a baker that finds better ones.
void begin_maps(Show& show, std::shared_ptr<const IlluminationMap> maps) {
  const ShowSettings& settings = show.settings;
  const bool used = settings.display != Display::points && show.technique->uses_maps &&
                    show.still_technique->uses_maps;
  if (!used || !maps) return;
  BakerSettings baker;
  baker.known = show.exhibit.lamps.empty() ? show.lights.known : show.switches.all.known;
  if (maps == baker.known) baker.shown_error = maps->error;
  use_maps(show, std::move(maps));
  if (settings.cache.empty() || !settings.bakes || !settings.background) return;
  baker.file = settings.cache + "/" + show.exhibit.id;
  baker.source = show.exhibit.folder;
  baker.places = eye_places(show.exhibit);
  baker.eyes = all_eye_places(show.exhibit);
  show.baker = std::make_unique<Baker>(show.exhibit.scene, std::move(baker));
}

}  // namespace

std::unique_ptr<Show> make_show(Exhibit exhibit, const ShowSettings& settings) {
  auto show = std::make_unique<Show>();
  show->settings = settings;
  show->seal =
      std::make_shared<Seal>(settings.cache.empty() ? "" : settings.cache + "/visits.key", true);
  show->technique = find_technique(settings.technique);
  show->still_technique = find_technique(settings.still_technique);
  for (const auto& [technique, name] : {std::pair(show->technique, settings.technique),
                                        std::pair(show->still_technique, settings.still_technique)})
    if (!technique) throw std::invalid_argument("unknown technique '" + name + "'");
  show->exhibit = std::move(exhibit);
  Scene& scene = show->exhibit.scene;
  std::vector<Mesh> moving;
  std::vector<uint32_t> moving_object;
  for (const StorytellerPlace& place : show->exhibit.storytellers)
    show->figures.push_back(make_figure(place.character, scene, moving, moving_object));
  for (const ExhibitProp& prop : show->exhibit.props)
    show->props.push_back(make_prop(prop, scene, moving, moving_object));
  show->movers = make_movers(show->exhibit, moving, moving_object);
  show->plays.resize(show->exhibit.animations.size());
  show->world = std::make_unique<World>(scene, std::move(moving), std::move(moving_object));
  show->skin = make_skin_light(*show->world);
  if (!show->figures.empty()) enter(*show, show->teller);
  if (!show->figures.empty() || !show->props.empty())
    pose_world(*show, show->teller, show->movers.posed);
  std::vector<Problem> problems;
  show->roads = make_tour_roads(show->exhibit, *show->world, problems);
  if (!problems.empty()) throw ExhibitError(std::move(problems));
  check_cancelled();
  show->questions = make_question_index(show->exhibit);
  show->lights = make_lights(*show->world);
  show->visibility = std::make_unique<VisibilityPass>(*show->world, show->lights);
  check_cancelled();
  StillPass& pass = show->pass;
  if (show->settings.weights.empty()) pass.problem = "no folder of weights was named";
  else pass.denoiser = load_denoiser(NetSize::small, pass.problem, show->settings.weights);
  auto maps = prepare(*show);
  begin_lamps(*show);
  begin_maps(*show, std::move(maps));
  log::info("exhibit '{}': {} triangles, {} viewpoints, {} materials", show->exhibit.id,
            triangle_count(scene), show->exhibit.viewpoints.size(), scene.materials.size());
  return show;
}

}  // namespace wellspring::show
