// SPDX-License-Identifier: Apache-2.0
#include "mitsuba_scene.h"

#include "base/load_error.h"
#include "frame/picture_file.h"
#include "mitsuba_mesh.h"
#include "scenes/build.h"
#include "world/texture.h"

namespace wellspring::mitsuba {
namespace {

struct Conversion {
  const Document& document;
  ReferenceScene& out;
  int black = 0;  // material of the back of a one-sided sheet
};

constexpr int unbounded = 1000;  // edges

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw LoadError{"scene", where, "cannot be expressed: " + what};
}

std::string type_of(pugi::xml_node node) { return node.attribute("type").value(); }

vec3 color_value(pugi::xml_node node, vec3 otherwise) {
  if (!node) return otherwise;
  std::string kind = node.name(), value = node.attribute("value").value();
  if (kind == "spectrum") return spectrum_to_rgb(value);
  if (kind == "rgb" || kind == "float") return vec3(parse_vector(value));
  refuse(kind, "as a colour");
}

int add_texture(Conversion& c, pugi::xml_node node, TextureRef& reference) {
  if (type_of(node) != "bitmap") refuse(type_of(node), "texture");
  Image image;
  int64_t texels_left = image_texel_limit;
  auto file = find_file(c.document, text(node, "filename", ""));
  std::string problem =
      decode_image(read_bytes(file), !boolean(node, "raw", false), image, texels_left);
  if (!problem.empty()) throw LoadError{file.string(), "", problem};
  Texture texture;
  texture.image = int(c.out.scene.images.size());
  std::string wrap = text(node, "wrap_mode", "repeat");
  texture.wrap_u = texture.wrap_v = wrap == "clamp"    ? Wrap::clamp
                                    : wrap == "mirror" ? Wrap::mirror
                                                       : Wrap::repeat;
  texture.nearest = text(node, "filter_type", "bilinear") == "nearest";
  glm::dmat4 m = transform(node, "to_uv");
  reference.uv_transform =
      mat3(vec3(m[0][0], m[0][1], 0), vec3(m[1][0], m[1][1], 0), vec3(m[3][0], m[3][1], 1));
  reference.texture = int(c.out.scene.textures.size());
  c.out.scene.images.push_back(std::move(image));
  c.out.scene.textures.push_back(texture);
  return texture.image;
}

double index_named(pugi::xml_node bsdf, const char* name, double otherwise) {
  pugi::xml_node node = find_property(bsdf, name);
  if (!node) return otherwise;
  std::string value = node.attribute("value").value();
  if (std::string(node.name()) == "float") return node.attribute("value").as_double();
  static const std::map<std::string, double> known = {
      {"air", 1.000277}, {"vacuum", 1.0}, {"bk7", 1.5046}, {"diamond", 2.419}, {"water", 1.3330}};
  auto found = known.find(value);
  if (found == known.end()) refuse(value, "index of refraction");
  return found->second;
}

// A material and what is special about the surface that wears it.
struct Appearance {
  Material material;
  std::string inexact;                 // why
  bool two_sided = false;              // else its back is black
  std::string attribute;               // the mesh's attribute that becomes its vertex colours
  vec3 blend[2] = {vec3(0), vec3(1)};  // two colours, mixed by a weight
};

Appearance make_appearance(Conversion& c, pugi::xml_node bsdf);

Appearance make_diffuse(Conversion& c, pugi::xml_node bsdf) {
  Appearance look;
  look.material = scenes::diffuse(vec3(0.5f));
  pugi::xml_node reflectance = find_property(bsdf, "reflectance");
  pugi::xml_node value = resolve(c.document, reflectance);
  if (value && std::string(value.name()) == "texture") {
    look.material.base_color = vec4(1);
    if (type_of(value) == "mesh_attribute") look.attribute = text(value, "name", "");
    else add_texture(c, value, look.material.base_color_texture);
  } else {
    look.material.base_color = vec4(color_value(value, vec3(0.5f)), 1);
  }
  return look;
}

// Opacity: the picture's grey, decoded, as alpha under the nested material's colour.
Appearance make_mask(Conversion& c, pugi::xml_node bsdf) {
  Appearance look = make_appearance(c, bsdf.child("bsdf"));
  if (look.material.base_color_texture.texture >= 0) refuse("mask", "over a texture");
  int index = add_texture(c, find_property(bsdf, "opacity"), look.material.base_color_texture);
  Image& image = c.out.scene.images[size_t(index)];
  for (size_t i = 0; i < image.texels8.size(); i += 4)
    image.texels.push_back(vec4(1, 1, 1, decode_srgb(image.texels8[i])));
  image.texels8.clear();
  look.material.alpha_mode = AlphaMode::blend;
  return look;
}

Appearance make_appearance(Conversion& c, pugi::xml_node bsdf) {
  std::string type = type_of(bsdf);
  Appearance look;
  if (!bsdf || type == "diffuse") return make_diffuse(c, bsdf);
  if (type == "twosided") {
    look = make_appearance(c, bsdf.child("bsdf"));
    look.two_sided = true;
  } else if (type == "mask") {
    look = make_mask(c, bsdf);
  } else if (type == "blendbsdf") {
    look.material = scenes::diffuse(vec3(1));
    look.attribute = text(resolve(c.document, find_property(bsdf, "weight")), "name", "");
    int i = 0;
    for (pugi::xml_node part : bsdf.children("bsdf"))
      if (i < 2) look.blend[i++] = vec3(make_appearance(c, part).material.base_color);
  } else if (type == "dielectric" || type == "roughdielectric") {
    double ior = index_named(bsdf, "int_ior", 1.5046) / index_named(bsdf, "ext_ior", 1.000277);
    float alpha = type == "dielectric" ? 0 : float(number(bsdf, "alpha", 0.1));
    look.material = scenes::glass(float(ior), std::sqrt(alpha), 1);
    look.two_sided = true;
    if (alpha > 0) look.inexact = type;
  } else {
    look.material = scenes::diffuse(vec3(0));
    look.inexact = type;
  }
  return look;
}

MeshWithAttributes load_shape(Conversion& c, pugi::xml_node shape) {
  std::string type = type_of(shape), file = text(shape, "filename", "");
  if (type == "obj") return load_obj(find_file(c.document, file));
  if (type == "ply") return load_ply(find_file(c.document, file));
  if (type == "rectangle") return make_rectangle();
  if (type == "sphere") return make_sphere();
  refuse(type, "shape");
}

void apply_attribute(const Appearance& look, MeshWithAttributes& m) {
  bool of_faces = look.attribute.rfind("face_", 0) == 0;
  if (of_faces) split_faces(m);
  for (size_t i = 0; i < m.mesh.positions.size(); i++) {
    vec3 color = look.attribute == "vertex_color" ? m.vertex_color.at(i)
                 : look.attribute == "face_color" ? m.face_color.at(i / 3)
                 : look.attribute == "face_weight"
                     ? glm::mix(look.blend[0], look.blend[1], m.face_weight.at(i / 3))
                     : vec3(-1);
    if (color.x < 0) refuse(look.attribute, "mesh attribute");
    m.mesh.colors.push_back(vec4(color, 1));
  }
}

pugi::xml_node bsdf_of(const Conversion& c, pugi::xml_node shape) {
  for (pugi::xml_node child : shape.children()) {
    pugi::xml_node node = resolve(c.document, child);
    if (std::string(node.name()) == "bsdf") return node;
  }
  return {};
}

pugi::xml_node emitter_of(const Conversion& c, pugi::xml_node shape) {
  for (pugi::xml_node child : shape.children()) {
    pugi::xml_node node = resolve(c.document, child);
    if (std::string(node.name()) == "emitter") return node;
  }
  return {};
}

void add_shape(Conversion& c, pugi::xml_node shape, const glm::dmat4& outer) {
  std::string type = type_of(shape);
  if (type == "shapegroup") return;
  if (type == "instance") {
    for (pugi::xml_node part : resolve(c.document, shape.child("ref")).children("shape"))
      add_shape(c, part, outer * transform(shape));
    return;
  }
  Scene& scene = c.out.scene;
  MeshWithAttributes m = load_shape(c, shape);
  Appearance look = make_appearance(c, bsdf_of(c, shape));
  if (pugi::xml_node emitter = emitter_of(c, shape)) {
    if (type_of(emitter) != "area") refuse(type_of(emitter), "emitter of a shape");
    look.material.emission = color_value(find_property(emitter, "radiance"), vec3(1));
  }
  if (!look.attribute.empty()) apply_attribute(look, m);
  m.mesh.material = scenes::add_material(scene, look.material);
  mat4 to_world(outer * transform(shape));
  if (!look.two_sided && !is_closed(m.mesh)) {
    // The back of a sheet: just behind, turned round, black, with the same holes.
    Mesh back = m.mesh;
    Material material = scenes::diffuse(vec3(0));
    material.base_color_texture = look.material.base_color_texture;
    material.alpha_mode = look.material.alpha_mode;
    back.material = scenes::add_material(scene, material);
    for (uvec3& t : back.triangles) std::swap(t.y, t.z);
    for (size_t i = 0; i < back.positions.size(); i++) back.positions[i] -= 1e-4f * back.normals[i];
    for (vec3& n : back.normals) n = -n;
    scenes::add_mesh(scene, back, "back", to_world);
  }
  int instance = scenes::add_mesh(scene, m.mesh, type.c_str(), to_world);
  if (!look.inexact.empty()) c.out.inexact[uint32_t(instance)] = look.inexact;
}

// Mitsuba's first and last rows are the poles: it looks up row v (height - 1). Made into rows of
// ours, four for each of its own, and turned by half a revolution.
void add_envmap(Conversion& c, pugi::xml_node emitter) {
  if (find_property(emitter, "to_world")) refuse("envmap", "turned");
  Frame frame = load_linear_picture(find_file(c.document, text(emitter, "filename", "")).string());
  int w = frame.width, h = 4 * (frame.height - 1);
  Image image;
  image.width = w;
  image.height = h;
  for (int y = 0; y < h; y++) {
    float at = (float(y) + 0.5f) / 4;
    int row = std::min(int(at), frame.height - 2);
    for (int x = 0; x < w; x++) {
      size_t from = size_t(row) * size_t(w) + size_t((x + w / 2) % w);
      image.texels.push_back(
          vec4(glm::mix(frame.color[from], frame.color[from + size_t(w)], at - float(row)), 1));
    }
  }
  c.out.scene.environment = {vec3(float(number(emitter, "scale", 1))),
                             int(c.out.scene.images.size())};
  c.out.scene.images.push_back(std::move(image));
}

void add_emitter(Conversion& c, pugi::xml_node emitter) {
  std::string type = type_of(emitter);
  PunctualLight light;
  if (type == "constant") {
    c.out.scene.environment.radiance = color_value(find_property(emitter, "radiance"), vec3(1));
  } else if (type == "envmap") {
    add_envmap(c, emitter);
  } else if (type == "point") {
    light.intensity = color_value(find_property(emitter, "intensity"), vec3(1));
    light.position = vec3(transform(emitter)[3]);
    if (pugi::xml_node p = find_property(emitter, "position"))
      light.position = {p.attribute("x").as_float(), p.attribute("y").as_float(),
                        p.attribute("z").as_float()};
    c.out.scene.lights.push_back(light);
  } else if (type == "directional") {
    light.type = PunctualType::directional;
    light.direction = normalize(vec3(parse_vector(text(emitter, "direction", "0,0,1"))));
    light.intensity = color_value(find_property(emitter, "irradiance"), vec3(1));
    c.out.scene.lights.push_back(light);
  } else if (type != "area") {  // area emitters stand alone only to be referred to
    refuse(type, "emitter");
  }
}

void set_view(ReferenceScene& out, pugi::xml_node sensor) {
  if (type_of(sensor) != "perspective") refuse(type_of(sensor), "sensor");
  pugi::xml_node film = sensor.child("film");
  View& view = out.view;
  view.width = int(number(film, "width", 768));
  view.height = int(number(film, "height", 576));
  glm::dmat4 m = transform(sensor);
  view.position = vec3(m[3]);
  view.forward = normalize(vec3(m[2]));
  view.up = normalize(vec3(m[1]));
  view.right = -normalize(vec3(m[0]));
  double aspect = double(view.height) / view.width, half = 0;
  if (find_property(sensor, "fov")) {
    half = std::tan(0.5 * glm::radians(number(sensor, "fov", 0)));
    std::string axis = text(sensor, "fov_axis", "x");
    bool across = axis == "x" || (axis == "smaller" ? aspect >= 1 : axis == "larger" && aspect < 1);
    if (axis == "diagonal") refuse(axis, "field of view");
    if (across) half *= aspect;
  } else {  // a lens of 50 mm before 36 x 24 mm of film, along the diagonal
    half = std::hypot(36.0, 24.0) / (2 * 50) * aspect / std::hypot(1.0, aspect);
  }
  view.tan_half_fov = float(half);
  std::string filter = film.child("rfilter") ? type_of(film.child("rfilter")) : "gaussian";
  if (filter != "box" && filter != "gaussian") refuse(filter, "pixel filter");
  out.gaussian_filter = filter == "gaussian";
}

// Mitsuba counts passages through glass as edges, our walks do not. In pictures of two edges, glass
// is its reflection alone.
void bound_glass(ReferenceScene& reference) {
  for (Material& material : reference.scene.materials) {
    if (material.transmission == 0 || reference.max_depth >= unbounded) continue;
    if (reference.max_depth != 2) refuse("glass", "in a picture of more than two edges");
    material.transmission = material.thickness = 0;
    material.base_color = vec4(0, 0, 0, 1);
  }
}

}  // namespace

ReferenceScene load_reference_scene(const std::filesystem::path& file) {
  Document document;
  load_document(file, document);
  ReferenceScene out;
  out.scene = scenes::empty_scene();
  Conversion c{document, out};
  for (pugi::xml_node node : document.root().children()) {
    std::string kind = node.name();
    if (kind == "shape") add_shape(c, node, glm::dmat4(1));
    if (kind == "emitter") add_emitter(c, node);
    if (kind == "sensor") set_view(out, node);
    if (kind == "integrator") {
      pugi::xml_node inner = node.child("integrator") ? node.child("integrator") : node;
      out.max_depth = type_of(inner) == "direct" ? 2 : int(number(inner, "max_depth", -1));
      if (out.max_depth < 0) out.max_depth = unbounded;
    }
  }
  bound_glass(out);
  return out;
}

}  // namespace wellspring::mitsuba
