// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_objects.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "avatar/body/hold.h"
#include "avatar/figure/rig.h"
#include "base/load_error.h"
#include "base/unicode.h"
#include "show/exhibit/exhibit_files.h"
#include "show/exhibit/exhibit_lights.h"
#include "world/load/scene_load.h"
#include "world/motion/scene_motion.h"

namespace wellspring::show {

namespace {

constexpr double largest_around = 1.5;  // metres: half of what is looked at from all sides

// Returns whether a node of the scene, or one above it, has that number.
bool is_below(const Scene& scene, int node, int above) {
  for (size_t steps = 0; node >= 0 && steps <= scene.nodes.size(); steps++) {
    if (node == above) return true;
    node = scene.nodes[size_t(node)].parent;
  }
  return false;
}

// Objects of that name; else those below the first node of that name.
std::vector<uint32_t> find_objects(const Scene& scene, const std::string& name) {
  std::vector<uint32_t> found;
  if (name.empty()) return found;
  auto object = std::find(scene.objects.begin(), scene.objects.end(), name);
  if (object != scene.objects.end()) return {uint32_t(object - scene.objects.begin())};
  for (size_t node = 0; node < scene.nodes.size(); node++) {
    if (scene.nodes[node].name != name) continue;
    for (uint32_t i = 1; i < scene.object_nodes.size(); i++)
      if (is_below(scene, scene.object_nodes[i], int(node))) found.push_back(i);
    if (!found.empty()) break;
  }
  return found;
}

std::string no_node(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const SceneNode& node : scene.nodes) names.push_back(node.name);
  names.insert(names.end(), scene.objects.begin(), scene.objects.end());
  if (!name.empty() && std::find(names.begin(), names.end(), name) != names.end())
    return "nothing that can be seen belongs to the node '" + name + "'";
  return "the scene has no node '" + name + "'" + did_you_mean(name, names);
}

}  // namespace

Bounds object_bounds(const Scene& scene, const std::vector<uint32_t>& objects) {
  Bounds bounds;
  for (const Instance& instance : scene.instances) {
    if (std::find(objects.begin(), objects.end(), instance.object) == objects.end()) continue;
    for (vec3 position : scene.meshes[size_t(instance.mesh)].positions) {
      vec3 p = vec3(instance.to_world * vec4(position, 1));
      bounds.low = min(bounds.low, p);
      bounds.high = max(bounds.high, p);
    }
  }
  return bounds;
}

void read_label(const Exhibit& exhibit, FieldReader& fields, const char* title,
                PointOfInterest& point) {
  point.title = read_local_text(fields, title, "");
  point.text = read_local_text(fields, "text", "");
  fields.text("story", point.story, "id of the story about it");
  const bool known = std::ranges::any_of(
      exhibit.stories, [&](const StoryText& story) { return story.id == point.story; });
  if (!point.story.empty() && !known)
    fields.fail("story", "there is no story '" + point.story + "'");
  fields.part("provenance", "elements of the Dublin Core", [&](FieldReader& facts) {
    for (const char* name : provenance_elements)
      if (LocalText text = read_local_text(facts, name, ""); !text.empty())
        point.provenance[name] = std::move(text);
  });
  point.manifest = read_address(fields, "manifest", "https address of its IIIF manifest", false);
  fields.boolean("around", point.around, "may be looked at from all sides");
  fields.part("door", "where it leads", [&](FieldReader& door) {
    door.text("exhibit", point.door.exhibit, "id of another exhibit", Need::required);
    door.text("viewpoint", point.door.viewpoint, "of that exhibit; without it its start");
    if (!std::filesystem::exists(exhibit.folder + "/../" + point.door.exhibit + "/exhibit.json"))
      door.warn("exhibit", "there is no exhibit '" + point.door.exhibit + "' beside this one");
  });
}

