// SPDX-License-Identifier: Apache-2.0
#include "gltf/primitive.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gltf/data.h"

namespace wellspring::gltf {
namespace {

std::vector<uvec3> read_triangles(File& file, const json& primitive, const std::string& where,
                                  size_t vertex_count) {
  int64_t mode = integer(primitive, "mode", 4);
  if (mode < 4) {
    warn(file, where, "points and lines are not drawn");
    return {};
  }
  const json* indices = find(primitive, "indices");
  const int64_t corners =
      indices ? form_of(file, indices->get<size_t>()).count : int64_t(vertex_count);
  const size_t count = size_t(mode == 4 ? corners / 3 : std::max<int64_t>(corners - 2, 0));
  if (count == 0) warn(file, where, "a primitive without triangles");
  if (mode == 4 && corners % 3 != 0)
    warn(file, where, "the number of indices is not a multiple of three; the rest is ignored");
  if ((file.triangles_made += int64_t(count)) > triangles_limit)
    refuse_beyond(file, where, triangles_limit, "triangles in all", fewer_triangles);
  std::vector<uint32_t> list;
  if (indices) {
    list = read_integers(file, indices->get<size_t>());
    for (size_t i = 0; i < list.size(); i++)
      if (list[i] >= vertex_count)
        refuse(file, where + "/indices",
               "element " + std::to_string(i) + " is vertex " + std::to_string(list[i]) + " of " +
                   std::to_string(vertex_count));
  } else {
    list.resize(vertex_count);
    for (size_t i = 0; i < vertex_count; i++) list[i] = uint32_t(i);
  }
  std::vector<uvec3> triangles;
  triangles.reserve(count);
  for (size_t i = 0; i < count; i++) {
    uvec3 t;  // section 3.7.2.1: the order keeps the winding
    if (mode == 4) t = {list[3 * i], list[3 * i + 1], list[3 * i + 2]};
    else if (mode == 5) t = {list[i], list[i + 1 + i % 2], list[i + 2 - i % 2]};
    else t = {list[i + 1], list[i + 2], list[0]};
    if (t.x != t.y && t.y != t.z && t.z != t.x) triangles.push_back(t);
  }
  if (triangles.size() < count / 2) triangles.shrink_to_fit();
  return triangles;
}

// Keeps only vertices that a triangle uses, since exporters let many primitives share one long
// list.
void choose_vertices(File& file, const std::string& where, size_t vertex_count, Corners& corners) {
  constexpr uint32_t unseen = 0xffffffffu;
  std::vector<uint32_t>& renamed = file.renamed;
  if (renamed.size() < vertex_count) renamed.resize(vertex_count, unseen);
  for (uvec3& triangle : corners.triangles)
    for (int corner = 0; corner < 3; corner++) {
      uint32_t& name = renamed[triangle[corner]];
      if (name == unseen) {
        name = uint32_t(corners.used.size());
        corners.used.push_back(triangle[corner]);
      }
      triangle[corner] = name;
    }
  for (uint32_t vertex : corners.used) renamed[vertex] = unseen;
  if ((file.vertices_made += int64_t(corners.used.size())) > vertices_limit)
    refuse_beyond(file, where, vertices_limit, "vertices in all", fewer_vertices);
}

}  // namespace

Corners read_corners(File& file, const json& primitive, const std::string& where,
                     size_t vertex_count) {
  Corners corners;
  corners.triangles = read_triangles(file, primitive, where, vertex_count);
  choose_vertices(file, where, vertex_count, corners);
  return corners;
}

namespace {

// Turns "TEXCOORD_1" into "TEXCOORD".
std::string family(const std::string& semantic) {
  size_t underscore = semantic.find('_', 1);
  return semantic.substr(0, underscore);
}

bool is_quantized(const File& file) {
  for (const json& name : items(file.root, "extensionsUsed"))
    if (name.get_ref<const std::string&>() == "KHR_mesh_quantization") return true;
  return false;
}

// Returns whether an attribute of this family may have this form. Strides and alignment never
// matter here.
bool is_allowed(const std::string& name, const Form& form, bool is_target, bool quantized) {
  if (form.component_type == 0 || form.component_type == unsigned_int) return false;
  bool is_float = form.component_type == float_component;
  bool is_signed = form.component_type == byte_component || form.component_type == short_component;
  bool is_unsigned = !is_float && !is_signed;
  if (name == "POSITION") return form.components == 3 && (is_float || quantized);
  if (name == "NORMAL")
    return form.components == 3 && (is_float || (quantized && is_signed && form.normalized));
  if (name == "TANGENT")
    return form.components == (is_target ? 3 : 4) &&
           (is_float || (quantized && is_signed && form.normalized));
  if (name == "TEXCOORD")
    return form.components == 2 &&
           (is_float || quantized || is_unsigned || (is_target && is_signed && form.normalized));
  if (name == "COLOR")
    return (form.components == 3 || form.components == 4) &&
           (is_float || is_unsigned || (is_target && form.normalized));
  if (name == "JOINTS") return form.components == 4 && is_unsigned && !form.normalized;
  if (name == "WEIGHTS") return form.components == 4 && (is_float || is_unsigned);
  return true;
}

bool is_known(const std::string& name) {
  for (const char* known :
       {"POSITION", "NORMAL", "TANGENT", "TEXCOORD", "COLOR", "JOINTS", "WEIGHTS"})
    if (name == known) return true;
  return false;
}

void check_attributes(File& file, const json& attributes, int64_t count, bool is_target,
                      const std::string& where) {
  bool quantized = is_quantized(file);
  for (auto it = attributes.begin(); it != attributes.end(); ++it) {
    std::string name = family(it.key());
    if (!is_known(name)) {
      if (name.empty() || name[0] != '_')
        warn(file, where, "unknown vertex attributes are ignored");
      continue;
    }
    size_t accessor = it.value().get<size_t>();
    Form form = form_of(file, accessor);
    if (!is_allowed(name, form, is_target, quantized))
      refuse(file, at(where, it.key()), "cannot be " + describe(file, accessor));
    if (count >= 0 && form.count != count)
      refuse(file, at(where, it.key()),
             "has " + std::to_string(form.count) + " elements, POSITION " + std::to_string(count));
  }
}

template <class Vector>
std::vector<Vector> read_vectors(File& file, const json& attributes, const std::string& semantic,
                                 const Used& used) {
  std::vector<float> values = read_attribute(file, attributes, semantic, used);
  constexpr size_t length = sizeof(Vector) / sizeof(float);
  std::vector<Vector> result(values.size() / length);
  if (!result.empty()) std::memcpy(result.data(), values.data(), result.size() * sizeof(Vector));
  return result;
}

}  // namespace

std::string numbered(const char* semantic, int set) {
  std::string name = semantic;
  name += std::to_string(set);
  return name;
}

void check_primitive(File& file, const json& primitive, const std::string& where) {
  const json& attributes = primitive["attributes"];
  int64_t count = -1;
  if (const json* position = find(attributes, "POSITION"))
    count = form_of(file, position->get<size_t>()).count;
  else warn(file, where, "a primitive without positions is not drawn");
  check_attributes(file, attributes, count, false, where + "/attributes");
  const json& targets = items(primitive, "targets");
  for (size_t i = 0; i < targets.size(); i++)
    check_attributes(file, targets[i], count, true, at(where + "/targets", i));
  for (int set = 0;; set++) {
    bool joints = find(attributes, numbered("JOINTS_", set).c_str());
    bool weights = find(attributes, numbered("WEIGHTS_", set).c_str());
    if (joints != weights)
      refuse(file, where + "/attributes", "joints without weights, or weights without joints");
    if (!joints) break;
  }
  if (const json* indices = find(primitive, "indices")) {
    Form form = form_of(file, indices->get<size_t>());
    bool whole = form.component_type == unsigned_byte || form.component_type == unsigned_short ||
                 form.component_type == unsigned_int;
    if (!whole || form.components != 1 || form.normalized)
      refuse(file, where + "/indices", "cannot be " + describe(file, indices->get<size_t>()));
  }
  if (integer(primitive, "mode", 4) > 6)
    refuse(file, where + "/mode", "is no topology of glTF 2.0");
}

int64_t vertex_bound(const File& file, const json& primitive) {
  const json* position = find(primitive["attributes"], "POSITION");
  if (!position || integer(primitive, "mode", 4) < 4) return 0;
  int64_t count = form_of(file, position->get<size_t>()).count;
  const json* indices = find(primitive, "indices");
  return indices ? std::min(count, form_of(file, indices->get<size_t>()).count) : count;
}

std::vector<float> read_attribute(File& file, const json& attributes, const std::string& semantic,
                                  const Used& used) {
  const json* accessor = find(attributes, semantic.c_str());
  if (!accessor) return {};
  size_t index = accessor->get<size_t>();
  std::shared_ptr<const std::vector<float>> all = read_floats(file, index);
  Form form = form_of(file, index);
  std::string name = family(semantic);
  size_t components = size_t(form.components);
  bool widen = name == "COLOR" && components == 3;
  std::vector<float> values;
  values.reserve(used.size() * (widen ? 4 : components));
  for (uint32_t vertex : used) {
    auto element = all->begin() + std::ptrdiff_t(vertex * components);
    values.insert(values.end(), element, element + std::ptrdiff_t(components));
    if (widen) values.push_back(1);
  }
  if ((name == "COLOR" || name == "WEIGHTS") && !form.normalized &&
      form.component_type != float_component) {
    warn(file, at("/accessors", index), name + " of integers is read as normalised");
    float largest = form.component_type == unsigned_byte ? 255.0f : 65535.0f;
    for (size_t i = 0; i < values.size(); i++)
      if (!widen || i % 4 != 3) values[i] /= largest;
  }
  return values;
}

std::vector<vec2> read_vec2s(File& file, const json& attributes, const std::string& semantic,
                             const Used& used) {
  return read_vectors<vec2>(file, attributes, semantic, used);
}
std::vector<vec3> read_vec3s(File& file, const json& attributes, const std::string& semantic,
                             const Used& used) {
  return read_vectors<vec3>(file, attributes, semantic, used);
}
std::vector<vec4> read_vec4s(File& file, const json& attributes, const std::string& semantic,
                             const Used& used) {
  return read_vectors<vec4>(file, attributes, semantic, used);
}

namespace {

// Reads values of an attribute of all instances; an empty list: the node does not have it.
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
