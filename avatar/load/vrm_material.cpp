// SPDX-License-Identifier: Apache-2.0
// Rewrites cartoon materials as glTF's own: VRMC_materials_mtoon-1.0, whose base is glTF already,
// and version 0's "materialProperties", in terms of Unity's shaders "VRM/MToon" and "VRM/Unlit...".
#include <algorithm>

#include "avatar/load/vrm_extension.h"
#include "avatar/load/vrm_json.h"

namespace wellspring::avatar {
namespace {

using nlohmann::json;

using namespace vrm_json;

// Returns numbers of a list under `key`, as many as it has.
vec4 numbers_in(const json& object, const char* key, vec4 otherwise) {
  const json* list = object.is_object() ? gltf::find(object, key) : nullptr;
  for (size_t c = 0; list && list->is_array() && c < std::min<size_t>(list->size(), 4); c++)
    if ((*list)[c].is_number()) otherwise[int(c)] = gltf::to_float((*list)[c].get<double>());
  return otherwise;
}

bool flag_in(const json& object, const char* key) {
  const json* flag = object.is_object() ? gltf::find(object, key) : nullptr;
  return flag && flag->is_boolean() && flag->get<bool>();
}

json list_of(vec3 v) { return {v.x, v.y, v.z}; }

struct Properties {
  File& file;
  const json &floats, &vectors, &pictures;
  std::string where;

