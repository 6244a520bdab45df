// SPDX-License-Identifier: Apache-2.0
#include "gltf/attributes.h"

#include <algorithm>
#include <cstring>

#include "gltf/data.h"

namespace wellspring::gltf {
namespace {

// "TEXCOORD_1" -> "TEXCOORD"
std::string family(const std::string& semantic) {
  size_t underscore = semantic.find('_', 1);
  return semantic.substr(0, underscore);
}

bool is_quantized(const File& file) {
  for (const json& name : items(file.root, "extensionsUsed"))
    if (name.get_ref<const std::string&>() == "KHR_mesh_quantization") return true;
  return false;
}

// Whether an attribute of this family may have this form. Strides and alignment never matter here.
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

}  // namespace wellspring::gltf
