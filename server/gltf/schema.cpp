// SPDX-License-Identifier: Apache-2.0
// Holds the glTF 2.0 schema (section 5) as one table, and checks a file's JSON against it. The
// table also names the list into which every index points, so no reference survives unchecked.
#include <cmath>
#include <map>

#include "gltf/file.h"

namespace wellspring::gltf {
namespace {

enum class Kind {
  boolean,
  integer,
  number,
  text,
  index,    // index into the root list `target`
  object,   // object of type `target`
  map,      // map of names to indices into `target`
  numbers,  // list of numbers
  texts,    // list of strings
  indices,  // list of indices into `target`
  objects,  // list of objects of type `target`
  maps,     // list of maps
};

struct Rule {
  const char* type;  // type of the object that has the property
  const char* property;
  Kind kind;
  const char* target = "";
  bool required = false;
  double low = -1e300;            // least number allowed
  int least = 0, most = 1 << 30;  // number of items of a list
};

constexpr bool must = true;
constexpr const char* lights_list = "extensions/KHR_lights_punctual/lights";

const Rule rules[] = {
    {"glTF", "asset", Kind::object, "asset", must},
    {"glTF", "extensionsUsed", Kind::texts},
    {"glTF", "extensionsRequired", Kind::texts},
    {"glTF", "accessors", Kind::objects, "accessor"},
    {"glTF", "animations", Kind::objects, "animation"},
    {"glTF", "buffers", Kind::objects, "buffer"},
    {"glTF", "bufferViews", Kind::objects, "bufferView"},
    {"glTF", "cameras", Kind::objects, "camera"},
    {"glTF", "images", Kind::objects, "image"},
    {"glTF", "materials", Kind::objects, "material"},
    {"glTF", "meshes", Kind::objects, "mesh"},
    {"glTF", "nodes", Kind::objects, "node"},
    {"glTF", "samplers", Kind::objects, "sampler"},
    {"glTF", "scene", Kind::index, "scenes"},
    {"glTF", "scenes", Kind::objects, "scene"},
    {"glTF", "skins", Kind::objects, "skin"},
    {"glTF", "textures", Kind::objects, "texture"},
    {"glTF.KHR_lights_punctual", "lights", Kind::objects, "light", must},

    {"asset", "version", Kind::text, "", must},
    {"asset", "minVersion", Kind::text},
    {"asset", "generator", Kind::text},
    {"asset", "copyright", Kind::text},

    {"accessor", "bufferView", Kind::index, "bufferViews"},
    {"accessor", "byteOffset", Kind::integer, "", false, 0},
    {"accessor", "componentType", Kind::integer, "", must, 0},
    {"accessor", "normalized", Kind::boolean},
    {"accessor", "count", Kind::integer, "", must, 0},
    {"accessor", "type", Kind::text, "", must},
    {"accessor", "max", Kind::numbers, "", false, -1e300, 1, 16},
    {"accessor", "min", Kind::numbers, "", false, -1e300, 1, 16},
    {"accessor", "sparse", Kind::object, "sparse"},
    {"sparse", "count", Kind::integer, "", must, 0},
    {"sparse", "indices", Kind::object, "sparse indices", must},
    {"sparse", "values", Kind::object, "sparse values", must},
    {"sparse indices", "bufferView", Kind::index, "bufferViews", must},
    {"sparse indices", "byteOffset", Kind::integer, "", false, 0},
    {"sparse indices", "componentType", Kind::integer, "", must, 0},
    {"sparse values", "bufferView", Kind::index, "bufferViews", must},
    {"sparse values", "byteOffset", Kind::integer, "", false, 0},

    {"animation", "channels", Kind::objects, "channel", must},
    {"animation", "samplers", Kind::objects, "animation sampler", must},
    {"channel", "sampler", Kind::integer, "", must, 0},  // range: check_layout
    {"channel", "target", Kind::object, "channel target", must},
    {"channel target", "node", Kind::index, "nodes"},
    {"channel target", "path", Kind::text, "", must},
    {"animation sampler", "input", Kind::index, "accessors", must},
    {"animation sampler", "interpolation", Kind::text},
    {"animation sampler", "output", Kind::index, "accessors", must},

    {"buffer", "uri", Kind::text},
    {"buffer", "byteLength", Kind::integer, "", must, 1},
    {"bufferView", "buffer", Kind::index, "buffers", must},
    {"bufferView", "byteOffset", Kind::integer, "", false, 0},
    {"bufferView", "byteLength", Kind::integer, "", must, 1},
    {"bufferView", "byteStride", Kind::integer, "", false, 1},
    {"bufferView", "target", Kind::integer, "", false, 0},
    {"bufferView.EXT_meshopt_compression", "buffer", Kind::index, "buffers", must},
    {"bufferView.EXT_meshopt_compression", "byteOffset", Kind::integer, "", false, 0},
    {"bufferView.EXT_meshopt_compression", "byteLength", Kind::integer, "", must, 1},
    {"bufferView.EXT_meshopt_compression", "byteStride", Kind::integer, "", must, 1},
    {"bufferView.EXT_meshopt_compression", "count", Kind::integer, "", must, 1},
    {"bufferView.EXT_meshopt_compression", "mode", Kind::text, "", must},
    {"bufferView.EXT_meshopt_compression", "filter", Kind::text},
    {"buffer.EXT_meshopt_compression", "fallback", Kind::boolean},

    {"camera", "orthographic", Kind::object, "orthographic"},
    {"camera", "perspective", Kind::object, "perspective"},
    {"camera", "type", Kind::text, "", must},
    {"orthographic", "xmag", Kind::number, "", must},
    {"orthographic", "ymag", Kind::number, "", must},
    {"orthographic", "zfar", Kind::number, "", must},
    {"orthographic", "znear", Kind::number, "", must},
    {"perspective", "aspectRatio", Kind::number},
    {"perspective", "yfov", Kind::number, "", must},
    {"perspective", "zfar", Kind::number},
    {"perspective", "znear", Kind::number, "", must},

    {"image", "uri", Kind::text},
    {"image", "mimeType", Kind::text},
    {"image", "bufferView", Kind::index, "bufferViews"},

    {"material", "pbrMetallicRoughness", Kind::object, "metallic roughness"},
    {"material", "normalTexture", Kind::object, "texture info"},
    {"material", "occlusionTexture", Kind::object, "texture info"},
    {"material", "emissiveTexture", Kind::object, "texture info"},
    {"material", "emissiveFactor", Kind::numbers, "", false, -1e300, 3, 3},
    {"material", "alphaMode", Kind::text},
    {"material", "alphaCutoff", Kind::number},
    {"material", "doubleSided", Kind::boolean},
    {"metallic roughness", "baseColorFactor", Kind::numbers, "", false, -1e300, 4, 4},
    {"metallic roughness", "baseColorTexture", Kind::object, "texture info"},
    {"metallic roughness", "metallicFactor", Kind::number},
    {"metallic roughness", "roughnessFactor", Kind::number},
    {"metallic roughness", "metallicRoughnessTexture", Kind::object, "texture info"},
    {"texture info", "index", Kind::index, "textures", must},
    {"texture info", "texCoord", Kind::integer, "", false, 0},
    {"texture info", "scale", Kind::number},
    {"texture info", "strength", Kind::number},
    {"texture info.KHR_texture_transform", "offset", Kind::numbers, "", false, -1e300, 2, 2},
    {"texture info.KHR_texture_transform", "rotation", Kind::number},
    {"texture info.KHR_texture_transform", "scale", Kind::numbers, "", false, -1e300, 2, 2},
    {"texture info.KHR_texture_transform", "texCoord", Kind::integer, "", false, 0},
    {"material.KHR_materials_emissive_strength", "emissiveStrength", Kind::number},
    {"material.KHR_materials_ior", "ior", Kind::number},
    {"material.KHR_materials_transmission", "transmissionFactor", Kind::number},
    {"material.KHR_materials_transmission", "transmissionTexture", Kind::object, "texture info"},
    {"material.KHR_materials_volume", "thicknessFactor", Kind::number},
    {"material.KHR_materials_volume", "thicknessTexture", Kind::object, "texture info"},
    {"material.KHR_materials_volume", "attenuationDistance", Kind::number},
    {"material.KHR_materials_volume", "attenuationColor", Kind::numbers, "", false, -1e300, 3, 3},
    {"material.KHR_materials_specular", "specularFactor", Kind::number},
    {"material.KHR_materials_specular", "specularTexture", Kind::object, "texture info"},
    {"material.KHR_materials_specular", "specularColorFactor", Kind::numbers, "", false, -1e300, 3,
     3},
    {"material.KHR_materials_specular", "specularColorTexture", Kind::object, "texture info"},
    {"material.KHR_materials_clearcoat", "clearcoatFactor", Kind::number},
    {"material.KHR_materials_clearcoat", "clearcoatTexture", Kind::object, "texture info"},
    {"material.KHR_materials_clearcoat", "clearcoatRoughnessFactor", Kind::number},
    {"material.KHR_materials_clearcoat", "clearcoatRoughnessTexture", Kind::object, "texture info"},
    {"material.KHR_materials_clearcoat", "clearcoatNormalTexture", Kind::object, "texture info"},
    {"material.KHR_materials_sheen", "sheenColorFactor", Kind::numbers, "", false, -1e300, 3, 3},
    {"material.KHR_materials_sheen", "sheenColorTexture", Kind::object, "texture info"},
    {"material.KHR_materials_sheen", "sheenRoughnessFactor", Kind::number},
    {"material.KHR_materials_sheen", "sheenRoughnessTexture", Kind::object, "texture info"},
    {"material.KHR_materials_anisotropy", "anisotropyStrength", Kind::number},
    {"material.KHR_materials_anisotropy", "anisotropyRotation", Kind::number},
    {"material.KHR_materials_anisotropy", "anisotropyTexture", Kind::object, "texture info"},
    {"material.KHR_materials_dispersion", "dispersion", Kind::number},
    {"material.KHR_materials_pbrSpecularGlossiness", "diffuseFactor", Kind::numbers, "", false,
     -1e300, 4, 4},
    {"material.KHR_materials_pbrSpecularGlossiness", "diffuseTexture", Kind::object,
     "texture info"},
    {"material.KHR_materials_pbrSpecularGlossiness", "specularFactor", Kind::numbers, "", false,
     -1e300, 3, 3},
    {"material.KHR_materials_pbrSpecularGlossiness", "glossinessFactor", Kind::number},
    {"material.KHR_materials_pbrSpecularGlossiness", "specularGlossinessTexture", Kind::object,
     "texture info"},

    {"mesh", "primitives", Kind::objects, "primitive", must},
    {"mesh", "weights", Kind::numbers},
    {"primitive", "attributes", Kind::map, "accessors", must},
    {"primitive", "indices", Kind::index, "accessors"},
    {"primitive", "material", Kind::index, "materials"},
    {"primitive", "mode", Kind::integer, "", false, 0},
    {"primitive", "targets", Kind::maps, "accessors"},

    {"primitive.KHR_draco_mesh_compression", "bufferView", Kind::index, "bufferViews", must},
    {"primitive.KHR_draco_mesh_compression", "attributes", Kind::object, "draco ids", must},
    {"node.EXT_mesh_gpu_instancing", "attributes", Kind::map, "accessors", must},

    {"node", "camera", Kind::index, "cameras"},
    {"node", "children", Kind::indices, "nodes"},
    {"node", "skin", Kind::index, "skins"},
    {"node", "matrix", Kind::numbers, "", false, -1e300, 16, 16},
    {"node", "mesh", Kind::index, "meshes"},
    {"node", "rotation", Kind::numbers, "", false, -1e300, 4, 4},
    {"node", "scale", Kind::numbers, "", false, -1e300, 3, 3},
    {"node", "translation", Kind::numbers, "", false, -1e300, 3, 3},
    {"node", "weights", Kind::numbers},
    {"node.KHR_lights_punctual", "light", Kind::index, lights_list, must},

    {"light", "color", Kind::numbers, "", false, -1e300, 3, 3},
    {"light", "intensity", Kind::number},
    {"light", "type", Kind::text, "", must},
    {"light", "range", Kind::number},
    {"light", "spot", Kind::object, "spot"},
    {"spot", "innerConeAngle", Kind::number},
    {"spot", "outerConeAngle", Kind::number},

    {"sampler", "magFilter", Kind::integer, "", false, 0},
    {"sampler", "minFilter", Kind::integer, "", false, 0},
    {"sampler", "wrapS", Kind::integer, "", false, 0},
    {"sampler", "wrapT", Kind::integer, "", false, 0},
    {"scene", "nodes", Kind::indices, "nodes"},
    {"skin", "inverseBindMatrices", Kind::index, "accessors"},
    {"skin", "skeleton", Kind::index, "nodes"},
    {"skin", "joints", Kind::indices, "nodes", must, -1e300, 1},
    {"texture", "sampler", Kind::index, "samplers"},
    {"texture", "source", Kind::index, "images"},
    {"texture.EXT_texture_webp", "source", Kind::index, "images", must},
};

class Walker {
 public:
  // Returns an extension's first name, if it has got another one since.
  static std::string renamed(const std::string& extension) {
    return extension == "KHR_meshopt_compression" ? "EXT_meshopt_compression" : extension;
  }

