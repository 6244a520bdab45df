// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_volumes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/load_error.h"
#include "show/exhibit/pieces/exhibit_compare.h"
#include "show/exhibit/pieces/exhibit_scans.h"
#include "show/exhibit/exhibit_files.h"
#include "wire/messages.h"

namespace wellspring::show {
namespace {

constexpr double most_density = 1e6;  // per millimetre
constexpr size_t most_points = 64;
constexpr int nebula_side = 96;  // voxels

// Returns what a preset that was found (volume/draw/preset.h) is called.
LocalText label_of(const std::string& found) {
  static const std::map<std::string, LocalText> labels = {
      {"outside", {{"en", "Outside"}, {"de", "Außen"}, {"sk", "Zvonka"}}},
      {"inside", {{"en", "Inside"}, {"de", "Innen"}, {"sk", "Vnútro"}}},
      {"bone", {{"en", "Dense parts"}, {"de", "Dichte Teile"}, {"sk", "Husté časti"}}},
      {"metal", {{"en", "Densest parts"}, {"de", "Dichteste Teile"}, {"sk", "Najhustejšie časti"}}},
      {"x-ray", {{"en", "X-ray"}, {"de", "Röntgenbild"}, {"sk", "Röntgen"}}},
      {"light", {{"en", "Light"}, {"de", "Licht"}, {"sk", "Svetlo"}}}};
  const auto known = labels.find(found);
  return known == labels.end() ? LocalText{{"en", found}} : known->second;
}

void read_points(FieldReader& fields, Preset& preset) {
  fields.parts(
      "points", most_points, "values, by size, between which colour and density are mixed",
      [&](FieldReader& one) {
        PresetPoint point;
        one.number("value", -1e30, 1e30, point.value, "as the scan has it", Need::required);
        one.vector("color", 1, point.color, "linear red, green, blue; 0 to 1");
        one.number("density", 0, most_density, point.density,
                   "how much a millimetre stops, of glow sends; of maximum: opacity, 0 to 1");
        point.color = glm::max(point.color, vec3(0));
        if (!preset.points.empty() && point.value < preset.points.back().value)
          one.fail("value", "is less than the one before");
        else preset.points.push_back(point);
      });
}

// Holds what a volume was read from.
struct ReadVolume {
  std::string path;
  std::vector<Preset> found;
};

// Compares the volume with the model that a preset names.
void compare_layer(const Exhibit& exhibit, FieldReader& fields, const ReadVolume& read,
                   const std::string& model, const ExhibitPiece& piece, PieceLayer& layer) {
  const std::string path = package_file(fields, "compare", exhibit.folder, model);
  if (path.empty() || !piece.volume) return;
  const Preset& outside = piece.layers.empty() ? read.found.front() : *piece.layers.front().preset;
  compare_model(path, read.path, piece, outside, layer);
}

void read_preset(const Exhibit& exhibit, FieldReader& fields, const ReadVolume& read,
                 ExhibitPiece& piece) {
  const std::vector<Preset>& found = read.found;
  PieceLayer layer;
  fields.name("id", layer.id, "what messages call it", Need::required);
  layer.label = read_local_text(fields, "label", "", Need::required);
  layer.text = read_local_text(fields, "text", "what there is to see in it");
  Preset preset;
  preset.name = layer.id;
  std::string automatic;
  fields.word("find", {"outside", "inside", "bone", "metal", "x-ray", "light"}, automatic,
              "finds its values in the scan, in place of mode and points");
  fields.choice("mode", {"density", "surface", "maximum", "glow"}, preset.mode,
                "density: all that it lets through; surface: where the first value begins; "
                "maximum: the largest value along each ray; glow: light that it sends");
  read_points(fields, preset);
  std::string model;
  fields.text("compare", model,
              "a model of it, glTF, STL or PLY: colours show how far it is off, on the surface of "
              "the first preset");
  fields.describe_choice({{"find"}, {"mode", "points"}, {"compare"}});
  if (!model.empty()) {
    compare_layer(exhibit, fields, read, model, piece, layer);
    if (!layer.preset) return;
    preset = *layer.preset;
  } else if (!automatic.empty()) {
    const auto same = std::ranges::find(found, automatic, &Preset::name);
    if (same == found.end())
      return fields.fail("find", "the scan has no such part; its values differ too little");
    preset = *same;
  } else if (preset.points.empty()) {
    if (!fields.describes()) fields.fail("points", "names no value");
    return;
  }
  if (std::ranges::find(piece.layers, layer.id, &PieceLayer::id) != piece.layers.end())
    return fields.fail("there is another preset '" + layer.id + "'");
  layer.preset = std::move(preset);
  piece.layers.push_back(std::move(layer));
}

// Reads how a picture of a nebula becomes a volume, and makes it.
void read_nebula(FieldReader& fields, const std::string& path, ExhibitPiece& piece) {
  auto nebula = std::make_shared<PieceNebula>();
  double angle = 0, tilt = 0;
  const bool has_angle =
      fields.number("angle_deg", -360, 360, angle,
                    "of its axis, from the right, counter-clockwise; found without it");
  const bool has_tilt = fields.number("tilt_deg", -75, 75, tilt,
                                      "of the axis's end out of the picture, towards the visitor");
  if (has_angle) nebula->settings.angle_degrees = angle;
  if (has_tilt) nebula->settings.tilt_degrees = tilt;
  nebula->settings.most_side = nebula_side;
  if (path.empty()) return;
  NebulaReport report;
  nebula->picture = prepare_nebula(load_nebula_picture(path), nebula->settings, report);
  nebula->tilt = float(has_tilt ? glm::radians(tilt) : nebula->picture.proposed_tilt.value_or(0));
  piece.volume = solve_nebula(*nebula, nebula->tilt);
  piece.nebula = std::move(nebula);
}

// Opens what `source` names. Returns its path.
std::string open_source(const Exhibit& exhibit, FieldReader& fields, ExhibitPiece& piece) {
  const std::string path = package_file(fields, "source", exhibit.folder, piece.source);
  if (fields.part("nebula", "the source is a picture of a nebula, of which a volume is made",
                  [&](FieldReader& nebula) { read_nebula(nebula, path, piece); }))
    return path;
  if (!path.empty() && !fields.describes())
    piece.volume = std::make_shared<ShownVolume>(open_shown_volume(path));
  return path;
}

}  // namespace

std::shared_ptr<const ShownVolume> solve_nebula(const PieceNebula& nebula, float tilt) {
  NebulaReport report;
  const RingMap map = volume::solve_nebula(nebula.picture, double(tilt), nebula.settings, report);
  return std::make_shared<ShownVolume>(
      make_shown_volume(fill_cubes(map, nebula.picture.axis, double(tilt), nebula.picture.picture,
                                   nebula.settings.cubes, report.cubes)));
}

void read_volume(const Exhibit& exhibit, FieldReader& fields, ExhibitPiece& piece,
                 std::vector<Problem>& problems) {
  if (!fields.describes()) fields.text("source", piece.source, "", Need::required);
  ReadVolume read;
  float height = 0;
  fields.number("size_m", 0.001, 1000, height, "height of a volume, metres; as scanned without it");
  try {
    read.path = open_source(exhibit, fields, piece);
    if (piece.volume) read.found = find_presets(*piece.volume);
    fields.parts("presets", most_piece_layers,
                 "what may be seen of a volume, the first at first; without them they are found",
                 [&](FieldReader& one) { read_preset(exhibit, one, read, piece); });
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
  } catch (const std::length_error& error) {
    fields.fail("source", std::string("is too much: ") + error.what());
  }
  if (!piece.volume) return;
  if (!fields.has("presets"))
    for (const Preset& preset : read.found) {
      PieceLayer layer;
      layer.id = preset.name, layer.label = label_of(preset.name), layer.preset = preset;
      piece.layers.push_back(std::move(layer));
    }
  const VolumeBox box = box_of(*piece.volume);
  if (height > 0) piece.scale = height / (box.high.y - box.low.y);
}

vec3 size_of(const ExhibitPiece& piece) {
  const VolumeBox box = box_of(*piece.volume);
  return piece.scale * (box.high - box.low);
}

PlacedVolume place_volume(const Exhibit& exhibit, const ExhibitPiece& piece) {
  const vec3 up(0, 0.5f * size_of(piece).y, 0);
  return {.volume = piece.volume,
          .position = vec3(piece.position - exhibit.scene.origin) + up,
          .yaw = piece.yaw,
          .scale = piece.scale,
          .object = piece.object,
          .look = {}};
}

void place_volumes(const Exhibit& exhibit, World& world) {
  std::vector<PlacedVolume> volumes;
  for (const ExhibitPiece& piece : exhibit.pieces) {
    if (!piece.volume || piece.layers.empty()) continue;
    volumes.push_back(place_volume(exhibit, piece));
    volumes.back().look.preset = std::make_shared<const DrawnPreset>(
        *piece.volume, *piece.layers.front().preset, VolumeLight{});
  }
  world.place_volumes(std::move(volumes));
}

void cut_ahead(const Exhibit& exhibit, const LensOrder& order, const Ray& ray,
               PieceChoices& choices) {
  choices.resize(exhibit.pieces.size());
  for (size_t i = 0; i < choices.size(); i++) {
    const ExhibitPiece& piece = exhibit.pieces[i];
    if (!piece.has_inside() || !(order.name.empty() || order.name == piece.id)) continue;
    if (piece.is_scan()) {
      cut_scan_ahead(exhibit, piece, ray, order.depth, choices[i]);
      continue;
    }
    PlacedVolume placed = place_volume(exhibit, piece);
    placed.look.turn = choices[i].turn;
    const VolumeBox box = box_of(*placed.volume);
    const vec3 to_eye = ToVolume(placed).way(ray.origin - placed.position);
    const float length = glm::length(to_eye);
    if (!(length > 0)) continue;
    const vec3 back = -to_eye / length;
    const float front = dot(0.5f * (box.high - box.low), glm::abs(back)) * placed.scale;
    choices[i].glass_plane = vec4(back, order.depth - front);
  }
}

}  // namespace wellspring::show
