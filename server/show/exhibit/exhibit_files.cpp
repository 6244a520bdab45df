// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <optional>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/rng.h"
#include "base/unicode.h"
#include "gltf/file.h"
#include "world/load/scene_join.h"
#include "world/load/scene_load.h"
#include "world/sky.h"
#include "world/texture.h"

namespace wellspring::show {

namespace fs = std::filesystem;

namespace {

struct MediumRules {
  uint64_t most_bytes;
  const char *what, *type, *understood;
};

MediumRules rules_of(Medium medium) {
  switch (medium) {
    case Medium::image: return {most_image_bytes, "picture", "image/", "JPEG or PNG"};
    case Medium::video: return {most_video_bytes, "film", "video/", "WebM or MP4"};
    case Medium::station:
      return {most_station_bytes, "recognition tree", "application/", "./wellspring station"};
    default: return {most_sound_bytes, "sound", "audio/", "Ogg, MP3, WAV or FLAC"};
  }
}

// MP4 says in its first box for whom it is made (ISO/IEC 14496-12, section 4.3). QuickTime's own
// files begin alike, but not all browsers play them.
bool is_mp4(std::string_view bytes) {
  if (bytes.size() < 12 || bytes.substr(4, 4) != "ftyp") return false;
  constexpr std::string_view brands[] = {"isom", "iso2", "iso4", "iso5", "iso6", "avc1",
                                         "mp41", "mp42", "M4V ", "dash", "MSNV"};
  return std::find(std::begin(brands), std::end(brands), bytes.substr(8, 4)) != std::end(brands);
}

// A Matroska file whose header (EBML, RFC 8794) names the type "webm".
bool is_webm(std::string_view bytes) {
  return bytes.starts_with("\x1a\x45\xdf\xa3") &&
         bytes.substr(0, 64).find("\x42\x82\x84webm") != bytes.npos;
}

bool is_mp3(std::string_view bytes) {
  bool frame = bytes.size() > 1 && uint8_t(bytes[0]) == 0xff && (uint8_t(bytes[1]) & 0xe6) == 0xe2;
  return bytes.starts_with("ID3") || frame;
}

// Names that stand in an address as they are, and mean one file.
bool is_plain_name(const std::string& name) {
  bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '-' || c == '_' || c == '.' || c == '/';
  });
  return plain && name.size() <= 200 && fs::path(name).lexically_normal().string() == name;
}

std::string image_problem(const std::string& path, size_t most_bytes) {
  const auto bytes = read_file<std::vector<uint8_t>>(path, most_bytes);
  Image image;
  int64_t texels_left = int64_t(longest_image_side) * longest_image_side;
  std::string problem = decode_image(bytes, true, image, texels_left);
  if (problem.empty() && std::max(image.width, image.height) > longest_image_side)
    problem = fmt::format("picture of {}x{} is larger than {} a side", image.width, image.height,
                          longest_image_side);
  return problem;
}

}  // namespace

std::string media_type(Medium medium, std::string_view bytes) {
  using namespace std::string_view_literals;
  if (medium == Medium::image) {
    if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  } else if (medium == Medium::video) {
    if (is_webm(bytes)) return "video/webm";
    if (is_mp4(bytes)) return "video/mp4";
  } else if (medium == Medium::station) {
    if (bytes.starts_with('{')) return "application/json";
  } else {
    if (bytes.starts_with("OggS"sv)) return "audio/ogg";
    if (bytes.starts_with("fLaC"sv)) return "audio/flac";
    if (bytes.starts_with("RIFF"sv) && bytes.substr(0, 12).ends_with("WAVE"sv)) return "audio/wav";
    if (is_mp3(bytes)) return "audio/mpeg";
  }
  return "";
}