void read_objects(Exhibit& exhibit, FieldReader& root) {
  const Scene& scene = exhibit.scene;
  root.members(
      "objects", "names for parts of the scene", [&](const std::string& id, FieldReader& fields) {
        PointOfInterest point;
        point.id = id;
        fields.text("node", point.node, "name in the glTF file", Need::required);
        read_label(exhibit, fields, "title", point);
        point.objects = find_objects(scene, point.node);
        if (point.objects.empty() && !scene.objects.empty())
          fields.fail("node", no_node(scene, point.node));
        const Bounds bounds = object_bounds(scene, point.objects);
        const bool empty = !(bounds.low.x <= bounds.high.x);
        const vec3 size = empty ? vec3(0) : bounds.high - bounds.low;
        if (point.around && 0.5 * double(glm::length(size)) > largest_around)
          fields.warn("around",
                      fmt::format("is for things up to {:g} m; this is {:.3g} m from end to end",
                                  2 * largest_around, glm::length(size)));
        point.place = scene.origin + (empty ? dvec3(0) : dvec3(0.5f * (bounds.low + bounds.high)));
        fields.vector("at", most_metres, point.place, "where visitors look; without it its middle");
        exhibit.points.push_back(std::move(point));
      });
}

namespace {

constexpr double turn_degree = 3.14159265358979323846 / 180;
constexpr const char* side_names[] = {"left", "right"};

// Returns the distance from the hand to the farthest corner.
float reach_of(const ExhibitProp& prop) {
  float reach = 0;
  for (const Instance& instance : prop.scene.instances)
    for (const vec3& p : prop.scene.meshes[size_t(instance.mesh)].positions)
      reach = std::max(reach, glm::length(vec3(prop.to_fist * instance.to_world * vec4(p, 1))));
  for (const PunctualLight& light : prop.scene.lights)
    reach = std::max(reach, glm::length(vec3(prop.to_fist * vec4(light.position, 1))));
  return reach;
}

// Says why it is too much for a hand; empty: it is not.
std::string too_much(const ExhibitProp& prop) {
  const Scene& scene = prop.scene;
  if (scene.instances.empty()) return "has nothing to hold";
  if (size_t count = triangle_count(scene); count > most_prop_triangles)
    return fmt::format("has {} triangles; at most {} are held", count, most_prop_triangles);
  size_t texels = 0;
  for (const Image& image : scene.images) texels += size_t(image.width) * size_t(image.height);
  if (texels > most_prop_texels)
    return fmt::format("has pictures of {} texels together; at most {} are held", texels,
                       most_prop_texels);
  if (scene.lights.size() > most_prop_lights)
    return fmt::format("has {} lights; at most {} are held", scene.lights.size(), most_prop_lights);
  for (const PunctualLight& light : scene.lights)
    if (light.type == PunctualType::directional)
      return "has a directional light; those of a lamp are point and spot";
  if (float reach = reach_of(prop); reach > farthest_prop)
    return fmt::format("reaches {:.3g} m from the hand; at most {} m are held", reach,
                       farthest_prop);
  return "";
}

void read_prop_file(const Exhibit& exhibit, FieldReader& fields, ExhibitProp& prop,
                    std::vector<Problem>& problems) {
  const std::string path = package_file(fields, "file", exhibit.folder, prop.file);
  if (path.empty()) return;
  try {
    SceneLoadOptions options;
    options.package = exhibit.folder;
    prop.scene = load_scene(path, options);
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
    return;
  }
  prop.to_fist = mat4(dmat4(prop.to_fist) * glm::translate(dmat4(1), prop.scene.origin));
  prop.scene.origin = dvec3(0);
  for (const std::string& warning : prop.scene.warnings)
    problems.push_back({path, "", warning, false});
  if (const std::string wrong = too_much(prop); !wrong.empty())
    fields.fail("file", "'" + prop.file + "' " + wrong);
}

// The gesture of every storyteller's library, and hands.
void check_hands(const Exhibit& exhibit, FieldReader& fields, const ExhibitProp& prop) {
  for (const StorytellerPlace& place : exhibit.storytellers) {
    const GestureLibrary& library = place.gestures ? *place.gestures : default_gestures();
    const int clip = find_gesture(library, prop.gesture);
    std::vector<std::string> holding;
    for (const GestureClip& one : library.clips)
      if (can_hold(one)) holding.push_back(one.name);
    if (clip < 0) {
      fields.fail("gesture", "there is no gesture '" + prop.gesture + "'" +
                                 did_you_mean(prop.gesture, holding));
      return;
    }
    if (!can_hold(library.clips[size_t(clip)])) {
      fields.fail("gesture", "the gesture '" + prop.gesture +
                                 "' can hold nothing: its \"hold\" must lie well after its "
                                 "\"stroke\", and as far before its end");
      return;
    }
    if (!place.character.joints.empty() &&
        make_rig(place.character).arm[size_t(prop.side)].wrist < 0)
      fields.warn("hand", "the figure of '" + place.id + "' has no " + side_names[prop.side] +
                              " hand: nothing is seen in it");
  }
}

void read_prop(Exhibit& exhibit, FieldReader& fields, std::vector<Problem>& problems) {
  ExhibitProp prop;
  fields.text("id", prop.id, "", Need::required);
  if (find_prop(exhibit, prop.id) >= 0)
    fields.fail("id", "'" + prop.id + "' is taken by another prop");
  if (prop.id == "nothing") fields.fail("id", "'nothing' is what a free hand holds");
  prop.side = 1;
  fields.choice("hand", {"left", "right"}, prop.side, "that holds it; right");
  fields.text("gesture", prop.gesture, "how the arm holds it: one of the gesture library; hold_up");
  prop.flicker = read_flicker(fields);
  fields.part("grip", "how it lies in the fist", [&](FieldReader& grip) {
    dvec3 place(0), turn(0);
    grip.vector("position", most_metres, place);
    grip.vector("turn_deg", most_metres, turn);
    turn *= turn_degree;
    dmat4 to_fist = glm::rotate(dmat4(1), turn.z, dvec3(0, 0, 1));
    to_fist = glm::rotate(to_fist, turn.y, dvec3(0, 1, 0));
    to_fist = glm::rotate(to_fist, turn.x, dvec3(1, 0, 0));
    prop.to_fist = mat4(glm::translate(to_fist, -place));
  });
  fields.text("file", prop.file, "a small glTF file, with its lights", Need::required);
  read_prop_file(exhibit, fields, prop, problems);
  check_hands(exhibit, fields, prop);
  exhibit.props.push_back(std::move(prop));
}

}  // namespace