  explicit Walker(File& file) : file_(file) {
    for (const Rule& rule : rules) rules_of_[rule.type].push_back(&rule);
  }

  void check_object(const json& value, const std::string& type, const std::string& where) {
    if (!value.is_object()) refuse(file_, where, "must be an object");
    auto rules = rules_of_.find(type);
    for (auto it = value.begin(); rules != rules_of_.end() && it != value.end(); ++it) {
      const std::string& key = it.key();
      bool known = key == "extras" || key == "extensions" || key == "name";
      for (const Rule* rule : rules->second) known = known || key == rule->property;
      if (!known) warn(file_, where, "unknown property \"" + key.substr(0, 60) + "\" of " + type);
    }
    if (rules != rules_of_.end())
      for (const Rule* rule : rules->second) {
        auto found = value.find(rule->property);
        if (found != value.end()) check_value(*found, *rule, where + "/" + rule->property);
        else if (rule->required) refuse(file_, where, type + " has no \"" + rule->property + "\"");
      }
    if (const json* name = find(value, "name"); name && !name->is_string())
      refuse(file_, where + "/name", "must be a string");
    if (const json* extensions = find(value, "extensions")) {
      if (!extensions->is_object()) refuse(file_, where + "/extensions", "must be an object");
      for (auto it = extensions->begin(); it != extensions->end(); ++it)
        check_object(it.value(), type + "." + renamed(it.key()),
                     at(where + "/extensions", it.key()));
    }
  }