bool add_served_file(Exhibit& exhibit, FieldReader& fields, const char* field,
                     const std::string& name, Medium medium) {
  ServedFile file;
  const MediumRules rules = rules_of(medium);
  if (auto found = exhibit.files.find(name);
      found != exhibit.files.end() && found->second.type.starts_with(rules.type))
    return true;
  file.path = package_file(fields, field, exhibit.folder, name);
  if (file.path.empty()) return false;
  auto refuse = [&](const std::string& what) {
    fields.fail(field, "'" + name + "' " + what);
    return false;
  };
  if (!is_plain_name(name))
    return refuse("must be a name of letters, digits, '-', '_', '.' and '/'");
  std::error_code ec;
  file.bytes = fs::file_size(file.path, ec);
  if (ec) return refuse("cannot be read");
  file.changed = fs::last_write_time(file.path, ec).time_since_epoch().count();
  if (file.bytes > rules.most_bytes)
    return refuse(fmt::format("is larger than {} MiB", rules.most_bytes >> 20));
  std::ifstream in(file.path, std::ios::binary);
  std::array<char, 1 << 16> part;
  uint64_t hash = file.bytes, count = 0;
  while (in.read(part.data(), part.size()), in.gcount() > 0) {
    if (count == 0) file.type = media_type(medium, {part.data(), size_t(in.gcount())});
    count += uint64_t(in.gcount());
    for (std::streamsize i = 0; i < in.gcount(); i++) hash = mix64(hash ^ uint8_t(part[size_t(i)]));
  }
  if (count != file.bytes) return refuse("cannot be read");
  if (file.type.empty())
    return refuse(
        medium == Medium::station
            ? fmt::format("is no {} as {} writes it", rules.what, rules.understood)
            : fmt::format("is no {} that all browsers show: {}", rules.what, rules.understood));
  if (medium == Medium::image)
    if (std::string problem = image_problem(file.path, rules.most_bytes); !problem.empty())
      return refuse("cannot be shown: " + problem);
  file.etag = fmt::format("\"{:016x}\"", hash);
  exhibit.files[name] = std::move(file);
  return true;
}

namespace fs = std::filesystem;

std::string package_file(FieldReader& fields, const char* field, const std::string& folder,
                         const std::string& name, PackagePart part) {
  if (name.empty()) return "";
  fs::path relative(name);
  bool escapes = relative.is_absolute() || std::any_of(relative.begin(), relative.end(),
                                                       [](const fs::path& p) { return p == ".."; });
  if (escapes) {
    fields.fail(field, "'" + name + "' leaves the package's folder");
    return "";
  }
  std::error_code ec;
  const fs::path path = find_file(folder, relative).value_or(fs::path(folder) / relative);
  fs::path real = fs::weakly_canonical(path, ec), root = fs::weakly_canonical(folder, ec);
  if (ec || !lies_in(real, root)) {
    fields.fail(field, "'" + name + "' leaves the package's folder");
    return "";
  }
  const bool folder_fits = part == PackagePart::file_or_folder && fs::is_directory(path, ec);
  if (!fs::is_regular_file(path, ec) && !folder_fits) {
    fields.fail(field, "there is no file '" + name + "' in the package" +
                           did_you_mean(name, list_files(root)));
    return "";
  }
  return path.string();
}