void read_props(Exhibit& exhibit, FieldReader& root, std::vector<Problem>& problems) {
  root.parts("props", most_props,
             "things that storytellers can hold: <hold name=\"id\"/> in a story",
             [&](FieldReader& fields) { read_prop(exhibit, fields, problems); });
}

std::vector<vec3> eye_places(const Exhibit& exhibit) {
  std::vector<vec3> places;
  for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
    places.push_back(vec3(viewpoint.view.position - exhibit.scene.origin));
  for (size_t i = 1, count = places.size(); i < count; i++)
    places.push_back(0.5f * (places[i - 1] + places[i]));
  return places;
}

std::vector<vec3> all_eye_places(const Exhibit& exhibit) {
  constexpr int most_along = 9;
  std::vector<vec3> places = eye_places(exhibit);
  if (!exhibit.walk || !exhibit.walk->bounds) return places;
  const auto& bounds = *exhibit.walk->bounds;
  const dvec3 size = bounds.high - bounds.low;
  const double step = std::max(size.x, size.z) / most_along;
  if (!(step > 0)) return places;
  for (double x = bounds.low.x + 0.5 * step; x < bounds.high.x; x += step)
    for (double z = bounds.low.z + 0.5 * step; z < bounds.high.z; z += step)
      places.push_back(vec3(dvec3(x, bounds.low.y + double(exhibit.walk->eye_height), z) -
                            exhibit.scene.origin));
  return places;
}