 private:
  void check_value(const json& value, const Rule& rule, const std::string& where) {
    switch (rule.kind) {
      case Kind::boolean:
        if (!value.is_boolean()) refuse(file_, where, "must be true or false");
        break;
      case Kind::integer: check_integer(value, rule.low, where); break;
      case Kind::number: check_number(value, where); break;
      case Kind::text:
        if (!value.is_string()) refuse(file_, where, "must be a string");
        break;
      case Kind::index: check_index(value, rule.target, where); break;
      case Kind::object: check_object(value, rule.target, where); break;
      case Kind::map: check_map(value, rule.target, where); break;
      default: check_list(value, rule, where);
    }
  }

  void check_number(const json& value, const std::string& where) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      refuse(file_, where, "must be a number");
  }

  void check_integer(const json& value, double low, const std::string& where) {
    check_number(value, where);
    double number = value.get<double>();
    if (number != std::floor(number)) refuse(file_, where, "must be a whole number");
    if (number < low || std::abs(number) > 0x1p53)
      refuse(file_, where, "is out of range: " + value.dump());
  }

  void check_index(const json& value, const char* target, const std::string& where) {
    check_integer(value, 0, where);
    size_t count = list_size(target);
    if (value.get<double>() >= double(count))
      refuse(file_, where,
             "refers to " + std::string(target) + " " + value.dump() + ", of which there are " +
                 std::to_string(count));
  }