namespace {

constexpr double one_degree = 3.14159265358979323846 / 180;
constexpr double least_scale = 1e-6, most_scale = 1e6;

// The scene of the file that `field` names; nothing where it cannot be read, which is told.
std::optional<Scene> read_scene_file(Exhibit& exhibit, FieldReader& fields, const char* field,
                                     std::vector<Problem>& problems, Need need) {
  std::string name;
  fields.text(field, name, "a glTF file", need);
  std::string path = package_file(fields, field, exhibit.folder, name);
  if (path.empty()) return {};
  try {
    SceneLoadOptions options;
    options.package = exhibit.folder;
    options.motion = true;
    Scene scene = load_scene(path, options);
    for (const std::string& warning : scene.warnings)
      problems.push_back({path, "", warning, false});
    Credit credit = load_credit(path, exhibit.folder);
    credit.file = name;
    if (!credit.empty()) exhibit.credits.push_back(credit);
    return scene;
  } catch (const LoadError& error) {
    problems.push_back({error.file, error.where, error.what_});
    return {};
  }
}

// All files or none: names would be missed that are in one that cannot be read.
void read_files(Exhibit& exhibit, FieldReader& root, std::vector<Problem>& problems) {
  root.describe_choice({{"scene"}, {"scenes"}});
  const bool many = root.has("scenes");
  if (many && root.has("scene")) root.fail("scene", "is there beside \"scenes\": one of them only");
  if (!many && !root.has("scene")) root.fail("scene", "is missing");
  if (auto scene = read_scene_file(exhibit, root, "scene", problems, Need::optional))
    exhibit.scene = std::move(*scene);
  std::optional<Scene> all;
  bool readable = true;
  root.parts("scenes", SIZE_MAX, "several glTF files instead of \"scene\"",
             [&](FieldReader& fields) {
               ScenePlace place;
               fields.vector("position", most_metres, place.position);
               if (fields.number("yaw_deg", -720, 720, place.yaw)) place.yaw *= one_degree;
               fields.number("scale", least_scale, most_scale, place.scale);
               std::optional<Scene> scene =
                   read_scene_file(exhibit, fields, "file", problems, Need::required);
               readable &= scene.has_value();
               if (!scene) return;
               place_scene(*scene, place);
               if (all) join_scene(*all, std::move(*scene));
               else all = std::move(scene);
             });
  if (many && !all && readable) root.fail("scenes", "must name at least one file");
  if (all && readable) exhibit.scene = std::move(*all);
}

void read_environment(Exhibit& exhibit, FieldReader& fields, std::vector<Problem>& problems) {
  exhibit.scene.environment.radiance = vec3(1);
  fields.vector("radiance", most_metres, exhibit.scene.environment.radiance);
  std::string picture;
  fields.text("image", picture, "latitude-longitude .hdr");
  std::string picture_path = package_file(fields, "image", exhibit.folder, picture);
  if (!picture_path.empty()) {
    try {
      load_environment(picture_path, exhibit.scene);
    } catch (const LoadError& error) {
      problems.push_back({error.file, error.where, error.what_});
    }
  }
  fields.part("sky", "a clear sky with its sun", [&](FieldReader& sky) {
    SkySettings settings;
    sky.number("elevation_deg", -18, 90, settings.elevation, "of the sun", Need::required);
    sky.number("azimuth_deg", -360, 360, settings.azimuth, "of the sun", Need::required);
    sky.number("turbidity", 1, 10, settings.turbidity, "2 is clear air, 10 is haze");
    sky.number("strength", 0, 1e6, settings.strength, "multiplies its light");
    if (!picture.empty()) fields.fail("sky", "is there beside an \"image\": one of them only");
    else if (!sky_problem(settings)) add_sky(settings, exhibit.scene);
  });
}

}  // namespace

void read_scene(Exhibit& exhibit, FieldReader& root, std::vector<Problem>& problems) {
  read_files(exhibit, root, problems);
  const bool loaded = !exhibit.scene.objects.empty();
  ScenePlace place;
  root.number("scale", least_scale, most_scale, place.scale,
              "of the whole scene: 0.01 for a file in centimetres");
  bool back_faces = false;
  root.boolean("draw_back_faces", back_faces,
               "the eye sees the backs of single-sided faces, too, against glTF's rule");
  exhibit.scene.cull_back_faces = !back_faces;
  double light = 1;
  root.number("light_scale", 0, 1e6, light, "multiplies all lights and emission of the scene");
  if (loaded) place_scene(exhibit.scene, place);
  if (light != 1) scale_light(exhibit.scene, float(light));
  root.part("environment", "what is around the scene",
            [&](FieldReader& fields) { read_environment(exhibit, fields, problems); });
  if (loaded && add_missing_light(exhibit.scene))
    root.warn("environment",
              "the scene has no light of any kind: it is lit from everywhere by a radiance of 1 "
              "(write \"environment\": {\"radiance\": [1, 1, 1]}, or give it lamps or a sky)");
}

}  // namespace wellspring::show
