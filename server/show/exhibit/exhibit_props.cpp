// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_props.h"

#include <algorithm>
#include <fmt/format.h>

#include "avatar/body/hold.h"
#include "avatar/figure/rig.h"
#include "base/load_error.h"
#include "base/near_name.h"
#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/package_file.h"
#include "world/load/scene_load.h"

namespace wellspring::show {

namespace {

constexpr double turn_degree = 3.14159265358979323846 / 180;
constexpr const char* side_names[] = {"left", "right"};

// From the hand to the farthest corner.
float reach_of(const ExhibitProp& prop) {
  float reach = 0;
  for (const Instance& instance : prop.scene.instances)
    for (const vec3& p : prop.scene.meshes[size_t(instance.mesh)].positions)
      reach = std::max(reach, glm::length(vec3(prop.to_fist * instance.to_world * vec4(p, 1))));
  for (const PunctualLight& light : prop.scene.lights)
    reach = std::max(reach, glm::length(vec3(prop.to_fist * vec4(light.position, 1))));
  return reach;
}

// What makes it too much for a hand; empty: nothing.
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

void read_file(const Exhibit& exhibit, Fields& fields, ExhibitProp& prop,
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
    fields.problem("file", "'" + prop.file + "' " + wrong);
}

// The gesture of every storyteller's library, and hands.
void check_hands(const Exhibit& exhibit, Fields& fields, const ExhibitProp& prop) {
  for (const StorytellerPlace& place : exhibit.storytellers) {
    const GestureLibrary& library = place.gestures ? *place.gestures : default_gestures();
    const int clip = find_gesture(library, prop.gesture);
    std::vector<std::string> holding;
    for (const GestureClip& one : library.clips)
      if (can_hold(one)) holding.push_back(one.name);
    if (clip < 0) {
      fields.problem("gesture", "there is no gesture '" + prop.gesture + "'" +
                                    did_you_mean(prop.gesture, holding));
      return;
    }
    if (!can_hold(library.clips[size_t(clip)])) {
      fields.problem("gesture", "the gesture '" + prop.gesture +
                                    "' can hold nothing: its \"hold\" must lie well after its "
                                    "\"stroke\", and as far before its end");
      return;
    }
    if (!place.character.joints.empty() &&
        make_rig(place.character).arm[size_t(prop.side)].wrist < 0)
      fields.problem("hand",
                     "the figure of '" + place.id + "' has no " + side_names[prop.side] +
                         " hand: nothing is seen in it",
                     false);
  }
}

void read_prop(Exhibit& exhibit, Fields fields, std::vector<Problem>& problems) {
  ExhibitProp prop;
  prop.id = fields.text("id", true);
  if (find_prop(exhibit, prop.id) >= 0)
    fields.problem("id", "'" + prop.id + "' is taken by another prop");
  if (prop.id == "nothing") fields.problem("id", "'nothing' is what a free hand holds");
  const std::string hand = fields.text("hand", false, "right");
  if (hand != "left" && hand != "right") fields.problem("hand", "is 'left' or 'right'");
  prop.side = hand == "left" ? 0 : 1;
  prop.gesture = fields.text("gesture", false, prop.gesture);
  prop.flicker = read_flicker(fields);
  fields.object("grip", false, [&](Fields grip) {
    const dvec3 place = grip.triple("position", false);
    const dvec3 turn = grip.triple("turn_deg", false) * turn_degree;
    dmat4 to_fist = glm::rotate(dmat4(1), turn.z, dvec3(0, 0, 1));
    to_fist = glm::rotate(to_fist, turn.y, dvec3(0, 1, 0));
    to_fist = glm::rotate(to_fist, turn.x, dvec3(1, 0, 0));
    prop.to_fist = mat4(glm::translate(to_fist, -place));
    grip.finish();
  });
  prop.file = fields.text("file", true);
  read_file(exhibit, fields, prop, problems);
  check_hands(exhibit, fields, prop);
  fields.finish();
  if (exhibit.props.size() == most_props)
    fields.problem("",
                   fmt::format("is one more than the {} props an exhibit may have", most_props));
  else exhibit.props.push_back(std::move(prop));
}

}  // namespace

void read_props(Exhibit& exhibit, Fields& root, std::vector<Problem>& problems) {
  root.objects("props", false,
               [&](Fields fields) { read_prop(exhibit, std::move(fields), problems); });
}

}  // namespace wellspring::show
