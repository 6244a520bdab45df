// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation.h"

#include <algorithm>
#include <cmath>

#include "gltf/data.h"

namespace wellspring::gltf {
namespace {

Path path_of(const std::string& name) {
  if (name == "translation") return Path::translation;
  if (name == "rotation") return Path::rotation;
  if (name == "scale") return Path::scale;
  if (name == "weights") return Path::weights;
  return Path::none;
}

Curve curve_of(File& file, const json& sampler, const std::string& where) {
  std::string name = text(sampler, "interpolation", "LINEAR");
  if (name == "STEP") return Curve::step;
  if (name == "CUBICSPLINE") return Curve::cubic;
  if (name != "LINEAR") warn(file, where + "/interpolation", "unknown; taken as LINEAR");
  return Curve::linear;
}

void check_formats(File& file, const json& sampler, const std::string& where, const Track& track) {
  size_t input = size_t(integer(sampler, "input", 0)),
         output = size_t(integer(sampler, "output", 0));
  Form in = form_of(file, input), out = form_of(file, output);
  if (in.components != 1 || in.component_type != float_component)
    refuse(file, where + "/input", "must be SCALAR of FLOAT, not " + describe(file, input));
  int components = track.path == Path::rotation ? 4 : track.path == Path::weights ? 1 : 3;
  bool fraction = out.component_type == float_component ||
                  (out.normalized && out.component_type != unsigned_int);
  bool whole_allowed = track.path == Path::rotation || track.path == Path::weights;
  if (out.components != components || out.component_type == 0 || !fraction ||
      (out.component_type != float_component && !whole_allowed))
    refuse(file, where + "/output", "cannot be " + describe(file, output) + " for this path");
  int64_t a_key = track.curve == Curve::cubic ? 3 : 1;
  int64_t expected = in.count * a_key * (track.path == Path::weights ? int64_t(track.width) : 1);
  if (track.curve == Curve::cubic && in.count < 2)
    refuse(file, where + "/input", "a cubic curve needs two keys at least");
  if (out.count != expected)
    refuse(file, where + "/output",
           "has " + std::to_string(out.count) + " elements where " + std::to_string(expected) +
               " are needed");
}

void read_track(File& file, const json& sampler, const std::string& where, Track& track) {
  track.times = *read_floats(file, size_t(integer(sampler, "input", 0)));
  track.values = *read_floats(file, size_t(integer(sampler, "output", 0)));
  for (size_t i = 0; i < track.times.size(); i++) {
    if (!std::isfinite(track.times[i]) || (i > 0 && track.times[i] < track.times[i - 1]))
      refuse(file, where + "/input", "times do not increase at key " + std::to_string(i));
    if (i > 0 && track.times[i] == track.times[i - 1])
      warn(file, where + "/input", "two keys at the same time");
    if (track.times[i] < 0) warn(file, where + "/input", "a key before time 0");
  }
  for (float value : track.values)
    if (!std::isfinite(value)) refuse(file, where + "/output", "holds a value that is not finite");
}

// The clip's tracks that have something to move; their data too if `with_data`.
Clip read_clip(File& file, const json& animation, const std::string& where,
               const std::vector<Node>& nodes, bool with_data) {
  Clip clip;
  clip.name = text(animation, "name");
  const json& samplers = items(animation, "samplers");
  const json& channels = items(animation, "channels");
  std::set<std::pair<size_t, Path>> targets;
  for (size_t c = 0; c < channels.size(); c++) {
    const std::string place = at(where + "/channels", c);
    size_t index = size_t(integer(channels[c], "sampler", 0));
    if (index >= samplers.size())
      refuse(file, place + "/sampler", "there is no sampler " + std::to_string(index));
    const json& target = channels[c]["target"];
    Track track;
    track.path = path_of(text(target, "path"));
    if (track.path == Path::none) warn(file, place + "/target/path", "unknown and ignored");
    if (track.path == Path::none || !find(target, "node")) continue;
    track.node = size_t(integer(target, "node", 0));
    const Node& node = nodes[track.node];
    if (node.has_matrix && track.path != Path::weights) {
      warn(file, place, "a node given by a matrix cannot be animated");
      continue;
    }
    if (track.path == Path::weights && node.weights.empty()) {
      warn(file, place, "a node without morph targets has no weights to animate");
      continue;
    }
    const std::string sampler_place = at(where + "/samplers", index);
    track.curve = curve_of(file, samplers[index], sampler_place);
    track.width = track.path == Path::rotation  ? 4
                  : track.path == Path::weights ? node.weights.size()
                                                : 3;
    check_formats(file, samplers[index], sampler_place, track);
    if (!targets.insert({track.node, track.path}).second) {
      warn(file, place, "a second channel for the same target is ignored");
      continue;
    }
    if (with_data) read_track(file, samplers[index], sampler_place, track);
    // Channels may share their data in the file, not here.
    file.keys_made += int64_t(track.times.size() + track.values.size());
    if (file.keys_made > key_numbers_limit)
      refuse_beyond(file, place, key_numbers_limit, "numbers of animations in all",
                    "sample them less often, or leave out what does not move");
    if (!with_data || !track.times.empty()) clip.tracks.push_back(std::move(track));
  }
  return clip;
}

}  // namespace

std::vector<Clip> read_clips(File& file, const std::vector<Node>& nodes) {
  std::vector<Clip> clips;
  const json& animations = items(file.root, "animations");
  for (size_t a = 0; a < animations.size(); a++)
    clips.push_back(read_clip(file, animations[a], at("/animations", a), nodes, true));
  return clips;
}

void animate(File& file, double time, std::vector<Node>& nodes) {
  const json& animations = items(file.root, "animations");
  for (size_t a = 0; a < animations.size(); a++) {
    Clip clip = read_clip(file, animations[a], at("/animations", a), nodes, a == 0);
    if (a > 0 || time == 0 || !std::isfinite(time)) continue;
    move_nodes(clip, time, nodes);
  }
  if (animations.size() > 1 && time != 0)
    warn(file, "/animations", "has several animations; the first one is shown");
}

}  // namespace wellspring::gltf
