// SPDX-License-Identifier: Apache-2.0
#include "gltf/instances.h"

#include <cmath>

#include "gltf/data.h"

namespace wellspring::gltf {
namespace {

// Values of an attribute of all instances; an empty list: the node has none of it.
std::vector<float> read_instance_values(File& file, const json& attributes, const char* name,
                                        int components, const std::string& where, int64_t& count) {
  const json* accessor = find(attributes, name);
  if (!accessor) return {};
  const size_t index = accessor->get<size_t>();
  const Form form = form_of(file, index);
  const bool is_turn = components == 4;
  const bool fits =
      form.component_type == float_component ||
      (is_turn && form.normalized &&
       (form.component_type == byte_component || form.component_type == short_component));
  if (form.components != components || !fits)
    refuse(file, at(where, name), "cannot be " + describe(file, index));
  if (count >= 0 && form.count != count)
    refuse(file, at(where, name),
           "has " + std::to_string(form.count) + " elements, others " + std::to_string(count));
  count = form.count;
  return *read_floats(file, index);
}

}  // namespace

std::vector<dmat4> read_instances(File& file, size_t node) {
  const json* asked = extension(items(file.root, "nodes")[node], "EXT_mesh_gpu_instancing");
  if (!asked) return {dmat4(1)};
  const std::string where = at("/nodes", node) + "/extensions/EXT_mesh_gpu_instancing/attributes";
  const json& attributes = (*asked)["attributes"];
  int64_t count = -1;
  const auto places = read_instance_values(file, attributes, "TRANSLATION", 3, where, count);
  const auto turns = read_instance_values(file, attributes, "ROTATION", 4, where, count);
  const auto scales = read_instance_values(file, attributes, "SCALE", 3, where, count);
  count = std::max<int64_t>(count, 0);
  if ((file.instances_made += count) > instances_limit)
    refuse_beyond(file, where, instances_limit, "instances in all", "leave some out");
  std::vector<dmat4> instances;
  size_t dropped = 0;
  for (size_t i = 0; i < size_t(count); i++) {
    dmat4 m(1);
    if (!places.empty())
      m = glm::translate(m, dvec3(places[3 * i], places[3 * i + 1], places[3 * i + 2]));
    if (!turns.empty()) {
      const float* t = &turns[4 * i];
      const glm::dquat turn{double(t[3]), double(t[0]), double(t[1]), double(t[2])};
      if (glm::length(turn) > 1e-9) m = m * glm::mat4_cast(glm::normalize(turn));
    }
    if (!scales.empty())
      m = glm::scale(m, dvec3(scales[3 * i], scales[3 * i + 1], scales[3 * i + 2]));
    double sum = 0;
    for (int k = 0; k < 16; k++) sum += std::abs(m[k / 4][k % 4]);
    if (sum < 1e15) instances.push_back(m);
    else dropped++;
  }
  if (dropped)
    warn(file, where, std::to_string(dropped) + " instances at no finite place are left out");
  return instances;
}

}  // namespace wellspring::gltf
