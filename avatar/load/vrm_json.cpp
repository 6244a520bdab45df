// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/vrm_json.h"

namespace wellspring::avatar::vrm_json {

namespace {

// Returns a value of the same type as `none`, and `none` itself if there is no value.
const json& of_type_in(const File& file, const json& object, const char* key,
                       const std::string& where, const json& none, const char* must) {
  const json* found = object.is_object() ? gltf::find(object, key) : nullptr;
  if (!found || found->is_null()) return none;
  if (found->type() != none.type()) gltf::refuse(file, where + "/" + key, must);
  return *found;
}

}  // namespace

const json& object_in(const File& file, const json& object, const char* key,
                      const std::string& where) {
  static const json none = json::object();
  return of_type_in(file, object, key, where, none, "must be an object");
}

const json& list_in(const File& file, const json& object, const char* key,
                    const std::string& where) {
  static const json none = json::array();
  return of_type_in(file, object, key, where, none, "must be a list");
}

std::string text_in(const json& object, const char* key) {
  auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

float number_in(const json& object, const char* key, float otherwise) {
  auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_number() ? gltf::to_float(found->get<double>())
                                                     : otherwise;
}

vec3 vector_in(const json& object, const char* key, vec3 otherwise) {
  auto found = object.is_object() ? object.find(key) : object.end();
  if (found == object.end()) return otherwise;
  vec3 v = otherwise;
  if (found->is_object()) {
    v = {number_in(*found, "x", 0), number_in(*found, "y", 0), number_in(*found, "z", 0)};
  } else if (found->is_array() && found->size() == 3) {
    for (int c = 0; c < 3; c++)
      if ((*found)[size_t(c)].is_number()) v[c] = gltf::to_float((*found)[size_t(c)].get<double>());
  }
  return is_finite(v) ? v : otherwise;
}

int index_in(const File& file, const json& object, const char* key, const char* into,
             const std::string& where) {
  auto found = object.is_object() ? object.find(key) : object.end();
  if (found == object.end()) return -1;
  bool whole = found->is_number_integer() && found->get<int64_t>() >= -1;
  int64_t index = whole ? found->get<int64_t>() : 0;
  int64_t count = int64_t(gltf::items(file.root, into).size());
  if (!whole || index >= count)
    gltf::refuse(file, where + "/" + key,
                 "is none of the file's " + std::to_string(count) + " " + into);
  return int(index);
}

}  // namespace wellspring::avatar::vrm_json
