// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation.h"

#include <algorithm>
#include <cmath>

#include "gltf/data.h"

namespace wellspring::gltf {
namespace {

// Returns the track's value at a time, as appendix C.3 to C.5 says. Cubic keys are laid out
// in-tangent, value, out-tangent.
std::vector<double> eval_track(const Track& track, double time) {
  size_t width = track.width, keys = track.times.size();
  bool cubic = track.curve == Curve::cubic;
  auto value = [&](size_t key, size_t part, size_t i) {
    return double(track.values[(cubic ? (key * 3 + part) : key) * width + i]);
  };
  size_t next = size_t(std::upper_bound(track.times.begin(), track.times.end(), float(time)) -
                       track.times.begin());
  size_t first = next == 0 ? 0 : next - 1;
  next = std::min(next, keys - 1);
  double span = double(track.times[next]) - track.times[first];
  double t = span > 0 ? glm::clamp((time - track.times[first]) / span, 0.0, 1.0) : 0.0;
  std::vector<double> result(width);
  if (track.curve == Curve::step || span <= 0) {
    for (size_t i = 0; i < width; i++) result[i] = value(first, 1, i);
  } else if (cubic) {
    double t2 = t * t, t3 = t2 * t;
    for (size_t i = 0; i < width; i++)
      result[i] = (2 * t3 - 3 * t2 + 1) * value(first, 1, i) +
                  span * (t3 - 2 * t2 + t) * value(first, 2, i) +
                  (-2 * t3 + 3 * t2) * value(next, 1, i) + span * (t3 - t2) * value(next, 0, i);
  } else if (track.path == Path::rotation) {
    auto key = [&](size_t k) {
      return glm::dquat(value(k, 1, 3), value(k, 1, 0), value(k, 1, 1), value(k, 1, 2));
    };
    glm::dquat q = glm::slerp(key(first), key(next), t);
    result = {q.x, q.y, q.z, q.w};
  } else {
    for (size_t i = 0; i < width; i++)
      result[i] = value(first, 1, i) * (1 - t) + value(next, 1, i) * t;
  }
  return result;
}

void apply(const Track& track, double time, Node& node) {
  std::vector<double> v = eval_track(track, time);
  switch (track.path) {
    case Path::translation: node.translation = {v[0], v[1], v[2]}; break;
    case Path::scale: node.scale = {v[0], v[1], v[2]}; break;
    case Path::rotation: node.rotation = glm::dquat(v[3], v[0], v[1], v[2]); break;
    case Path::weights: node.weights = v; break;
    case Path::none: break;
  }
}

}  // namespace

double length_of(const Clip& clip) {
  float end = 0;
  for (const Track& track : clip.tracks)
    if (!track.times.empty()) end = std::max(end, track.times.back());
  return double(end);
}

void move_nodes(const Clip& clip, double time, std::vector<Node>& nodes) {
  for (const Track& track : clip.tracks) apply(track, time, nodes[track.node]);
}

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

// Reads the clip's tracks that have something to move; their data too if `with_data`.
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

namespace {

glm::dquat unit(glm::dquat q) {
  double length = glm::length(q);
  return length > 1e-12 && std::isfinite(length) ? q / length : glm::dquat(1, 0, 0, 0);
}

dvec3 triple(const json* list, dvec3 otherwise) {
  if (!list) return otherwise;
  return {(*list)[0].get<double>(), (*list)[1].get<double>(), (*list)[2].get<double>()};
}

size_t target_count(const File& file, const json& mesh) {
  size_t count = 0;
  for (const json& primitive : items(mesh, "primitives"))
    count = std::max(count, items(primitive, "targets").size());
  return count;
}

Node read_node(File& file, size_t index) {
  const json& object = items(file.root, "nodes")[index];
  const std::string where = at("/nodes", index);
  Node node;
  const json* rotation = find(object, "rotation");
  node.translation = triple(find(object, "translation"), dvec3(0));
  node.scale = triple(find(object, "scale"), dvec3(1));
  if (rotation) {
    glm::dquat q((*rotation)[3].get<double>(), (*rotation)[0].get<double>(),
                 (*rotation)[1].get<double>(), (*rotation)[2].get<double>());
    if (std::abs(glm::length(q) - 1) > 1e-3)
      warn(file, where + "/rotation", "a rotation that is not of unit length is normalised");
    node.rotation = unit(q);
  }
  if (const json* matrix = find(object, "matrix")) {
    if (rotation || find(object, "translation") || find(object, "scale"))
      refuse(file, where, "has both a matrix and translation, rotation or scale");
    node.has_matrix = true;
    for (int i = 0; i < 16; i++) node.matrix[i / 4][i % 4] = (*matrix)[size_t(i)].get<double>();
    if (node.matrix[0][3] != 0 || node.matrix[1][3] != 0 || node.matrix[2][3] != 0 ||
        node.matrix[3][3] != 1) {
      warn(file, where + "/matrix",
           "a matrix whose last row is not 0 0 0 1 is taken as if it were");
      for (int i = 0; i < 4; i++) node.matrix[i][3] = i == 3;
    }
  }
  if (const json* mesh_index = find(object, "mesh")) {
    const json& mesh = items(file.root, "meshes")[mesh_index->get<size_t>()];
    size_t count = target_count(file, mesh);
    node.weights.assign(count, 0);
    const json& own = items(object, "weights");
    const json& weights = own.empty() ? items(mesh, "weights") : own;
    if (!weights.empty() && weights.size() != count)
      warn(file, where, "the number of morph weights is not that of the morph targets");
    for (size_t i = 0; i < std::min(count, weights.size()); i++)
      node.weights[i] = weights[i].get<double>();
  } else if (find(object, "weights") || find(object, "skin")) {
    warn(file, where, "a skin or morph weights without a mesh are ignored");
  }
  return node;
}

// Links nodes to their parents, one parent each and no cycles, so that walking down costs no more
// than there are nodes.
std::vector<uint32_t> link_parents(File& file, std::vector<Node>& nodes) {
  const json& list = items(file.root, "nodes");
  for (size_t i = 0; i < nodes.size(); i++) {
    const json& children = items(list[i], "children");
    for (size_t c = 0; c < children.size(); c++) {
      size_t child = children[c].get<size_t>();
      if (nodes[child].parent >= 0 || child == i)
        refuse(file, at(at("/nodes", i) + "/children", c),
               child == i ? "a node is its own child"
                          : "node " + std::to_string(child) + " has another parent, node " +
                                std::to_string(nodes[child].parent));
      nodes[child].parent = int(i);
    }
  }
  std::vector<uint32_t> order = parents_first(nodes);
  if (order.size() < nodes.size()) {
    std::vector<char> reached(nodes.size(), 0);
    for (uint32_t i : order) reached[i] = 1;
    size_t first = size_t(std::find(reached.begin(), reached.end(), 0) - reached.begin());
    refuse(file, at("/nodes", first), "is part of a cycle: a node cannot be its own ancestor");
  }
  return order;
}

// Marks the default scene's nodes and what hangs below them.
void mark_shown(File& file, std::vector<Node>& nodes, const std::vector<uint32_t>& order) {
  const json& scenes = items(file.root, "scenes");
  if (scenes.empty()) {
    if (!nodes.empty()) warn(file, "/scenes", "the file has no scene; all its nodes are shown");
    for (Node& node : nodes) node.shown = true;
    return;
  }
  size_t index = size_t(integer(file.root, "scene", 0));
  const json& roots = items(scenes[index], "nodes");
  if (roots.empty()) warn(file, at("/scenes", index), "the scene is empty");
  for (size_t i = 0; i < roots.size(); i++) {
    Node& node = nodes[roots[i].get<size_t>()];
    if (node.parent >= 0)
      warn(file, at(at("/scenes", index) + "/nodes", i), "a scene lists a node that has a parent");
    node.shown = true;
  }
  for (uint32_t i : order)
    if (nodes[i].parent >= 0 && nodes[size_t(nodes[i].parent)].shown) nodes[i].shown = true;
}

}  // namespace

std::vector<uint32_t> parents_first(const std::vector<Node>& nodes) {
  std::vector<uint32_t> order, first(nodes.size() + 1, 0), children;
  for (const Node& node : nodes)
    if (node.parent >= 0) first[size_t(node.parent) + 1]++;
  for (size_t i = 0; i < nodes.size(); i++) first[i + 1] += first[i];
  children.resize(first.back());
  std::vector<uint32_t> next = first;
  for (uint32_t i = 0; i < uint32_t(nodes.size()); i++)
    if (nodes[i].parent < 0) order.push_back(i);
    else children[next[size_t(nodes[i].parent)]++] = i;
  for (size_t done = 0; done < order.size(); done++)
    for (uint32_t c = first[order[done]]; c < first[order[done] + 1]; c++)
      order.push_back(children[c]);
  return order;
}

void place_nodes(const std::vector<uint32_t>& order, std::vector<Node>& nodes) {
  for (uint32_t i : order) {
    Node& node = nodes[i];
    if (!node.has_matrix) {
      node.matrix =
          glm::translate(dmat4(1), node.translation) * glm::mat4_cast(unit(node.rotation));
      node.matrix = glm::scale(node.matrix, node.scale);
    }
    node.global = node.parent < 0 ? node.matrix : nodes[size_t(node.parent)].global * node.matrix;
  }
}

std::vector<Node> make_pose(File& file, double time) {
  std::vector<Node> nodes;
  for (size_t i = 0; i < items(file.root, "nodes").size(); i++) nodes.push_back(read_node(file, i));
  std::vector<uint32_t> order = link_parents(file, nodes);
  animate(file, time, nodes);
  place_nodes(order, nodes);
  for (size_t i = 0; i < nodes.size(); i++)
    for (int k = 0; k < 16; k++)
      if (!(std::abs(nodes[i].global[k / 4][k % 4]) < 1e18))
        refuse(file, at("/nodes", i), "stands at no finite place");
  mark_shown(file, nodes, order);
  return nodes;
}

}  // namespace wellspring::gltf