namespace {

// Edges of moving meshes are at most this long: light is kept at their vertices.
constexpr double longest_edge = 0.12;  // metres
constexpr size_t most_named = 8;       // animations in a message
constexpr size_t most_mover_triangles = 40'000;

// Holds the clips of one file, or of all if none is named.
struct Clips {
  const Scene& scene;
  std::string file;
  bool has(const PlacedMotion& motion) const { return file.empty() || motion.of->file == file; }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const PlacedMotion& motion : scene.motions)
      for (const gltf::Clip& clip : motion.of->clips)
        if (has(motion)) names.push_back(clip.name);
    return names;
  }

  bool find(const std::string& name, ExhibitAnimation& animation) const {
    for (size_t m = 0; m < scene.motions.size(); m++) {
      const std::vector<gltf::Clip>& clips = scene.motions[m].of->clips;
      const auto found = std::ranges::find(clips, name, &gltf::Clip::name);
      if (found == clips.end() || !has(scene.motions[m])) continue;
      animation.motion = int(m), animation.clip = int(found - clips.begin());
      animation.seconds = gltf::length_of(*found);
      return true;
    }
    return false;
  }

  std::string unknown(const std::string& name) const {
    const std::vector<std::string> all = names();
    const std::string where = file.empty() ? "the scene" : "'" + file + "'";
    if (all.empty()) return where + " has no animations";
    std::string some;
    for (size_t i = 0; i < all.size() && i < most_named; i++)
      some += (i > 0 ? ", '" : "'") + all[i] + "'";
    return where + " has no animation '" + name + "'" + did_you_mean(name, all) + "; there is " +
           some + (all.size() > most_named ? ", ..." : "");
  }
};

// Notes lights and cameras that it moves as problems: they stay at rest.
void check_lights(const Exhibit& exhibit, const ExhibitAnimation& animation, FieldReader& fields) {
  const Scene& scene = exhibit.scene;
  const SceneMotion& motion = *scene.motions[size_t(animation.motion)].of;
  const gltf::Clip& clip = motion.clips[size_t(animation.clip)];
  if (std::ranges::none_of(motion.movers,
                           [&](const Mover& one) { return moves(motion, clip, one); }))
    fields.warn("clip", "the animation '" + clip.name + "' moves nothing that can be seen");
  for (size_t i = 0; i < motion.movers.size(); i++) {
    const int instance = scene.motions[size_t(animation.motion)].instances[i];
    if (instance < 0 || !moves(motion, clip, motion.movers[i])) continue;
    const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)];
    const Material& material = scene.materials[size_t(mesh.material)];
    if (material.emission == vec3(0)) continue;
    fields.warn("clip", "'" + scene.objects[scene.instances[size_t(instance)].object] +
                            "' shines and moves: it is seen to shine, and lights nothing");
    return;
  }
}

