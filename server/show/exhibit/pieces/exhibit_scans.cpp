// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_scans.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/load_error.h"
#include "scan/format/open_scan.h"
#include "scan/splat_draw/draw_shown.h"
#include "scan/splats/splat_file.h"
#include "scan/tree/coarse_cut.h"
#include "scan/tree/import/write_tree.h"
#include "scan/tree/tree_settings.h"
#include "show/exhibit/exhibit_files.h"
#include "show/exhibit/pieces/exhibit_sources.h"
#include "show/scanner/scanned_place.h"
#include "world/load/stand_in.h"

namespace wellspring::show {
namespace {

constexpr std::string_view tree_ending = ".points";
constexpr size_t most_stand_in = 120'000;  // squares of the mesh in place of a scan
// Opaque spheres hide those behind them node by node, so leaves are small (pieces.particles).
constexpr uint32_t leaf_spheres = 3000;

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

// Returns the same without an error: a survey's coordinates are millions of metres.
glm::dmat4 exact_turn_up(const std::string& axis) {
  glm::dmat4 turn(glm::mat4_cast(turn_up(axis)));
  for (int i = 0; i < 3; i++) turn[i] = glm::round(turn[i]);
  return turn;
}

PointBounds bounds_of_mesh(const Mesh& mesh, const quat& turn) {
  PointBounds bounds{dvec3(INFINITY), dvec3(-INFINITY)};
  for (const vec3& position : mesh.positions) {
    const dvec3 at(turn * position);
    bounds.low = glm::min(bounds.low, at), bounds.high = glm::max(bounds.high, at);
  }
  return mesh.positions.empty() ? PointBounds{} : bounds;
}

// How the files of a scan lie.
struct ScanFrame {
  std::string up;
  double unit = 0;  // metres; 0: as the file says
  bool is_given() const { return !up.empty() || unit > 0; }
};

// Holds all that readers of a scan's files need.
struct ScanFiles {
  const Exhibit& exhibit;
  const std::string& cache;  // as for read_exhibit()
  std::vector<Problem>& problems;
  ScanFrame frame;
  bool spheres = false;
};

Mesh open_splats(const std::string& path, const ScanFrame& frame, ExhibitPiece& piece) {
  SplatSet splats = load_splats(path);
  piece.splats = std::make_shared<ShownSplats>(make_shown_splats(splats));
  Mesh mesh = make_stand_in(splats, most_stand_in);
  piece.scan_turn = turn_up(frame.up.empty() ? "-y" : frame.up);
  piece.scan_box = bounds_of_mesh(mesh, piece.scan_turn);
  piece.from_file = exact_turn_up(frame.up.empty() ? "-y" : frame.up);
  if (frame.unit > 0) piece.scale = float(frame.unit);
  return mesh;
}

// A scan's points, and the box that its place refers to, relative to their origin.
struct OpenedPoints {
  std::shared_ptr<const PointTree> points;
  std::optional<PointBounds> box;  // none: around the points
  glm::dmat4 from_file{1};         // as the piece has it
};

// Returns points of a file whose units are so many metres; 0: one.
OpenedPoints opened(PointTree points, double unit) {
  const glm::dmat4 turn =
      glm::dmat4(points.frame) * glm::scale(glm::dmat4(1), dvec3(unit > 0 ? unit : 1));
  const glm::dmat4 from = glm::translate(glm::dmat4(1), -points.origin) * turn;
  return {std::make_shared<PointTree>(std::move(points)), {}, from};
}

// Opens what a scanner sees of a scene; nothing, if that is wrong.
OpenedPoints open_scanned(const std::string& path, const ScanFiles& files) {
  std::vector<Problem> wrong;
  const ScannerFile scanner = read_scanner_file(path, wrong);
  const bool is_good = std::ranges::none_of(wrong, &Problem::fatal);
  files.problems.insert(files.problems.end(), wrong.begin(), wrong.end());
  if (!is_good) return {};
  ScannedPlace scanned = open_scanned_place(scanner, files.cache);
  OpenedPoints points = opened(std::move(scanned.points), 1);
  points.box = scanned.box;
  return points;
}

OpenedPoints open_points(const std::string& path, const ScanFiles& files, FieldReader& fields) {
  const ScanFrame& frame = files.frame;
  const bool is_scanned = path.ends_with(scanner_ending);
  if (is_scanned || path.ends_with(tree_ending)) {
    if (frame.is_given())
      fields.fail("source",
                  "has its axis and unit since the scan was made: neither \"up\" nor "
                  "\"unit_m\" makes sense");
    if (is_scanned) return open_scanned(path, files);
    return opened(open_tree(path), 1);
  }
  if (frame.up.starts_with('-')) fields.fail("up", "may be below only for splats");
  TreeSettings settings;
  settings.up = up_axis_of(frame.up);
  settings.unit = frame.unit;
  if (files.spheres) settings.leaf_points = leaf_spheres;
  const TreeSource source{path, [path] { return open_scan(path); }};
  return opened(make_tree(source, settings), frame.unit);
}

// Adds a set of points. Returns the mesh that rays meet if it is the first.
Mesh add_set(OpenedPoints opened, ExhibitPiece& piece) {
  const PointTree& points = *opened.points;
  const std::vector<NodePoints> cut = coarse_cut(points, most_stand_in);
  const bool is_first = piece.sets.empty();
  const dvec3 offset = is_first ? dvec3(0) : points.origin - piece.sets[0].points->origin;
  PointBounds box = opened.box ? *opened.box : bounds_of(cut);
  box.low += offset, box.high += offset;
  if (!is_first) {
    box.low = glm::min(box.low, piece.scan_box.low);
    box.high = glm::max(box.high, piece.scan_box.high);
  }
  piece.scan_box = box;
  if (is_first) piece.from_file = opened.from_file;
  piece.sets.push_back({std::move(opened.points), offset});
  return is_first ? make_stand_in(cut) : Mesh{};
}

// Opens what `source` names. Returns its stand-in. If it cannot be read, that is a problem.
Mesh open_source(const std::string& source, const ScanFiles& files, FieldReader& fields,
                 ExhibitPiece& piece) {
  try {
    const std::string path = package_file(fields, "source", files.exhibit.folder, source);
    if (path.empty()) return {};
    const bool is_splats = holds_splats(path);
    if (is_splats && !piece.is_scan()) return open_splats(path, files.frame, piece);
    if (is_splats) {
      fields.fail("source", "splats have no times");
      return {};
    }
    OpenedPoints points = open_points(path, files, fields);
    return points.points ? add_set(std::move(points), piece) : Mesh{};
  } catch (const LoadError& error) {
    files.problems.push_back({error.file, error.where, error.what_});
  } catch (const std::length_error& error) {
    fields.fail("source", std::string("is too much: ") + error.what());
  }
  return {};
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
  read_scan_colors(fields, layer);
  if (std::ranges::find(piece.layers, layer.id, &PieceLayer::id) != piece.layers.end())
    return fields.fail("there is another look '" + layer.id + "'");
  if (piece.splats && layer.colors != ScanColors::captured)
    return fields.fail("colors", "splats are shown as captured");
  piece.layers.push_back(std::move(layer));
}

// Reads what was scanned at several times: a set of points and a layer each.
Mesh read_scan_times(FieldReader& fields, const ScanFiles& files, ExhibitPiece& piece) {
  Mesh stand_in;
  fields.parts("times", most_piece_layers, "", [&](FieldReader& one) {
    PieceLayer layer;
    read_year(files.exhibit, one, layer);
    if (std::ranges::find(piece.layers, layer.id, &PieceLayer::id) != piece.layers.end())
      return one.fail("year", "is that of another time, too");
    read_scan_colors(one, layer);
    one.text("source", layer.source, "", Need::required);
    layer.set = int(piece.sets.size());
    Mesh mesh = open_source(layer.source, files, one, piece);
    if (layer.set == 0) stand_in = std::move(mesh);
    if (piece.splats || layer.set < int(piece.sets.size()))
      piece.layers.push_back(std::move(layer));
  });
  if (piece.splats && piece.layers.size() > 1) fields.fail("times", "splats have no times");
  return stand_in;
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

// Leads from the frame of its box to the world.
glm::dmat4 box_to_world(const ExhibitPiece& piece) {
  const PointBounds& box = piece.scan_box;
  const dvec3 foot(0.5 * (box.low.x + box.high.x), box.low.y, 0.5 * (box.low.z + box.high.z));
  glm::dmat4 to = glm::translate(glm::dmat4(1), piece.position);
  to = glm::rotate(to, double(piece.yaw), dvec3(0, 1, 0));
  to = glm::scale(to, dvec3(double(piece.scale)));
  return glm::translate(to, -foot);
}
// Leads from there to the scene.
mat4 box_to_scene(const Exhibit& exhibit, const ExhibitPiece& piece) {
  return mat4(glm::translate(glm::dmat4(1), -exhibit.scene.origin) * box_to_world(piece));
}
// Leads from the scan's own metres, of points relative to its tree's origin, to the scene.
mat4 to_scene(const Exhibit& exhibit, const ExhibitPiece& piece) {
  return box_to_scene(exhibit, piece) * glm::mat4_cast(piece.scan_turn);
}

// Returns the planes that a choice cuts a scan by, in scene coordinates.
std::vector<ScanCut> scan_cuts(const Exhibit& exhibit, const ExhibitPiece& piece,
                               const PieceChoice& choice) {
  const PointBounds& box = piece.scan_box;
  const mat4 to = box_to_scene(exhibit, piece);
  const mat3 turn = mat3_cast(glm::angleAxis(piece.yaw, vec3(0, 1, 0)));
  std::vector<ScanCut> cuts;
  for (const VolumeCut& cut : cuts_of({vec3(box.low), vec3(box.high)}, piece.scale, choice)) {
    const vec3 normal = turn * cut.normal;
    cuts.push_back({normal, piece.scale * cut.offset + dot(normal, vec3(to[3]))});
  }
  return cuts;
}

}  // namespace

void read_scan_colors(FieldReader& fields, PieceLayer& layer) {
  fields.choice("colors", {"captured", "lit", "intensity", "height", "classification"},
                layer.colors,
                "captured: of the file; lit: these are reflectance, on which the scene's light "
                "falls; intensity: how much of the scanner's light came back; height: above its "
                "lowest point; classification: what points belong to");
}

Mesh read_scan(const Exhibit& exhibit, FieldReader& fields, const std::string& cache,
               ExhibitPiece& piece, std::vector<Problem>& problems) {
  const bool described = fields.describes();
  ScanFiles files{exhibit, cache, problems, {}};
  fields.word("up", axes, files.frame.up, "axis of a scan's file that points up: z, of splats -y");
  fields.number("unit_m", 1e-6, 1e6, files.frame.unit,
                "metres of a unit of a scan's file; as it says, or 1");
  fields.number("brightness", 0, 1000, piece.brightness,
                "of a scan as it was captured; 1 shows the colours of its file");
  fields.number("sphere_m", 0, 100, piece.sphere,
                "radius of the opaque spheres that a scan's points are, metres of its file");
  files.spheres = piece.sphere > 0;
  float height = 0;
  Mesh stand_in;
  const bool has_times = !described && fields.has("times");
  if (!described) fields.number("size_m", 0.001, 1000, height, "");
  if (has_times) {
    stand_in = read_scan_times(fields, files, piece);
  } else if (!described) {
    fields.text("source", piece.source, "", Need::required);
    stand_in = open_source(piece.source, files, fields, piece);
  }
  fields.parts("looks", most_piece_layers, "how a scan may be coloured, the first at first",
               [&](FieldReader& one) { read_look(one, piece); });
  if (has_times && fields.has("looks")) fields.fail("looks", "and \"times\" exclude one another");
  if (!piece.is_scan()) return {};
  if (piece.layers.empty()) piece.layers = usual_looks();
  const double own = piece.scan_box.high.y - piece.scan_box.low.y;
  if (height > 0 && own > 0) piece.scale = float(height / own);
  return stand_in;
}

Bounds bounds_of_scan(const Exhibit& exhibit, const ExhibitPiece& piece) {
  const PointBounds& box = piece.scan_box;
  const mat4 to = box_to_scene(exhibit, piece);
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
    scans.push_back({.sets = piece.sets,
                     .splats = piece.splats,
                     .sphere = piece.sphere,
                     .position = vec3(to_scene(exhibit, piece)[3]),
                     .turn = turn_of(piece),
                     .scale = piece.scale,
                     .low = float(piece.scan_box.low.y),
                     .high = float(piece.scan_box.high.y),
                     .object = piece.object,
                     .stand_in = stand_in_of(exhibit.scene, piece.object),
                     .look = look_of(exhibit, piece, {})});
  }
  world.place_scans(std::move(scans));
}

ScanLook look_of(const Exhibit& exhibit, const ExhibitPiece& piece, const PieceChoice& choice) {
  const PieceLayer& shown = piece.layers[size_t(choice.layer)];
  const ScanColors colors = shown.colors;
  // But for reflectance, colours are shown as they are, whatever the scene's light.
  return {.colors = colors,
          .brightness = colors == ScanColors::lit ? 1 : piece.brightness / exhibit.exposure,
          .set = shown.set,
          .cuts = scan_cuts(exhibit, piece, choice)};
}

vec3 scan_size(const ExhibitPiece& piece) {
  return piece.scale * vec3(piece.scan_box.high - piece.scan_box.low);
}

glm::dmat4 file_to_world(const ExhibitPiece& piece) {
  return box_to_world(piece) * piece.from_file;
}

void cut_scan_ahead(const Exhibit& exhibit, const ExhibitPiece& piece, const Ray& ray, float depth,
                    PieceChoice& choice) {
  const PointBounds& box = piece.scan_box;
  const vec3 middle(box_to_scene(exhibit, piece) * vec4(vec3(0.5 * (box.low + box.high)), 1));
  const vec3 way = glm::angleAxis(-piece.yaw, vec3(0, 1, 0)) * ray.direction;
  const float to_middle = dot(middle - ray.origin, ray.direction);
  const float front = to_middle - dot(0.5f * scan_size(piece), glm::abs(way));
  choice.glass_plane = vec4(way, std::max(front, 0.0f) + depth - to_middle);
}

}  // namespace wellspring::show
