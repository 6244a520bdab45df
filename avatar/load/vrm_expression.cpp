// SPDX-License-Identifier: Apache-2.0
// Reads whole expressions of either version of VRM: "blendShapeMaster" of 0.x, "expressions" of
// 1.0. Both say the same with other words; version 0 describes materials in Unity's terms.
#include <algorithm>
#include <cctype>
#include <map>

#include "avatar/load/vrm_extension.h"
#include "avatar/load/vrm_json.h"

namespace wellspring::avatar {
namespace {

using nlohmann::json;

using namespace vrm_json;

constexpr size_t bind_limit = 20'000;
const char* const unseen =
    "expressions change base colours, emission and where pictures lie; shade, rim, matcap "
    "and outline colours, which cartoons have, are not shown";

std::string preset_of_version_0(std::string preset) {
  static const std::map<std::string, std::string> names = {{"a", "aa"},
                                                           {"i", "ih"},
                                                           {"u", "ou"},
                                                           {"e", "ee"},
                                                           {"o", "oh"},
                                                           {"joy", "happy"},
                                                           {"angry", "angry"},
                                                           {"sorrow", "sad"},
                                                           {"fun", "relaxed"},
                                                           {"blink", "blink"},
                                                           {"blink_l", "blinkLeft"},
                                                           {"blink_r", "blinkRight"},
                                                           {"lookup", "lookUp"},
                                                           {"lookdown", "lookDown"},
                                                           {"lookleft", "lookLeft"},
                                                           {"lookright", "lookRight"},
                                                           {"neutral", "neutral"}};
  std::transform(preset.begin(), preset.end(), preset.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  auto found = names.find(preset);
  return found == names.end() ? "" : found->second;
}

ExpressionOverride override_in(const json& object, const char* key) {
  std::string kind = text_in(object, key);
  return kind == "block"   ? ExpressionOverride::block
         : kind == "blend" ? ExpressionOverride::blend
                           : ExpressionOverride::none;
}

float usable(const json& number) {
  constexpr double most = 1e6;
  return float(std::clamp(number.get<double>(), -most, most));
}

vec4 target_in(const json& bind) {
  vec4 target(1);
  const json* list = bind.is_object() ? gltf::find(bind, "targetValue") : nullptr;
  for (size_t c = 0; list && list->is_array() && c < std::min<size_t>(list->size(), 4); c++)
    if ((*list)[c].is_number()) target[int(c)] = usable((*list)[c]);
  return target;
}

// Says how a version writes the morph targets of an expression: `of` names their holder, a mesh of
// the file or a node; weights are in parts of `full`.
struct Form {
  const char *binds, *of, *into;
  float full;
};
constexpr Form version_0{"binds", "mesh", "meshes", 100},
    version_1{"morphTargetBinds", "node", "nodes", 1};

struct ExpressionReader {
  File& file;
  Vrm& vrm;
  size_t binds = 0;

  bool has_room(const std::string& where) {
    if (++binds <= bind_limit) return true;
    gltf::warn(file, where,
               "expressions beyond " + std::to_string(bind_limit) + " binds are left out");
    return false;
  }

  // Reads what both versions have in common.
  VrmExpression begin(const json& object, const Form& form, const std::string& where) {
    if (!object.is_object()) gltf::refuse(file, where, "must be an object");
    VrmExpression expression;
    const json* binary = gltf::find(object, "isBinary");
    expression.binary = binary && binary->is_boolean() && binary->get<bool>();
    expression.overrides = {override_in(object, "overrideBlink"),
                            override_in(object, "overrideLookAt"),
                            override_in(object, "overrideMouth")};
    const json& list = list_in(file, object, form.binds, where);
    for (size_t b = 0; b < list.size(); b++) {
      int index = index_in(file, list[b], form.of, form.into, at(at(where, form.binds), b));
      if (index < 0 || !has_room(where)) continue;
      VrmBind bind;
      (form.full == 1 ? bind.node : bind.mesh) = index;
      bind.target = size_t(std::clamp(number_in(list[b], "index", 0), 0.0f, 1e6f));
      bind.weight = number_in(list[b], "weight", form.full) / form.full;
      expression.binds.push_back(bind);
    }
    return expression;
  }

  void add_colors(const json& object, const std::string& where, VrmExpression& expression) {
    const json& list = list_in(file, object, "materialColorBinds", where);
    for (size_t b = 0; b < list.size(); b++) {
      int material =
          index_in(file, list[b], "material", "materials", at(where + "/materialColorBinds", b));
      std::string type = text_in(list[b], "type");
      if (material < 0 || !has_room(where)) continue;
      if (type != "color" && type != "emissionColor") gltf::warn(file, where, unseen);
      else
        expression.colors.push_back(
            {size_t(material), type == "emissionColor", target_in(list[b])});
    }
  }

  void add_pictures(const json& object, const std::string& where, VrmExpression& expression) {
    const json& list = list_in(file, object, "textureTransformBinds", where);
    for (size_t b = 0; b < list.size(); b++) {
      std::string place = at(where + "/textureTransformBinds", b);
      int material = index_in(file, list[b], "material", "materials", place);
      if (material < 0 || !has_room(where)) continue;
      auto pair = [&](const char* key, float otherwise) {
        const json& numbers = list_in(file, list[b], key, place);
        vec2 v(otherwise);
        for (size_t c = 0; c < std::min<size_t>(numbers.size(), 2); c++)
          if (numbers[c].is_number()) v[int(c)] = usable(numbers[c]);
        return v;
      };
      expression.pictures.push_back(
          {size_t(material), {true, true}, pair("scale", 1), pair("offset", 0)});
    }
  }

  // Reads version 0's materials and their shader's properties, by name. Colours there are encoded
  // as sRGB; pictures lie by scale and offset from below.
  void add_values(const json& object, const std::string& where, VrmExpression& expression) {
    const json& materials = gltf::items(file.root, "materials");
    const json& list = list_in(file, object, "materialValues", where);
    for (size_t v = 0; v < list.size(); v++) {
      std::string name = text_in(list[v], "materialName"),
                  property = text_in(list[v], "propertyName");
      vec4 target = target_in(list[v]);
      bool color = property == "_Color", emission = property == "_EmissionColor";
      bool both = property == "_MainTex_ST", u = both || property == "_MainTex_ST_S",
           w = both || property == "_MainTex_ST_T";
      if (!color && !emission && !u && !w) {
        gltf::warn(file, where, unseen);
        continue;
      }
      bool known = false;
      for (size_t m = 0; m < materials.size(); m++) {
        if (gltf::text(materials[m], "name") != name || !has_room(where)) continue;
        known = true;
        if (color || emission)
          expression.colors.push_back({m, emission, vec4(linear_of_unity(vec3(target)), target.w)});
        else
          expression.pictures.push_back(
              {m, {u, w}, vec2(target), {target.z, 1 - target.w - target.y}});
      }
      if (!known) gltf::warn(file, where, "an expression changes materials that the file has not");
    }
  }
};

}  // namespace

void read_vrm_expressions(File& file, const json& object, Vrm& vrm) {
  ExpressionReader reader{file, vrm};
  if (vrm.version == 0) {
    const std::string root = "/extensions/VRM/blendShapeMaster";
    const json& master = object_in(file, object, "blendShapeMaster", "/extensions/VRM");
    const json& groups = list_in(file, master, "blendShapeGroups", root);
    for (size_t g = 0; g < groups.size(); g++) {
      std::string where = at(root + "/blendShapeGroups", g), name = text_in(groups[g], "name");
      VrmExpression expression = reader.begin(groups[g], version_0, where);
      expression.name = preset_of_version_0(text_in(groups[g], "presetName"));
      // Version 0 has no preset for surprise; authors use this name.
      if (expression.name.empty() && name == "Surprised") expression.name = "surprised";
      expression.preset = !expression.name.empty();
      if (!expression.preset) expression.name = name;
      reader.add_values(groups[g], where, expression);
      vrm.expressions.push_back(std::move(expression));
    }
    return;
  }
  const std::string root = "/extensions/VRMC_vrm/expressions";
  const json& kinds = object_in(file, object, "expressions", "/extensions/VRMC_vrm");
  for (const char* kind : {"preset", "custom"}) {
    const json& list = object_in(file, kinds, kind, root);
    for (auto it = list.begin(); it != list.end(); ++it) {
      std::string where = at(at(root, std::string(kind)), it.key());
      VrmExpression expression = reader.begin(*it, version_1, where);
      expression.name = it.key();
      expression.preset = kind[0] == 'p';
      reader.add_colors(*it, where, expression);
      reader.add_pictures(*it, where, expression);
      vrm.expressions.push_back(std::move(expression));
    }
  }
}

}  // namespace wellspring::avatar
