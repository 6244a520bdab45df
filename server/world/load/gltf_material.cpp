// SPDX-License-Identifier: Apache-2.0
// Reads materials by glTF 2.0 sections 3.8 and 3.9 and the KHR_materials_ extensions.
#include "world/load/gltf_material.h"

#include <cmath>
#include <map>

#include "base/worker.h"
#include "gltf/data.h"
#include "gltf/file.h"
#include "world/texture.h"

namespace wellspring::world {
namespace {

using nlohmann::json;

class Materials {
 public:
  Materials(File& file, Scene& scene) : file_(file), scene_(scene) {}

  Material make(const json& object, const std::string& where) {
    Material m;
    m.name = text(object, "name");
    if (const json* pbr = find(object, "pbrMetallicRoughness"))
      metallic_roughness(*pbr, where + "/pbrMetallicRoughness", m);
    else if (const json* pbr = extension(object, "KHR_materials_pbrSpecularGlossiness"))
      specular_glossiness(*pbr, where + "/extensions/KHR_materials_pbrSpecularGlossiness", m);
    m.normal_texture = reference(object, "normalTexture", where, false);
    if (const json* normal = find(object, "normalTexture"))
      m.normal_scale = to_float(number(*normal, "scale", 1));
    m.emission = vec3(numbers<3>(object, "emissiveFactor", where, vec4(0), 0, 1e9f));
    if (const json* strength = extension(object, "KHR_materials_emissive_strength"))
      m.emission *= factor(*strength, "emissiveStrength", where, 1, 0, 1e9f);
    m.emission_texture = reference(object, "emissiveTexture", where, true);
    alpha(object, where, m);
    m.double_sided = boolean(object, "doubleSided", false);
    m.unlit = extension(object, "KHR_materials_unlit") != nullptr;
    transmission(object, where, m);
    gloss(object, where + "/extensions/", m);
    layers(object, where + "/extensions/", m);
    return m;
  }

 private:
  // Returns a factor clamped to its range, with a warning if that changed it.
  float factor(const json& object, const char* key, const std::string& where, float otherwise,
               float low, float high) {
    float value = to_float(number(object, key, otherwise));
    float clamped = glm::clamp(value, low, high);
    if (clamped != value) warn(file_, where, std::string(key) + " is out of range and clamped");
    return clamped;
  }

  template <int N>
  vec4 numbers(const json& object, const char* key, const std::string& where, vec4 otherwise,
               float low, float high) {
    const json* list = find(object, key);
    if (!list) return otherwise;
    vec4 result = otherwise;
    for (int i = 0; i < N; i++) {
      float value = to_float((*list)[size_t(i)].get<double>());
      result[i] = glm::clamp(value, low, high);
      if (result[i] != value) warn(file_, where, std::string(key) + " is out of range and clamped");
    }
    return result;
  }

  void metallic_roughness(const json& pbr, const std::string& where, Material& m) {
    m.base_color = numbers<4>(pbr, "baseColorFactor", where, vec4(1), 0, 1);
    m.base_color_texture = reference(pbr, "baseColorTexture", where, true);
    m.metallic = factor(pbr, "metallicFactor", where, 1, 0, 1);
    m.roughness = factor(pbr, "roughnessFactor", where, 1, 0, 1);
    m.metallic_roughness_texture = reference(pbr, "metallicRoughnessTexture", where, false);
  }

  // Converts KHR_materials_pbrSpecularGlossiness by its appendix "best practices": metalness is the
  // value with which a dielectric's 4 % and the diffuse colour explain the specular one.
  void specular_glossiness(const json& pbr, const std::string& where, Material& m) {
    vec4 diffuse = numbers<4>(pbr, "diffuseFactor", where, vec4(1), 0, 1);
    vec3 specular = vec3(numbers<3>(pbr, "specularFactor", where, vec4(1), 0, 1));
    m.roughness = 1 - factor(pbr, "glossinessFactor", where, 1, 0, 1);
    m.base_color_texture = reference(pbr, "diffuseTexture", where, true);
    m.base_color = diffuse;
    m.metallic = 0;
    if (find(pbr, "specularGlossinessTexture")) {
      warn(file_, where, "specularGlossinessTexture is not used; the factors alone count");
      return;
    }
    constexpr float dielectric = 0.04f;
    auto brightness = [](vec3 c) {
      return std::sqrt(0.299f * c.x * c.x + 0.587f * c.y * c.y + 0.114f * c.z * c.z);
    };
    float strength = max_component(specular), rest = 1 - strength;
    float d = brightness(vec3(diffuse)), s = brightness(specular);
    if (s > dielectric) {
      float b = d * rest / (1 - dielectric) + s - 2 * dielectric, c = dielectric - s;
      float root = std::sqrt(std::max(b * b - 4 * dielectric * c, 0.0f));
      m.metallic = glm::clamp((root - b) / (2 * dielectric), 0.0f, 1.0f);
    }
    vec3 from_diffuse = vec3(diffuse) * (rest / (1 - dielectric) / std::max(1 - m.metallic, 1e-4f));
    vec3 from_specular = (specular - dielectric * (1 - m.metallic)) / std::max(m.metallic, 1e-4f);
    m.base_color =
        vec4(glm::clamp(glm::mix(from_diffuse, from_specular, m.metallic * m.metallic), 0.0f, 1.0f),
             diffuse.w);
  }

