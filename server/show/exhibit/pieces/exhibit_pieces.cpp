// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_pieces.h"

#include <algorithm>
#include <array>
#include <optional>

#include "base/load_error.h"
#include "base/unicode.h"
#include "show/exhibit/pieces/exhibit_annotations.h"
#include "show/exhibit/exhibit_files.h"
#include "show/exhibit/exhibit_objects.h"
#include "show/exhibit/pieces/exhibit_lawns.h"
#include "show/exhibit/pieces/exhibit_sources.h"
#include "show/exhibit/pieces/exhibit_scans.h"
#include "show/exhibit/pieces/exhibit_volumes.h"
#include "store/open/open_picture.h"
#include "store/open/spoken_picture.h"
#include "store/picture/sample_picture.h"
#include "store/picture/texels.h"

namespace wellspring::show {
namespace {

constexpr float lip = 0.004f;         // metres of the picture that its frame covers on each side
constexpr float board_depth = 0.02f;  // metres by which a picture without a frame stands off

// Collects flat triangles of a piece: x to the right of who looks at it, y up, z towards them.
struct PieceMesh {
  Mesh mesh;
  // Adds a quad, corners anticlockwise as seen from its front.
  void add(vec3 a, vec3 b, vec3 c, vec3 d) {
    const uint32_t first = uint32_t(mesh.positions.size());
    const vec3 normal = glm::normalize(cross(b - a, d - a));
    for (vec3 p : {a, b, c, d}) mesh.positions.push_back(p), mesh.normals.push_back(normal);
    for (vec2 uv : {vec2(0, 1), vec2(1, 1), vec2(1, 0), vec2(0, 0)}) mesh.uv[0].push_back(uv);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
};

// Makes a frame of four mitred bars around a picture of these half sides, at `depth` before the
// wall: their outer sides, a raised edge, and a slope down to the picture.
PieceMesh make_frame(vec2 half, float width, float depth, float canvas) {
  struct Edge {
    float in, z;  // from the outer edge inwards; before the wall
  };
  const Edge profile[] = {{0, 0},
                          {0, 0.6f * depth},
                          {0.12f * width, 0.92f * depth},
                          {0.3f * width, depth},
                          {0.42f * width, 0.9f * depth},
                          {0.8f * width, canvas + 0.25f * (depth - canvas)},
                          {width, canvas + 0.3f * (depth - canvas)},
                          {width, canvas}};
  const vec2 outer = half - vec2(lip) + vec2(width);
  PieceMesh frame;
  for (size_t i = 0; i + 1 < std::size(profile); i++) {
    const Edge &a = profile[i], &b = profile[i + 1];
    auto corner = [&](const Edge& edge, int k) {
      const vec2 side = outer - vec2(edge.in);
      return vec3(k == 1 || k == 2 ? side.x : -side.x, k >= 2 ? side.y : -side.y, edge.z);
    };
    for (int k = 0; k < 4; k++)
      frame.add(corner(a, k), corner(a, (k + 1) % 4), corner(b, (k + 1) % 4), corner(b, k));
  }
  return frame;
}

// Adds an upright box.
void add_box(PieceMesh& to, vec3 low, vec3 high) {
  const vec3 a(low.x, low.y, high.z), b(high.x, low.y, high.z), c(high.x, high.y, high.z),
      d(low.x, high.y, high.z);
  const vec3 back(0, 0, low.z - high.z);
  to.add(a, b, c, d);
  to.add(b + back, a + back, d + back, c + back);
  to.add(b, b + back, c + back, c);
  to.add(a + back, a, d, d + back);
  to.add(d, c, c + back, d + back);
  to.add(a + back, b + back, b, a);
}

// Makes four legs from the floor to the back of a picture of these half sides, and a bar between
// those of each end. Coordinates are of the scene, turned by -yaw.
PieceMesh make_stand(vec2 half, const mat4& to_upright, float floor) {
  constexpr float leg = 0.03f, inset = 0.04f, bar = 0.018f, bar_height = 0.14f;  // metres
  PieceMesh stand;
  vec3 tops[2][2];
  for (int x : {0, 1})
    for (int y : {0, 1}) {
      const vec2 corner = (half - vec2(inset)) * vec2(x ? 1 : -1, y ? 1 : -1);
      const vec3 top = tops[x][y] = vec3(to_upright * vec4(corner, 0, 1));
      add_box(stand, {top.x - leg, floor, top.z - leg}, {top.x + leg, top.y, top.z + leg});
    }
  for (const auto& end : tops) {
    const vec3 low = glm::min(end[0], end[1]), high = glm::max(end[0], end[1]);
    add_box(stand, {low.x - bar, floor + bar_height - bar, low.z},
            {high.x + bar, floor + bar_height + bar, high.z});
  }
  return stand;
}

void put(Scene& scene, Mesh mesh, int material, const mat4& to_world, uint32_t object) {
  mesh.material = material;
  mesh.name = scene.objects[object];
  scene.instances.push_back({int(scene.meshes.size()), to_world, object});
  scene.meshes.push_back(std::move(mesh));
}

int add_material(Scene& scene, const std::string& name, vec3 color, float roughness, float metal) {
  Material material;
  material.name = name;
  material.base_color = vec4(color, 1);
  material.roughness = roughness, material.metallic = metal;
  scene.materials.push_back(std::move(material));
  return int(scene.materials.size()) - 1;
}

// Adds the picture's small version, and how it is read.
int add_texture(Scene& scene, ExhibitPiece& piece) {
  Image image;
  image.name = piece.id;
  // The light that a picture throws back needs no more.
  Piece small = halve(piece.picture->coarsest);
  image.width = small.width, image.height = small.height;
  image.srgb = true;
  image.texels8 = std::move(small.bytes);
  image.large = piece.picture;
  piece.image = int(scene.images.size());
  scene.images.push_back(std::move(image));
  scene.textures.push_back({piece.image, Wrap::clamp, Wrap::clamp});
  return int(scene.textures.size()) - 1;
}

uint32_t add_object(Scene& scene, const std::string& name) {
  scene.objects.push_back(name);
  if (!scene.object_nodes.empty()) scene.object_nodes.resize(scene.objects.size(), -1);
  return uint32_t(scene.objects.size()) - 1;
}

// Hangs a picture with its back board and its frame. Returns its object.
uint32_t hang(Scene& scene, ExhibitPiece& piece) {
  const PyramidLevel& finest = piece.picture->pyramid->levels().front();
  const float height = float(piece.width * double(finest.height) / double(finest.width));
  const vec2 half(0.5f * piece.width, 0.5f * height);
  const bool framed = piece.frame_width > 0;
  const float canvas = framed ? 0.45f * piece.frame_depth : board_depth;
  // A yaw of 0 faces -Z.
  const mat4 upright = glm::rotate(glm::translate(mat4(1), vec3(piece.position - scene.origin)),
                                   piece.yaw + pi, vec3(0, 1, 0));
  const mat4 tilt =
      glm::rotate(glm::rotate(mat4(1), -piece.pitch, vec3(1, 0, 0)), piece.roll, vec3(0, 0, 1));
  const mat4 to_world = upright * tilt;

  const uint32_t object = add_object(scene, piece.id);
  const int paint = add_material(scene, piece.id, vec3(1), 0.65f, 0);
  scene.materials.back().base_color_texture.texture = add_texture(scene, piece);
  scene.materials[size_t(paint)].large_picture = true;
  PieceMesh front;
  front.add({-half.x, -half.y, canvas}, {half.x, -half.y, canvas}, {half.x, half.y, canvas},
            {-half.x, half.y, canvas});
  put(scene, std::move(front.mesh), paint, to_world, object);

  PieceMesh board;
  const vec3 a(-half.x, -half.y, 0), b(half.x, -half.y, 0), c(half.x, half.y, 0),
      d(-half.x, half.y, 0), up(0, 0, canvas);
  board.add(b, a, d, c);
  for (auto [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, d), std::pair(d, a)})
    board.add(from, to, to + up, from + up);
  put(scene, std::move(board.mesh),
      add_material(scene, piece.id + " board", vec3(0.16f, 0.11f, 0.07f), 0.9f, 0), to_world,
      object);
  if (framed) {
    const int material = add_material(scene, piece.id + " frame", piece.frame_color,
                                      piece.gilt ? 0.4f : 0.6f, piece.gilt ? 1.0f : 0.0f);
    put(scene, make_frame(half, piece.frame_width, piece.frame_depth, canvas).mesh, material,
        to_world, object);
  }
  if (piece.stands) {
    const float floor = float(piece.floor - piece.position.y);
    put(scene, make_stand(half, tilt, floor).mesh,
        add_material(scene, piece.id + " stand", piece.stand_color, 0.6f, 0), upright, object);
  }
  return object;
}

// Returns how much wider than high the coordinates of a material's picture lie on its surfaces; 1
// if they lie nowhere.
double aspect_of(const Scene& scene, int material) {
  double along_u = 0, along_v = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    const int set = scene.materials[size_t(material)].base_color_texture.uv_set;
    if (mesh.material != material || mesh.uv[set].empty()) continue;
    for (const uvec3& t : mesh.triangles) {
      const mat3 turn(instance.to_world);
      const vec3 p = turn * (mesh.positions[t.y] - mesh.positions[t.x]);
      const vec3 q = turn * (mesh.positions[t.z] - mesh.positions[t.x]);
      const vec2 a = mesh.uv[set][t.y] - mesh.uv[set][t.x],
                 b = mesh.uv[set][t.z] - mesh.uv[set][t.x];
      // These are the derivatives of place by coordinate times the triangle's area in coordinates.
      along_u += double(glm::length(p * b.y - q * a.y));
      along_v += double(glm::length(q * a.x - p * b.x));
    }
  }
  return along_u > 0 && along_v > 0 ? along_u / along_v : 1;
}

// Lets a material of the scene show the picture in its own proportions; what does not fit is cut.
// Makes an object of all surfaces that have it, and returns it; 0: none has.
uint32_t cover(Scene& scene, ExhibitPiece& piece, int material) {
  Material& m = scene.materials[size_t(material)];
  const PyramidLevel& finest = piece.picture->pyramid->levels().front();
  const double fit = aspect_of(scene, material) * double(finest.height) / double(finest.width);
  const vec2 part = fit < 1 ? vec2(fit, 1) : vec2(1, 1 / fit);
  mat3 middle(1);
  middle[0][0] = part.x, middle[1][1] = part.y;
  middle[2] = vec3(0.5f * (1.0f - part.x), 0.5f * (1.0f - part.y), 1);
  m.base_color_texture.uv_transform = middle * m.base_color_texture.uv_transform;
  m.base_color_texture.texture = add_texture(scene, piece);
  m.large_picture = true;
  uint32_t object = 0;
  for (Instance& instance : scene.instances) {
    if (scene.meshes[size_t(instance.mesh)].material != material) continue;
    if (object == 0) object = add_object(scene, piece.id);
    instance.object = object;
  }
  return object;
}

void read_frame(FieldReader& fields, ExhibitPiece& piece) {
  piece.frame_width = 0.08f, piece.frame_depth = 0.05f;
  fields.number("width_m", 0.005, 1, piece.frame_width, "0.08");
  fields.number("depth_m", 0.005, 0.5, piece.frame_depth, "0.05");
  fields.boolean("gilt", piece.gilt, "it shines like gold leaf");
  piece.frame_color = piece.gilt ? vec3(0.83f, 0.6f, 0.24f) : vec3(0.09f, 0.05f, 0.028f);
  fields.vector("color", 1, piece.frame_color, "linear red, green, blue; 0 to 1");
  piece.frame_color = glm::max(piece.frame_color, vec3(0));
}

void read_stand(FieldReader& fields, ExhibitPiece& piece) {
  piece.stands = true;
  piece.stand_color = vec3(0.09f, 0.05f, 0.028f);
  fields.number("floor_m", -most_metres, most_metres, piece.floor, "height of the floor, 0");
  fields.vector("color", 1, piece.stand_color, "linear red, green, blue; 0 to 1");
  piece.stand_color = glm::max(piece.stand_color, vec3(0));
}

// Reads where the first layer's corners lie in a layer's own picture.
void read_corners(FieldReader& fields, PieceLayer& layer) {
  std::array<dvec2, 4> corners;
  size_t known = 0;
  const std::vector<JsonValue> list =
      fields.list("corners", 4, 4, "[x, y] of the first layer's corners, in texels of this one");
  for (const JsonValue& one : list)
    if (double at[2]; known < 4 && one.numbers(2, -1e8, 1e8, at)) corners[known++] = {at[0], at[1]};
  if (known < 4 || !layer.shown.picture) return;
  const PyramidLevel& finest = layer.shown.picture->pyramid->levels().front();
  for (dvec2& corner : corners) corner /= dvec2(double(finest.width), double(finest.height));
  if (const std::optional<glm::dmat3> placing = square_to_corners(corners))
    layer.shown.placing = *placing;
  else fields.fail("corners", "are no quadrangle: three of them lie on a line");
}

// Adds the same picture in the exhibit's other languages, as far as it has words in them.
void add_spoken(const Exhibit& exhibit, const std::string& path, const std::string& name,
                PieceLayer& layer) {
  const LargePicture& first = *layer.shown.picture;
  for (const std::string& language : exhibit.languages) {
    const std::vector<std::string>& known = first.pyramid->languages();
    if (language == exhibit.languages.front() || std::ranges::count(known, language) == 0) continue;
    layer.spoken[language] = std::make_shared<LargePicture>(
        first, std::make_shared<SpokenPicture>(*first.pyramid, path, name, language));
  }
}

// Opens the picture of a layer; without a source of its own it is in that of the piece. A fault of
// a file that several layers show is told once. A source that is not there becomes empty.
void read_source(const Exhibit& exhibit, FieldReader& fields, const std::string& otherwise,
                 Need need, PieceLayer& layer, std::vector<Problem>& problems,
                 const BandView& bands = {}) {
  layer.source = otherwise;
  fields.text("source", layer.source,
              "a tiled TIFF, a Deep Zoom file, a folder of Zoomify or IIIF, a JPEG or PNG, a "
              ".geojson or .painting.json, or the address of an IIIF image service",
              need, most_address_bytes);
  std::string name;
  fields.text("layer", name, "of a painting that is described in words; its first");
  const std::string path = find_source(exhibit, fields, layer.source);
  if (path.empty()) return layer.source.clear();
  try {
    layer.shown.picture = std::make_shared<LargePicture>(
        shared_store(),
        open_picture(path, name, exhibit.languages.front(), exhibit.allowed_hosts, bands));
    add_spoken(exhibit, path, name, layer);
  } catch (const LoadError& error) {
    const auto tells_it = [&](const Problem& one) { return to_string(one) == error.what(); };
    if (std::ranges::none_of(problems, tells_it))
      problems.push_back({error.file, error.where, error.what_});
  } catch (const std::length_error& error) {
    fields.fail("source", std::string("is too much: ") + error.what());
  }
}

void add_layer(FieldReader& fields, PieceLayer layer, ExhibitPiece& piece) {
  if (std::ranges::find(piece.layers, layer.id, &PieceLayer::id) != piece.layers.end())
    fields.fail("there is another layer '" + layer.id + "'");
  else piece.layers.push_back(std::move(layer));
}

void read_layers(const Exhibit& exhibit, FieldReader& fields, ExhibitPiece& piece,
                 std::vector<Problem>& problems) {
  fields.parts("layers", most_piece_layers, "pictures of the same place, as X-rays are",
               [&](FieldReader& one) {
                 PieceLayer layer;
                 one.name("id", layer.id, "what messages call it", Need::required);
                 layer.label = read_local_text(one, "label", "", Need::required);
                 layer.text = read_local_text(one, "text", "what there is to see in it");
                 const BandView bands = read_band_view(one);
                 read_source(exhibit, one, piece.source, Need::optional, layer, problems, bands);
                 read_corners(one, layer);
                 add_layer(one, std::move(layer), piece);
               });
}

void read_times(const Exhibit& exhibit, FieldReader& fields, ExhibitPiece& piece,
                std::vector<Problem>& problems) {
  fields.parts("times", most_piece_layers,
               "maps or scans of the same place, the one shown at first first",
               [&](FieldReader& one) {
                 PieceLayer layer;
                 read_year(exhibit, one, layer);
                 if (one.describes()) read_scan_colors(one, layer);
                 read_source(exhibit, one, "", Need::required, layer, problems);
                 read_corners(one, layer);
                 add_layer(one, std::move(layer), piece);
               });
}

// Reads all that may be seen of the piece, and keeps what can be shown.
void read_pictures(const Exhibit& exhibit, const std::string& kind, FieldReader& fields,
                   ExhibitPiece& piece, std::vector<Problem>& problems) {
  const bool described = fields.describes();
  if (described || kind != "map") {
    PieceLayer first;
    read_source(exhibit, fields, "", described ? Need::optional : Need::required, first, problems);
    first.id = "first";
    first.label = read_local_text(fields, "label", "");
    piece.source = first.source;
    if (first.shown.picture || described) piece.layers.push_back(std::move(first));
    read_layers(exhibit, fields, piece, problems);
  }
  if (described || kind == "map") {
    read_times(exhibit, fields, piece, problems);
    if (!described && piece.layers.empty()) fields.fail("times", "names no map that can be shown");
    if (!piece.layers.empty()) piece.source = piece.layers.front().source;
  }
  std::erase_if(piece.layers, [](const PieceLayer& layer) { return !layer.shown.picture; });
  if (!piece.layers.empty()) piece.picture = piece.layers.front().shown.picture;
}

void read_piece(Exhibit& exhibit, FieldReader& fields, const std::string& cache,
                std::vector<Problem>& problems) {
  ExhibitPiece piece;
  Scene& scene = exhibit.scene;
  fields.text("id", piece.id, "", Need::required);
  if (std::ranges::find(exhibit.pieces, piece.id, &ExhibitPiece::id) != exhibit.pieces.end() ||
      std::ranges::find(scene.objects, piece.id) != scene.objects.end())
    fields.fail("id", "'" + piece.id + "' is taken by another piece or object");
  std::string kind;
  fields.word("kind", {"picture", "map", "volume", "scan", "lawn"}, kind,
              "map: the same place at several times; volume: a scan of the inside of something; "
              "scan: a place or thing as points; lawn: grass",
              Need::required);
  const bool all = fields.describes(), is_picture = kind == "picture" || kind == "map";
  if (is_picture || all) read_pictures(exhibit, kind, fields, piece, problems);
  if (kind == "volume" || all) read_volume(exhibit, fields, piece, problems);
  Mesh stand_in;
  if (kind == "scan" || all) stand_in = read_scan(exhibit, fields, cache, piece, problems);
  ExhibitLawn lawn;
  if (kind == "lawn" || all) read_lawn(exhibit, fields, lawn, problems);
  fields.text("material", piece.material, "of the scene that shows it, instead of a place");
  fields.number("width_m", 0.001, 1000, piece.width, "metres, without its frame");
  fields.part("place", "where it hangs or lies", [&](FieldReader& place) {
    place.vector("position", most_metres, piece.position,
                 "middle of its back, of a volume or scan of its underside, of a lawn's ground",
                 Need::required);
    place.degrees("yaw_deg", -720, 720, piece.yaw, "0 faces -z, positive turns left");
    place.degrees("pitch_deg", -90, 90, piece.pitch, "positive faces upwards: 90 lies on a table");
    place.degrees("roll_deg", -180, 180, piece.roll, "positive leans to the viewer's left");
  });
  fields.part("frame", "around it; none without",
              [&](FieldReader& frame) { read_frame(frame, piece); });
  fields.part("stand", "four legs, as a table has; they make no sense without a place",
              [&](FieldReader& stand) { read_stand(stand, piece); });
  PointOfInterest point;
  point.id = point.node = piece.id;
  read_label(exhibit, fields, "label", point);
  fields.describe_choice({{"material"}, {"place"}});
  if (piece.picture && piece.material.empty()) {
    if (!fields.has("place")) fields.fail("names neither a \"place\" nor a \"material\"");
    point.objects = {hang(scene, piece)};
  } else if (piece.picture) {
    const auto material = std::ranges::find(scene.materials, piece.material, &Material::name);
    if (material == scene.materials.end()) {
      std::vector<std::string> names;
      for (const Material& one : scene.materials) names.push_back(one.name);
      fields.fail("material", "the scene has no material '" + piece.material + "'" +
                                  did_you_mean(piece.material, names));
    } else {
      const uint32_t object = cover(scene, piece, int(material - scene.materials.begin()));
      if (object > 0) point.objects = {object};
      else fields.fail("material", "nothing in the scene is made of '" + piece.material + "'");
    }
  }
  if (piece.volume || piece.is_scan()) {
    if (!fields.has("place")) fields.fail("a volume or a scan needs a \"place\"");
    piece.object = add_object(scene, piece.id);
    point.objects = {piece.object};
  }
  if (piece.is_scan()) add_stand_in(exhibit, piece, std::move(stand_in));
  if (kind == "lawn") {
    lawn.object = add_object(scene, piece.id);
    place_lawn(exhibit, fields, piece, std::move(lawn));
    if (point.title.empty()) return;
    point.objects = {exhibit.lawns.back().object};
    point.place = piece.position;
    exhibit.points.push_back(point);
    return;
  }
  std::string annotations;
  fields.text("annotations", annotations,
              "file with an AnnotationPage of the W3C, whose notes are "
              "shown as objects");
  const std::string notes = package_file(fields, "annotations", exhibit.folder, annotations);
  if (!point.objects.empty()) {
    const Bounds bounds = piece.volume      ? bounds_of(place_volume(exhibit, piece))
                          : piece.is_scan() ? bounds_of_scan(exhibit, piece)
                                            : object_bounds(scene, point.objects);
    point.place = scene.origin + dvec3(0.5f * (bounds.low + bounds.high));
    exhibit.points.push_back(point);
    if (!notes.empty() && !piece.volume) read_annotations(exhibit, piece, notes, point, problems);
  }
  exhibit.pieces.push_back(std::move(piece));
}

}  // namespace

void read_pieces(Exhibit& exhibit, FieldReader& root, std::vector<Problem>& problems,
                 const std::string& cache) {
  read_allowed_hosts(exhibit, root);
  root.parts("pieces", most_exhibit_pieces, "what hangs in the scene and is no part of its files",
             [&](FieldReader& fields) { read_piece(exhibit, fields, cache, problems); });
  std::vector<std::string>& spoken = exhibit.piece_languages;
  for (const ExhibitPiece& piece : exhibit.pieces)
    for (const PieceLayer& layer : piece.layers)
      for (const auto& [language, picture] : layer.spoken)
        if (std::ranges::count(spoken, language) == 0) spoken.push_back(language);
}

}  // namespace wellspring::show