void read_animation(Exhibit& exhibit, FieldReader& fields) {
  ExhibitAnimation animation;
  fields.text("id", animation.id, "", Need::required);
  if (std::ranges::find(exhibit.animations, animation.id, &ExhibitAnimation::id) !=
      exhibit.animations.end())
    fields.fail("id", "'" + animation.id + "' is taken by another animation");
  animation.title = read_local_text(fields, "title", "");
  fields.choice("play", {"loop", "touch"}, animation.start,
                "by itself, or when its object is touched");
  const bool touched = animation.start == ExhibitAnimation::Start::touch;
  animation.shared = !touched;
  fields.boolean("shared", animation.shared, "who starts it does so for everybody");
  if (!animation.shared && !touched)
    fields.fail("shared", "what plays by itself does so for everybody");
  std::string object, clip, file;
  fields.text("object", object, "whose touch starts it: one of objects",
              touched ? Need::required : Need::optional);
  fields.text("clip", clip, "its name in the glTF file; its number without", Need::required);
  fields.text("file", file, "of several, the one it is in");
  if (const PointOfInterest* point = find_point(exhibit, object))
    animation.point = int(point - exhibit.points.data());
  else if (!object.empty()) fields.fail("object", unknown_object(exhibit, object));
  const bool loaded = !exhibit.scene.objects.empty();
  const Clips clips{exhibit.scene, file};
  if (clips.find(clip, animation)) {
    if (animation.seconds > 0) check_lights(exhibit, animation, fields);
    else fields.fail("clip", "the animation '" + clip + "' takes no time");
  } else if (loaded && !clip.empty()) {
    fields.fail("clip", clips.unknown(clip));
  }
  exhibit.animations.push_back(std::move(animation));
}

// Two of them at one node would pull it to and fro.
void check_shared_nodes(const Exhibit& exhibit, FieldReader& root) {
  for (size_t a = 0; a < exhibit.animations.size(); a++)
    for (size_t b = 0; b < a; b++) {
      const ExhibitAnimation &one = exhibit.animations[a], &other = exhibit.animations[b];
      if (one.seconds <= 0 || other.seconds <= 0 || one.motion != other.motion) continue;
      const SceneMotion& motion = *exhibit.scene.motions[size_t(one.motion)].of;
      for (const gltf::Track& track : motion.clips[size_t(one.clip)].tracks)
        for (const gltf::Track& same : motion.clips[size_t(other.clip)].tracks)
          if (track.node == same.node && track.path == same.path) {
            root.warn("animations", "'" + other.id + "' and '" + one.id +
                                        "' move the same node: the later one is seen");
            return;
          }
    }
}

}  // namespace

void read_animations(Exhibit& exhibit, FieldReader& root) {
  root.parts("animations", most_animations, "which of the scene's animations are played",
             [&](FieldReader& fields) { read_animation(exhibit, fields); });
  check_shared_nodes(exhibit, root);
}

void take_movers(Exhibit& exhibit) {
  Scene& scene = exhibit.scene;
  std::vector<char> taken(scene.instances.size(), 0);
  for (size_t m = 0; m < scene.motions.size(); m++) {
    PlacedMotion& placed = scene.motions[m];
    auto own = std::make_shared<SceneMotion>(*placed.of);
    own->movers.clear();
    for (size_t i = 0; i < placed.of->movers.size(); i++) {
      const Mover& mover = placed.of->movers[i];
      const bool moved = std::ranges::any_of(exhibit.animations, [&](const auto& animation) {
        return size_t(animation.motion) == m && animation.seconds > 0 &&
               moves(*own, own->clips[size_t(animation.clip)], mover);
      });
      if (!moved) continue;
      const Instance& instance = scene.instances[size_t(placed.instances[i])];
      exhibit.movers.push_back({int(m), int(own->movers.size()),
                                scene.meshes[size_t(instance.mesh)].material, instance.object});
      taken[size_t(placed.instances[i])] = 1;
      own->movers.push_back(mover);
      const dmat4 to_world = placed.to_world * own->nodes[mover.node].global;
      const double scale =
          std::max({glm::length(dvec3(to_world[0])), glm::length(dvec3(to_world[1])),
                    glm::length(dvec3(to_world[2]))});
      subdivide(own->movers.back(), scale, longest_edge, most_mover_triangles);
    }
    placed.instances.assign(own->movers.size(), -1);
    placed.of = std::move(own);
  }
  if (exhibit.movers.empty()) {
    scene.motions.clear();
    return;
  }
  size_t kept = 0;
  for (size_t i = 0; i < taken.size(); i++)
    if (!taken[i]) scene.instances[kept++] = scene.instances[i];
  scene.instances.resize(kept);
}

}  // namespace wellspring::show