  void alpha(const json& object, const std::string& where, Material& m) {
    std::string mode = text(object, "alphaMode", "OPAQUE");
    if (mode == "MASK") m.alpha_mode = AlphaMode::mask;
    else if (mode == "BLEND") m.alpha_mode = AlphaMode::blend;
    else if (mode != "OPAQUE") warn(file_, where + "/alphaMode", "unknown; shown opaque");
    m.alpha_cutoff = factor(object, "alphaCutoff", where, 0.5f, 0, 1e9f);
  }

  void transmission(const json& object, const std::string& where, Material& m) {
    const std::string place = where + "/extensions/";
    if (const json* ior = extension(object, "KHR_materials_ior")) {
      m.ior = to_float(number(*ior, "ior", 1.5));
      if (m.ior == 0) {
        m.ior = 1000;  // 0 means that all light is reflected at every angle; this reflects 99.6 %
      } else if (m.ior < 1) {
        warn(file_, place + "KHR_materials_ior", "an index of refraction below 1 is taken as 1");
        m.ior = 1;
      }
    }
    if (const json* glass = extension(object, "KHR_materials_transmission")) {
      const std::string inner = place + "KHR_materials_transmission";
      m.transmission = factor(*glass, "transmissionFactor", inner, 0, 0, 1);
      m.transmission_texture = reference(*glass, "transmissionTexture", inner, false);
    }
    if (const json* volume = extension(object, "KHR_materials_volume")) {
      const std::string inner = place + "KHR_materials_volume";
      m.thickness = factor(*volume, "thicknessFactor", inner, 0, 0, 1e9f);
      m.thickness_texture = reference(*volume, "thicknessTexture", inner, false);
      m.attenuation_color = vec3(numbers<3>(*volume, "attenuationColor", inner, vec4(1), 0, 1));
      if (find(*volume, "attenuationDistance")) {
        m.attenuation_distance = factor(*volume, "attenuationDistance", inner, 1, 0, 1e30f);
        if (m.attenuation_distance == 0) m.attenuation_distance = 1e-6f;
      }
    }
  }

  // Reads how the base reflects.
  void gloss(const json& object, const std::string& place, Material& m) {
    if (const json* specular = extension(object, "KHR_materials_specular")) {
      const std::string inner = place + "KHR_materials_specular";
      m.specular = factor(*specular, "specularFactor", inner, 1, 0, 1);
      m.specular_texture = reference(*specular, "specularTexture", inner, false);
      m.specular_color =
          vec3(numbers<3>(*specular, "specularColorFactor", inner, vec4(1), 0, 1e9f));
      m.specular_color_texture = reference(*specular, "specularColorTexture", inner, true);
    }
    if (const json* brushed = extension(object, "KHR_materials_anisotropy")) {
      const std::string inner = place + "KHR_materials_anisotropy";
      m.anisotropy = factor(*brushed, "anisotropyStrength", inner, 0, 0, 1);
      m.anisotropy_rotation = to_float(number(*brushed, "anisotropyRotation", 0));
      m.anisotropy_texture = reference(*brushed, "anisotropyTexture", inner, false);
    }
    if (const json* bends = extension(object, "KHR_materials_dispersion"))
      m.dispersion = factor(*bends, "dispersion", place + "KHR_materials_dispersion", 0, 0, 1e3f);
  }

  // Reads the layers on the base.
  void layers(const json& object, const std::string& place, Material& m) {
    if (const json* coat = extension(object, "KHR_materials_clearcoat")) {
      const std::string inner = place + "KHR_materials_clearcoat";
      m.clearcoat = factor(*coat, "clearcoatFactor", inner, 0, 0, 1);
      m.clearcoat_texture = reference(*coat, "clearcoatTexture", inner, false);
      m.clearcoat_roughness = factor(*coat, "clearcoatRoughnessFactor", inner, 0, 0, 1);
      m.clearcoat_roughness_texture = reference(*coat, "clearcoatRoughnessTexture", inner, false);
      m.clearcoat_normal_texture = reference(*coat, "clearcoatNormalTexture", inner, false);
      if (const json* normal = find(*coat, "clearcoatNormalTexture"))
        m.clearcoat_normal_scale = to_float(number(*normal, "scale", 1));
    }
    if (const json* sheen = extension(object, "KHR_materials_sheen")) {
      const std::string inner = place + "KHR_materials_sheen";
      m.sheen_color = vec3(numbers<3>(*sheen, "sheenColorFactor", inner, vec4(0), 0, 1));
      m.sheen_color_texture = reference(*sheen, "sheenColorTexture", inner, true);
      m.sheen_roughness = factor(*sheen, "sheenRoughnessFactor", inner, 0, 0, 1);
      m.sheen_roughness_texture = reference(*sheen, "sheenRoughnessTexture", inner, false);
    }
  }