  // Refers to a picture as glTF does, placed as the main one.
  bool refer(const char* key, json& to) const {
    int index = index_in(file, pictures, key, "textures", where + "/textureProperties");
    if (index < 0) return false;
    to = {{"index", index}};
    vec4 lies = numbers_in(vectors, "_MainTex", vec4(0, 0, 1, 1));  // offset from below, scale
    if (lies != vec4(0, 0, 1, 1))
      to["extensions"]["KHR_texture_transform"] = {{"offset", {lies.x, 1 - lies.w - lies.y}},
                                                   {"scale", {lies.z, lies.w}}};
    return true;
  }
};

// Rewrites a shader drawn without light, or with MToon's.
void rewrite_version_0(File& file, const json& properties, const std::string& where,
                       json& material) {
  std::string shader = text_in(properties, "shader");
  bool mtoon = shader == "VRM/MToon";
  if (!mtoon && shader.rfind("VRM/Unlit", 0) != 0) return;
  Properties from{file, object_in(file, properties, "floatProperties", where),
                  object_in(file, properties, "vectorProperties", where),
                  object_in(file, properties, "textureProperties", where), where};
  const json& keywords = object_in(file, properties, "keywordMap", where);
  vec4 color = numbers_in(from.vectors, "_Color", vec4(1));
  vec3 linear = glm::min(linear_of_unity(vec3(color)), vec3(1));
  json pbr = {{"baseColorFactor", {linear.x, linear.y, linear.z, std::clamp(color.w, 0.0f, 1.0f)}},
              {"metallicFactor", 0}};
  if (json picture; from.refer("_MainTex", picture)) pbr["baseColorTexture"] = picture;
  material["pbrMetallicRoughness"] = pbr;
  bool blends =
      mtoon ? flag_in(keywords, "_ALPHABLEND_ON") : shader.find("Transparent") != std::string::npos;
  bool cut =
      mtoon ? flag_in(keywords, "_ALPHATEST_ON") : shader.find("Cutout") != std::string::npos;
  material["alphaMode"] = blends ? "BLEND" : cut ? "MASK" : "OPAQUE";
  if (cut)
    material["alphaCutoff"] = std::clamp(number_in(from.floats, "_Cutoff", 0.5f), 0.0f, 1.0f);
  if (!mtoon) return;
  material["extensions"]["VRMC_materials_mtoon"] = json::object();  // as version 1 would mark it
  constexpr float hides_back = 2;  // "_CullMode" names the hidden side; all else shows the back
  material["doubleSided"] = number_in(from.floats, "_CullMode", hides_back) != hides_back;
  for (const char* key : {"normalTexture", "emissiveTexture", "emissiveFactor"})
    material.erase(key);
  if (json picture; from.refer("_BumpMap", picture)) {
    picture["scale"] = number_in(from.floats, "_BumpScale", 1);
    material["normalTexture"] = picture;
  }
  vec3 glow = linear_of_unity(vec3(numbers_in(from.vectors, "_EmissionColor", vec4(0))));
  if (glow == vec3(0)) return;
  material["emissiveFactor"] = list_of(glow);
  if (json picture; from.refer("_EmissionMap", picture)) material["emissiveTexture"] = picture;
}

// Warns of what MToon draws that is not shown, each once.
void tell_unseen(File& file, const json& mtoon, const std::string& where) {
  auto tell = [&](bool asked, const char* what) {
    if (asked)
      gltf::warn(file, where, std::string(what) + " of cartoon materials (MToon) are not drawn");
  };
  std::string mode = text_in(mtoon, "outlineWidthMode");
  tell(!mode.empty() && mode != "none" && number_in(mtoon, "outlineWidthFactor", 0) > 0,
       "outlines");
  tell(numbers_in(mtoon, "parametricRimColorFactor", vec4(0)) != vec4(0), "rims");
  tell(gltf::find(mtoon, "matcapTexture") != nullptr, "matcaps");
  tell(gltf::find(mtoon, "shadeMultiplyTexture") != nullptr, "colours of the shade");
  tell(number_in(mtoon, "uvAnimationScrollXSpeedFactor", 0) != 0 ||
           number_in(mtoon, "uvAnimationScrollYSpeedFactor", 0) != 0 ||
           number_in(mtoon, "uvAnimationRotationSpeedFactor", 0) != 0,
       "moving pictures");
}

void tell_unseen_of_version_0(File& file, const json& properties, const std::string& where) {
  const json& floats = object_in(file, properties, "floatProperties", where);
  const json& vectors = object_in(file, properties, "vectorProperties", where);
  const json& pictures = object_in(file, properties, "textureProperties", where);
  json mtoon = json::object();  // version 1's words
  if (number_in(floats, "_OutlineWidthMode", 0) > 0) mtoon["outlineWidthMode"] = "some";
  mtoon["outlineWidthFactor"] = number_in(floats, "_OutlineWidth", 0);
  mtoon["parametricRimColorFactor"] = list_of(vec3(numbers_in(vectors, "_RimColor", vec4(0))));
  if (gltf::find(pictures, "_SphereAdd")) mtoon["matcapTexture"] = json::object();
  if (gltf::find(pictures, "_ShadeTexture")) mtoon["shadeMultiplyTexture"] = json::object();
  mtoon["uvAnimationScrollXSpeedFactor"] = number_in(floats, "_UvAnimScrollX", 0);
  mtoon["uvAnimationScrollYSpeedFactor"] = number_in(floats, "_UvAnimScrollY", 0);
  mtoon["uvAnimationRotationSpeedFactor"] = number_in(floats, "_UvAnimRotation", 0);
  tell_unseen(file, mtoon, where);
}

}  // namespace

std::set<size_t> rewrite_vrm_materials(File& file) {
  std::set<size_t> cartoons;
  const size_t count = gltf::items(file.root, "materials").size();
  for (size_t m = 0; m < count; m++) {
    json& material = file.root["materials"][m];
    const json* mtoon = gltf::extension(material, "VRMC_materials_mtoon");
    const json* brighter = gltf::extension(material, "VRMC_materials_hdr_emissiveMultiplier");
    if (mtoon) tell_unseen(file, *mtoon, at("/materials", m));
    if (mtoon || gltf::extension(material, "KHR_materials_unlit")) cartoons.insert(m);
    if (brighter && !gltf::extension(material, "KHR_materials_emissive_strength")) {
      float strength = std::clamp(number_in(*brighter, "emissiveMultiplier", 1), 0.0f, 1e9f);
      material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
    }
  }
  const json* version_0 = gltf::extension(file.root, "VRM");
  if (!version_0 || gltf::extension(file.root, "VRMC_vrm")) return cartoons;
  const json properties = list_in(file, *version_0, "materialProperties", "/extensions/VRM");
  for (size_t m = 0; m < std::min(count, properties.size()); m++) {
    std::string where = at("/extensions/VRM/materialProperties", m),
                shader = text_in(properties[m], "shader");
    rewrite_version_0(file, properties[m], where, file.root["materials"][m]);
    if (shader.find("MToon") != std::string::npos)
      tell_unseen_of_version_0(file, properties[m], where);
    if (shader.find("MToon") != std::string::npos || shader.find("Unlit") != std::string::npos)
      cartoons.insert(m);
  }
  return cartoons;
}

}  // namespace wellspring::avatar