  void check_map(const json& value, const char* target, const std::string& where) {
    if (!value.is_object()) refuse(file_, where, "must be an object");
    if (value.empty()) warn(file_, where, "is empty");
    for (auto it = value.begin(); it != value.end(); ++it)
      check_index(it.value(), target, at(where, it.key()));
  }

  void check_list(const json& value, const Rule& rule, const std::string& where) {
    if (!value.is_array()) refuse(file_, where, "must be a list");
    if (value.empty()) warn(file_, where, "an empty list");
    if (int64_t(value.size()) < rule.least || int64_t(value.size()) > rule.most)
      refuse(file_, where, "has " + std::to_string(value.size()) + " items");
    for (size_t i = 0; i < value.size(); i++) {
      const std::string place = at(where, i);
      switch (rule.kind) {
        case Kind::numbers: check_number(value[i], place); break;
        case Kind::texts:
          if (!value[i].is_string()) refuse(file_, place, "must be a string");
          break;
        case Kind::indices: check_index(value[i], rule.target, place); break;
        case Kind::objects: check_object(value[i], rule.target, place); break;
        default: check_map(value[i], rule.target, place);
      }
    }
  }

  // Counts the items in a root list; zero if it is missing or no list (which its own rule refuses).
  size_t list_size(const char* target) {
    auto [known, fresh] = sizes_.try_emplace(target, 0);
    if (fresh) {
      const json* list = &file_.root;
      std::string path = target;
      for (size_t begin = 0; list && begin <= path.size();) {
        size_t end = std::min(path.find('/', begin), path.size());
        list = list->is_object() ? find(*list, path.substr(begin, end - begin).c_str()) : nullptr;
        begin = end + 1;
      }
      if (list && list->is_array()) known->second = list->size();
    }
    return known->second;
  }