  TextureRef reference(const json& object, const char* key, const std::string& where, bool srgb) {
    TextureRef result;
    const json* info = find(object, key);
    if (!info) return result;
    const std::string place = where + "/" + key;
    int64_t set = integer(*info, "texCoord", 0);
    if (const json* transform = extension(*info, "KHR_texture_transform")) {
      set = integer(*transform, "texCoord", set);
      result.uv_transform = texture_transform(*transform);
    }
    if (set > 1) {
      warn(file_, place, "texture coordinates beyond the second set are not read");
      return result;
    }
    result.uv_set = int(set);
    result.texture = texture(size_t(integer(*info, "index", 0)), srgb, place);
    return result;
  }

  // Returns translation * rotation * scale; the rotation turns the picture clockwise, v pointing
  // down.
  static mat3 texture_transform(const json& object) {
    vec2 offset{0}, scale{1};
    for (int i = 0; i < 2; i++) {
      if (const json* list = find(object, "offset"))
        offset[i] = to_float((*list)[size_t(i)].get<double>());
      if (const json* list = find(object, "scale"))
        scale[i] = to_float((*list)[size_t(i)].get<double>());
    }
    double angle = number(object, "rotation", 0);
    float c = float(std::cos(angle)), s = float(std::sin(angle));
    return mat3(c * scale.x, -s * scale.x, 0, s * scale.y, c * scale.y, 0, offset.x, offset.y, 1);
  }

  // Returns the scene texture of the file's texture `index`, read as colour or as numbers; -1:
  // none.
  int texture(size_t index, bool srgb, const std::string& user) {
    auto [known, fresh] = textures_.try_emplace({index, srgb}, -1);
    if (!fresh) return known->second;
    const std::string where = at("/textures", index);
    const json& object = items(file_.root, "textures")[index];
    const json* webp = extension(object, "EXT_texture_webp");
    const json* source = webp ? find(*webp, "source") : find(object, "source");
    if (!source) {
      warn(file_, where, "has no picture this program can read (used by " + user + ")");
      return -1;
    }
    Texture made;
    made.image = image(source->get<size_t>(), srgb);
    if (made.image < 0) return -1;
    if (const json* sampler = find(object, "sampler")) {
      const std::string place = at("/samplers", sampler->get<size_t>());
      const json& s = items(file_.root, "samplers")[sampler->get<size_t>()];
      made.wrap_u = wrap(s, "wrapS", place);
      made.wrap_v = wrap(s, "wrapT", place);
      made.nearest = integer(s, "magFilter", 9729) == 9728;
    }
    scene_.textures.push_back(made);
    return known->second = int(scene_.textures.size()) - 1;
  }

  Wrap wrap(const json& sampler, const char* key, const std::string& where) {
    switch (integer(sampler, key, 10497)) {
      case 33071: return Wrap::clamp;
      case 33648: return Wrap::mirror;
      case 10497: return Wrap::repeat;
    }
    warn(file_, where + "/" + key, "unknown wrap mode; the picture repeats");
    return Wrap::repeat;
  }

  int image(size_t index, bool srgb) {
    auto [known, fresh] = images_.try_emplace({index, srgb}, -1);
    if (!fresh) return known->second;
    check_cancelled();
    const std::string where = at("/images", index);
    const json& object = items(file_.root, "images")[index];
    Image made;
    std::string uri_text = text(object, "uri");
    made.name = text(object, "name", is_data_uri(uri_text) ? "" : uri_text.substr(0, 100));
    std::string problem;
    if (const json* uri = find(object, "uri")) {
      std::optional<Bytes> bytes = read_uri(file_, where + "/uri", uri->get<std::string>());
      if (!bytes) {
        warn(file_, where + "/uri", no_such_file(file_, where + "/uri", uri_text));
        return -1;
      }
      problem = decode_image(*bytes, srgb, made, texels_left_);
    } else if (const json* view = find(object, "bufferView")) {
      problem = decode_image(view_bytes(file_, view->get<size_t>()), srgb, made, texels_left_);
    } else {
      problem = "has neither uri nor bufferView";
    }
    if (!problem.empty() && file_.pictures_may_fail) {
      warn(file_, where, problem);
      return -1;
    }
    if (!problem.empty()) refuse(file_, where, problem);
    scene_.images.push_back(std::move(made));
    return known->second = int(scene_.images.size()) - 1;
  }

  File& file_;
  Scene& scene_;
  std::map<std::pair<size_t, bool>, int> textures_, images_;
  int64_t texels_left_ = image_texel_limit;
};

}  // namespace

void load_materials(File& file, Scene& scene) {
  Materials materials(file, scene);
  Material plain;
  plain.name = "default";
  scene.materials.push_back(plain);
  const json& list = items(file.root, "materials");
  for (size_t i = 0; i < list.size(); i++)
    scene.materials.push_back(materials.make(list[i], at("/materials", i)));
}

}  // namespace wellspring::world
