// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_lawns.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/unicode.h"
#include "image/image.h"
#include "show/exhibit/exhibit_files.h"
#include "world/surface.h"

namespace wellspring::show {
namespace {

constexpr size_t most_map_bytes = size_t(16) << 20;
constexpr int64_t most_map_pixels = 4096 * 4096;
constexpr double longest_side = 1000;  // metres
constexpr float least_up = 0.7f;       // cosine between the ground's normal and up
constexpr int most_passed = 8;         // things above one another that a ray passes
constexpr float step_on = 1e-4f;       // metres

std::shared_ptr<const ImageCodes> read_map(const Exhibit& exhibit, FieldReader& fields,
                                           const char* name, const char* about,
                                           std::vector<Problem>& problems) {
  std::string file;
  fields.text(name, file, about);
  const std::string path = package_file(fields, name, exhibit.folder, file);
  if (path.empty()) return nullptr;
  try {
    const auto bytes = read_file<std::vector<uint8_t>>(path, most_map_bytes);
    return std::make_shared<ImageCodes>(decode_codes(bytes, most_map_pixels, path));
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
  }
  return nullptr;
}

void read_color(FieldReader& fields, const char* name, const char* about, vec3& color) {
  fields.vector(name, 1, color, about);
  color = max(color, vec3(0));
}

void read_blades(FieldReader& fields, LawnDescription& to) {
  fields.number("density", 1, 50'000, to.density, "blades a square metre where the mask is white");
  fields.number("height_m", 0.005, 3, to.height, "metres, of the highest");
  fields.number("height_spread", 0, 1, to.height_spread, "share by which others are shorter");
  fields.number("width_m", 0.0005, 0.1, to.width, "metres, where they are widest");
  fields.number("droop", 0, 4, to.droop, "how far tips hang over: 0 is straight");
  fields.number("messiness", 0, 1, to.messiness.constant.x,
                "share of chance in how they stand, where there is no picture of it");
  read_color(fields, "root", "linear red, green, blue; 0 to 1", to.colors.root);
  read_color(fields, "fresh", "of tips", to.colors.fresh);
  read_color(fields, "dry", "of tips of dry blades", to.colors.dry);
  fields.number("dryness", 0, 1, to.colors.dryness, "share of `dry` in the driest");
  fields.number("transmission", 0, 1, to.colors.transmission,
                "light through a blade, as a share of what it reflects");
}

}  // namespace

void read_lawn(const Exhibit& exhibit, FieldReader& fields, ExhibitLawn& lawn,
               std::vector<Problem>& problems) {
  LawnDescription& to = lawn.description;
  to.most_blades = most_lawn_blades;
  const Need need = fields.describes() ? Need::optional : Need::required;
  vec2 area(1);
  if (fields.vector("area_m", longest_side, area, "sides of a lawn along x and z, metres", need) &&
      !(std::min(area.x, area.y) > 0))
    fields.fail("area_m", "has a side that is not above 0");
  to.low = -0.5f * area, to.high = 0.5f * area;
  to.extent.picture =
      read_map(exhibit, fields, "mask",
               "picture of where grass grows, in its red; right is +x, down +z", problems);
  to.direction.picture =
      read_map(exhibit, fields, "direction",
               "picture of the way in which it grows: red x, green y, blue z, 128 is 0", problems);
  to.messiness.picture =
      read_map(exhibit, fields, "messiness", "picture of chance in how it stands, red", problems);
  fields.part("blades", "of a lawn", [&](FieldReader& blades) { read_blades(blades, to); });
  lawn.ground = read_texts(fields, "ground", "materials on which it grows; all without it");
  fields.number("reach_m", 0.01, 100, lawn.reach,
                "how far above and below its place there is ground, 1");
  fields.number("wind", 0, 3, lawn.wind.strength, "0: it stands still; 1 is a breeze, as without");
  fields.integer("seed", 0, 1e9, to.seed, "another one grows other blades");
  std::vector<std::string> names;
  for (const Material& one : exhibit.scene.materials) names.push_back(one.name);
  for (const std::string& name : lawn.ground)
    if (std::ranges::find(names, name) == names.end())
      fields.fail("ground", "the scene has no material '" + name + "'" + did_you_mean(name, names));
}

void place_lawn(Exhibit& exhibit, FieldReader& fields, const ExhibitPiece& piece,
                ExhibitLawn lawn) {
  if (!fields.has("place")) fields.fail("a lawn needs a \"place\"");
  if (piece.yaw != 0 || piece.pitch != 0 || piece.roll != 0)
    fields.fail("place", "of a lawn is not turned: its sides lie along x and z");
  const vec3 middle(piece.position - exhibit.scene.origin);
  lawn.id = piece.id, lawn.where = fields.where(), lawn.height = middle.y;
  lawn.description.low += vec2(middle.x, middle.z);
  lawn.description.high += vec2(middle.x, middle.z);
  exhibit.lawns.push_back(std::move(lawn));
}

std::shared_ptr<const Lawn> grow_lawn(const ExhibitLawn& lawn, const World& world) {
  auto grows_on = [&](const Hit& hit) {
    return std::abs(eval_face(world, hit.instance, hit.triangle).y) >= least_up &&
           (lawn.ground.empty() ||
            std::ranges::count(lawn.ground, world.material_of(hit.instance).name) > 0);
  };
  LawnDescription description = lawn.description;
  description.ground = [&](float x, float z) {
    Ray ray;
    ray.origin = {x, lawn.height + lawn.reach, z};
    ray.direction = {0, -1, 0};
    ray.t_max = 2 * lawn.reach;
    for (int passed = 0; passed < most_passed; passed++) {
      const Hit hit = world.intersect(ray);
      if (!hit.valid()) break;
      if (!world.is_moving(hit.instance))
        return grows_on(hit) ? ray.origin.y - hit.t : std::numeric_limits<float>::quiet_NaN();
      ray.t_min = hit.t + step_on;
    }
    return std::numeric_limits<float>::quiet_NaN();
  };
  return std::make_shared<Lawn>(make_lawn(description));
}

}  // namespace wellspring::show
