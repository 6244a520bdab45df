// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_scans.h"

#include <algorithm>
#include <cmath>

#include "base/load_error.h"
#include "scan/format/open_scan.h"
#include "scan/splat_draw/draw_shown.h"
#include "scan/splats/splat_file.h"
#include "scan/tree/coarse_cut.h"
#include "scan/tree/import/write_tree.h"
#include "scan/tree/tree_settings.h"
#include "show/exhibit/exhibit_files.h"
#include "world/load/stand_in.h"

namespace wellspring::show {
namespace {

constexpr std::string_view tree_ending = ".points";
constexpr size_t most_stand_in = 120'000;  // squares of the mesh in place of a scan

const std::initializer_list<const char*> axes = {"x", "y", "z", "-x", "-y", "-z"};

// Returns the turn that makes an axis, one of `axes`, point up.
quat turn_up(const std::string& axis) {
  const bool is_below = axis.front() == '-';
  const float quarter = 0.5f * pi * (is_below ? -1.0f : 1.0f);
  switch (axis.back()) {
    case 'x': return glm::angleAxis(quarter, vec3(0, 0, 1));
    case 'z': return glm::angleAxis(-quarter, vec3(1, 0, 0));
    default: return glm::angleAxis(is_below ? pi : 0, vec3(0, 0, 1));
  }
}

PointBounds bounds_of_mesh(const Mesh& mesh, const quat& turn) {
  PointBounds bounds{dvec3(INFINITY), dvec3(-INFINITY)};
  for (const vec3& position : mesh.positions) {
    const dvec3 at(turn * position);
    bounds.low = glm::min(bounds.low, at), bounds.high = glm::max(bounds.high, at);
  }
  return mesh.positions.empty() ? PointBounds{} : bounds;
}

Mesh open_splats(const std::string& path, const std::string& up, double unit, ExhibitPiece& piece) {
  SplatSet splats = load_splats(path);
  piece.splats = std::make_shared<ShownSplats>(make_shown_splats(splats));
  Mesh mesh = make_stand_in(splats, most_stand_in);
  piece.scan_turn = turn_up(up.empty() ? "-y" : up);
  piece.scan_box = bounds_of_mesh(mesh, piece.scan_turn);
  if (unit > 0) piece.scale = float(unit);
  return mesh;
}

Mesh open_points(const std::string& path, const std::string& up, double unit, FieldReader& fields,
                 ExhibitPiece& piece) {
  if (path.ends_with(tree_ending)) {
    for (const char* name : {"up", "unit_m"})
      if (fields.has(name)) fields.fail(name, "was chosen when the scan was imported");
    piece.points = std::make_shared<PointTree>(open_tree(path));
  } else {
    TreeSettings settings;
    settings.up = up_axis_of(up);
    if (up.starts_with('-')) fields.fail("up", "may be below only for splats");
    settings.unit = unit;
    piece.points = std::make_shared<PointTree>(
        make_tree({path, [path] { return open_scan(path); }}, settings));
  }
  const std::vector<NodePoints> cut = coarse_cut(*piece.points, most_stand_in);
  piece.scan_box = bounds_of(cut);
  return make_stand_in(cut);
}

// Opens what `source` names. Returns its stand-in.
Mesh open_source(const std::string& path, FieldReader& fields, ExhibitPiece& piece) {
  std::string up;
  fields.word("up", axes, up, "axis of a scan's file that points up: z, of splats -y");
  double unit = 0;
  fields.number("unit_m", 1e-6, 1e6, unit, "metres of a unit of a scan's file; as it says, or 1");
  if (path.empty()) return {};
  return holds_splats(path) ? open_splats(path, up, unit, piece)
                            : open_points(path, up, unit, fields, piece);
}

// Returns the looks that a scan has without any in the file.
std::vector<PieceLayer> usual_looks() {
  PieceLayer captured;
  captured.id = "captured", captured.colors = ScanColors::captured;
  captured.label = {{"en", "As captured"}, {"de", "Wie aufgenommen"}, {"sk", "Ako bolo snímané"}};
  return {captured};
}

void read_look(FieldReader& fields, ExhibitPiece& piece) {
  PieceLayer layer;
  fields.name("id", layer.id, "what messages call it", Need::required);
  layer.label = read_local_text(fields, "label", "", Need::required);
  layer.text = read_local_text(fields, "text", "what there is to see in it");
  fields.choice("colors", {"captured", "lit", "intensity", "height", "classification"},
                layer.colors,
                "captured: of the file; lit: these are reflectance, on which the scene's light "
                "falls; intensity: how much of the scanner's light came back; height: above its "
                "lowest point; classification: what points belong to");
  if (std::ranges::find(piece.layers, layer.id, &PieceLayer::id) != piece.layers.end())
    return fields.fail("there is another look '" + layer.id + "'");
  if (piece.splats && layer.colors != ScanColors::captured)
    return fields.fail("colors", "splats are shown as captured");
  piece.layers.push_back(std::move(layer));
}

// Returns the instance that rays meet in place of a scan.
int stand_in_of(const Scene& scene, uint32_t object) {
  for (size_t i = 0; i < scene.instances.size(); i++)
    if (scene.instances[i].object == object &&
        scene.meshes[size_t(scene.instances[i].mesh)].stands_in)
      return int(i);
  return -1;
}

quat turn_of(const ExhibitPiece& piece) {
  return glm::angleAxis(piece.yaw, vec3(0, 1, 0)) * piece.scan_turn;
}

// Leads from the scan's own metres, of points relative to its tree's origin, to the scene.
mat4 to_scene(const Exhibit& exhibit, const ExhibitPiece& piece) {
  const PointBounds& box = piece.scan_box;
  const vec3 foot(0.5 * (box.low.x + box.high.x), box.low.y, 0.5 * (box.low.z + box.high.z));
  mat4 to(1);
  to = glm::translate(to, vec3(piece.position - exhibit.scene.origin));
  to = glm::rotate(to, piece.yaw, vec3(0, 1, 0));
  to = glm::scale(to, vec3(piece.scale));
  return glm::translate(to, -foot) * glm::mat4_cast(piece.scan_turn);
}

}  // namespace

Mesh read_scan(const Exhibit& exhibit, FieldReader& fields, ExhibitPiece& piece,
               std::vector<Problem>& problems) {
  float height = 0;
  if (!fields.describes()) {
    fields.text("source", piece.source, "", Need::required);
    fields.number("size_m", 0.001, 1000, height, "");
  }
  fields.number("brightness", 0, 1000, piece.brightness,
                "of a scan as it was captured; 1 shows the colours of its file");
  Mesh stand_in;
  try {
    const std::string path = package_file(fields, "source", exhibit.folder, piece.source);
    stand_in = open_source(path, fields, piece);
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
  } catch (const std::length_error& error) {
    fields.fail("source", std::string("is too much: ") + error.what());
  }
  fields.parts("looks", most_piece_layers, "how a scan may be coloured, the first at first",
               [&](FieldReader& one) { read_look(one, piece); });
  if (!piece.is_scan()) return {};
  if (piece.layers.empty()) piece.layers = usual_looks();
  const double own = piece.scan_box.high.y - piece.scan_box.low.y;
  if (height > 0 && own > 0) piece.scale = float(height / own);
  return stand_in;
}

Bounds bounds_of_scan(const Exhibit& exhibit, const ExhibitPiece& piece) {
  const PointBounds& box = piece.scan_box;
  const mat4 to = to_scene(exhibit, piece) * glm::mat4_cast(glm::conjugate(piece.scan_turn));
  Bounds bounds;
  for (int i = 0; i < 8; i++) {
    const vec3 corner(i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
                      i & 4 ? box.high.z : box.low.z);
    const vec3 at(to * vec4(corner, 1));
    bounds.low = min(bounds.low, at), bounds.high = max(bounds.high, at);
  }
  return bounds;
}

void add_stand_in(Exhibit& exhibit, const ExhibitPiece& piece, Mesh mesh) {
  Scene& scene = exhibit.scene;
  Material material;
  material.name = piece.id;
  material.metallic = 0, material.roughness = 1, material.specular = 0;
  material.double_sided = true;
  material.unlit = std::ranges::none_of(
      piece.layers, [](const PieceLayer& look) { return look.colors == ScanColors::lit; });
  mesh.name = piece.id;
  mesh.material = int(scene.materials.size());
  scene.materials.push_back(std::move(material));
  scene.instances.push_back({int(scene.meshes.size()), to_scene(exhibit, piece), piece.object});
  scene.meshes.push_back(std::move(mesh));
}

void place_scans(const Exhibit& exhibit, World& world) {
  std::vector<PlacedScan> scans;
  for (const ExhibitPiece& piece : exhibit.pieces) {
    if (!piece.is_scan()) continue;
    scans.push_back({.points = piece.points,
                     .splats = piece.splats,
                     .position = vec3(to_scene(exhibit, piece)[3]),
                     .turn = turn_of(piece),
                     .scale = piece.scale,
                     .low = float(piece.scan_box.low.y),
                     .high = float(piece.scan_box.high.y),
                     .object = piece.object,
                     .stand_in = stand_in_of(exhibit.scene, piece.object),
                     .look = look_of(exhibit, piece, 0)});
  }
  world.place_scans(std::move(scans));
}

ScanLook look_of(const Exhibit& exhibit, const ExhibitPiece& piece, int layer) {
  const ScanColors colors = piece.layers[size_t(layer)].colors;
  // But for reflectance, colours are shown as they are, whatever the scene's light.
  return {.colors = colors,
          .brightness = colors == ScanColors::lit ? 1 : piece.brightness / exhibit.exposure};
}

}  // namespace wellspring::show