  File& file_;
  std::map<std::string, std::vector<const Rule*>> rules_of_;
  std::map<std::string, size_t> sizes_;
};

void check_version(File& file) {
  const json& asset = file.root["asset"];
  auto parse = [&](const char* key, int& major, int& minor) {
    std::string version = text(asset, key);
    char extra = 0;
    if (std::sscanf(version.c_str(), "%5d.%5d%c", &major, &minor, &extra) != 2)
      refuse(file, std::string("/asset/") + key,
             "not a version: \"" + version.substr(0, 20) + "\"");
  };
  int major = 0, minor = 0;
  parse("version", major, minor);
  if (major != 2)
    refuse(file, "/asset/version", "glTF " + text(asset, "version") + " is not glTF 2");
  if (minor != 0) warn(file, "/asset/version", "read as glTF 2.0");
  if (find(asset, "minVersion")) {
    parse("minVersion", major, minor);
    if (major != 2 || minor > 0)
      refuse(file, "/asset/minVersion", "needs glTF " + text(asset, "minVersion"));
  }
}

}  // namespace

void check_schema(File& file) {
  Walker(file).check_object(file.root, "glTF", "");
  check_version(file);
}

// Says what a curator can do about a file that needs it.
static std::string remedy_for(const std::string& extension) {
  if (extension == "KHR_texture_basisu")
    return ": make PNG pictures of its KTX2 ones (gltf-transform ktxdecompress IN.glb OUT.glb; for "
           "one picture: ktx extract --transcode rgba8 IN.ktx2 OUT.png)";
  return "";
}

void check_extensions(File& file, const std::set<std::string>& further) {
  static const std::set<std::string> known = {
      "KHR_texture_transform",      "KHR_materials_emissive_strength",
      "KHR_materials_transmission", "KHR_materials_ior",
      "KHR_materials_volume",       "KHR_materials_unlit",
      "KHR_lights_punctual",        "KHR_materials_pbrSpecularGlossiness",
      "KHR_mesh_quantization",      "KHR_materials_specular",
      "KHR_materials_clearcoat",    "KHR_materials_sheen",
      "KHR_materials_anisotropy",   "KHR_materials_dispersion",
      "EXT_meshopt_compression",    "KHR_meshopt_compression",
      "KHR_draco_mesh_compression", "EXT_texture_webp",
      "EXT_mesh_gpu_instancing"};
  auto is_known = [&](const json& name) {
    return known.count(name.get<std::string>()) || further.count(name.get<std::string>());
  };
  const json& required = items(file.root, "extensionsRequired");
  for (size_t i = 0; i < required.size(); i++)
    if (!is_known(required[i]))
      refuse(file, at("/extensionsRequired", i),
             "needs extension " + required[i].get<std::string>().substr(0, 60) +
                 ", which is not supported" + remedy_for(required[i].get<std::string>()));
  const json& used = items(file.root, "extensionsUsed");
  for (size_t i = 0; i < used.size(); i++)
    if (!is_known(used[i]))
      warn(file, at("/extensionsUsed", i),
           "extension " + used[i].get<std::string>().substr(0, 60) + " is ignored");
}

}  // namespace wellspring::gltf
