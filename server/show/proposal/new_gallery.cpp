// SPDX-License-Identifier: Apache-2.0
#include "show/proposal/new_gallery.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/load_error.h"
#include "base/unicode.h"
#include "base/write_file.h"
#include "show/exhibit/json_fields.h"
#include "show/proposal/gallery.h"
#include "show/proposal/iiif_manifest.h"
#include "store/open/open_picture.h"
#include "store/remote/http_get.h"

namespace wellspring::show {
namespace {

namespace fs = std::filesystem;
using Fields = nlohmann::ordered_json;

constexpr double most_height_m = 1.2, most_picture_m = 1.8;  // metres, where nobody tells
constexpr double degrees_a_radian = 180 / 3.14159265358979323846;
constexpr double gallery_eye = 1.65;  // metres
constexpr size_t most_hosts_told = 10;

// Rounds to so many parts of one.
double round_to_parts(double value, double parts) {
  return std::round(value * parts) / parts + 0.0;
}

Fields millimetres(dvec3 v) {
  return {round_to_parts(v.x, 1000), round_to_parts(v.y, 1000), round_to_parts(v.z, 1000)};
}

// Returns the path that a file's address names: %41 is a letter.
std::string file_path(std::string address) {
  if (address.starts_with("file://localhost/")) address.erase(0, 16);
  else if (address.starts_with("file://")) address.erase(0, 7);
  else if (address.starts_with("file:")) address.erase(0, 5);
  std::string path;
  for (size_t i = 0; i < address.size(); i++) {
    const auto digits = address.substr(i + 1, 2);
    const bool is_code = address[i] == '%' && digits.size() == 2 &&
                         std::isxdigit(uint8_t(digits[0])) && std::isxdigit(uint8_t(digits[1]));
    if (is_code && digits != "00") path += char(std::stoi(digits, nullptr, 16)), i += 2;
    else path += address[i];
  }
  return path;
}

// Makes the exhibit, and holds it meanwhile.
struct GalleryMaker {
  const std::string id, file, folder;
  IiifManifest manifest;
  Gallery gallery;
  std::vector<std::string> languages, hosts;
  std::vector<fs::path> files;  // one a picture; empty: it stays with its service
  std::vector<std::string> told;

  void add_languages(const LocalText& text) {
    for (const auto& [tag, unused] : text)
      if (!tag.empty() && std::ranges::count(languages, tag) == 0) languages.push_back(tag);
  }

  void load() {
    manifest = load_manifest(file);
    told = manifest.told;
    if (manifest.pictures.size() > most_exhibit_pieces) {
      told.push_back(fmt::format("{} of its {} pictures hang: an exhibit has no more",
                                 most_exhibit_pieces, manifest.pictures.size()));
      manifest.pictures.resize(most_exhibit_pieces);
    }
    add_languages(manifest.label);
    for (const ManifestPicture& one : manifest.pictures) add_languages(one.label);
    if (languages.empty()) languages.push_back("en");
    for (const ManifestPicture& one : manifest.pictures) {
      files.push_back(one.is_service ? fs::path() : find_picture(one));
      if (!one.is_service) continue;
      const std::string host = store::host_text(*store::read_http_address(one.source));
      if (std::ranges::count(hosts, host) == 0) hosts.push_back(host);
    }
  }

  // Finds a picture that is a file. A stranger's manifest takes nothing from outside of its folder.
  fs::path find_picture(const ManifestPicture& one) const {
    std::error_code ec;
    const fs::path root = fs::weakly_canonical(fs::absolute(file).parent_path(), ec);
    const fs::path named(file_path(one.source));
    const fs::path path = fs::weakly_canonical(named.is_absolute() ? named : root / named, ec);
    const auto [end, rest] = std::ranges::mismatch(root, path);
    if (ec || end != root.end())
      throw LoadError(file, one.where,
                      "'" + one.source + "' leaves the manifest's folder: copy the picture there");
    if (!fs::is_regular_file(path, ec))
      throw LoadError(file, one.where, "there is no file '" + one.source + "'");
    store::open_picture(path.string());
    return path;
  }

  void hang() {
    std::vector<HungPicture> sizes;
    int guessed = 0;
    for (const ManifestPicture& one : manifest.pictures) {
      const double fit = std::min(most_height_m / one.height, most_picture_m / one.width);
      const double width = one.width_m ? *one.width_m : fit * one.width;
      guessed += !one.width_m;
      sizes.push_back({width, width * one.height / one.width, {}});
    }
    gallery = hang_gallery(std::move(sizes), gallery_eye);
    told.push_back(
        fmt::format("{} of its pictures hang side by side in a room of {:.1f} x {:.1f} m",
                    manifest.pictures.size(), gallery.size.x, gallery.size.z));
    if (guessed > 0)
      told.push_back(fmt::format(
          "it does not tell how large {} of them are: these hang {:g} m high at most (width_m)",
          guessed, most_height_m));
    if (!hosts.empty())
      told.push_back("whoever shows this exhibit will ask " + list_names(hosts, most_hosts_told) +
                     " for its pictures, also while visitors look at them (allowed_hosts)");
  }

  // Returns the texts by language, those without one as the exhibit's first.
  Fields local(const LocalText& text) const {
    Fields fields = Fields::object();
    for (const auto& [tag, one] : text)
      if (!tag.empty()) fields[tag] = one;
    if (fields.empty() && text.contains("")) fields[languages.front()] = text.at("");
    return fields;
  }
  Fields title_of(size_t i) const {
    const LocalText& label = manifest.pictures[i].label;
    if (!label.empty()) return local(label);
    return {{languages.front(), std::to_string(i + 1)}};
  }
  std::string name_of(size_t i) const { return fmt::format("picture-{}", i + 1); }
  // Returns the picture's place in the package.
  std::string copy_of(size_t i) const {
    std::string end = files[i].extension().string();
    for (char& c : end) c = char(std::tolower(uint8_t(c)));
    return "pictures/" + name_of(i) + end;
  }

  Fields piece(size_t i) const {
    const ManifestPicture& one = manifest.pictures[i];
    const HungPicture& hung = gallery.pictures[i];
    Fields piece = {{"id", name_of(i)},
                    {"kind", "picture"},
                    {"source", files[i].empty() ? one.source : copy_of(i)},
                    {"width_m", round_to_parts(hung.width, 10'000)},
                    {"place", {{"position", millimetres(hung.place)}, {"yaw_deg", 180}}},
                    {"label", title_of(i)}};
    if (!one.text.empty()) piece["text"] = local(one.text);
    for (const auto& [element, text] : one.provenance) piece["provenance"][element] = local(text);
    const bool is_address = manifest.id.starts_with("https://") &&
                            manifest.id.size() <= most_address_bytes &&
                            store::read_http_address(manifest.id);
    if (is_address) piece["manifest"] = manifest.id;
    return piece;
  }

  static Fields viewpoint(const std::string& name, const Fields& title, const GalleryView& view) {
    const auto degrees = [](double angle) { return round_to_parts(angle * degrees_a_radian, 10); };
    return {{"name", name},
            {"title", title},
            {"position", millimetres(view.eye)},
            {"yaw_deg", degrees(view.yaw)},
            {"pitch_deg", degrees(view.pitch)},
            {"fov_deg", degrees(view.fov)}};
  }

  void write() const {
    for (size_t i = 0; i < files.size(); i++) {
      if (files[i].empty()) continue;
      const fs::path to = fs::path(folder) / copy_of(i);
      std::error_code ec;
      fs::create_directories(to.parent_path(), ec);
      fs::copy_file(files[i], to, ec);
      if (ec) throw LoadError(to.string(), "", "cannot be written: " + ec.message());
    }
    write_gallery(gallery, folder);
    Fields all;
    std::error_code ec;
    if (fs::exists(fs::path(folder).parent_path() / "exhibit.schema.json", ec))
      all["$schema"] = "../exhibit.schema.json";
    all["id"] = id;
    all["title"] = manifest.label.empty() ? Fields{{languages.front(), id}} : local(manifest.label);
    if (!manifest.text.empty()) all["description"] = local(manifest.text);
    all["languages"] = languages;
    all["scene"] = "gallery.gltf";
    all["environment"] = {{"radiance", {0, 0, 0}}};
    all["exposure"] = "auto";
    all["walk"] = {{"eye_height", gallery_eye}, {"speed", 1.4}, {"radius", 0.25}};
    all["start"] = "all";
    all["viewpoints"] = {viewpoint("all", all["title"], gallery.overview)};
    if (!hosts.empty()) all["allowed_hosts"] = hosts;
    for (size_t i = 0; i < files.size(); i++) {
      all["viewpoints"].push_back(viewpoint(name_of(i), title_of(i), gallery.views[i]));
      all["pieces"].push_back(piece(i));
    }
    const std::string text = all.dump(2) + "\n";
    write_file(folder + "/exhibit.json", text);
  }
};

}  // namespace

bool is_manifest(const std::string& file) {
  std::string end = fs::path(file).extension().string();
  for (char& c : end) c = char(std::tolower(uint8_t(c)));
  return end == ".json";
}

NewExhibit make_new_gallery(const std::string& content, const std::string& id,
                            const std::string& manifest) {
  const std::string folder = name_folder(content, id);
  GalleryMaker maker{id, manifest, folder, {}, {}, {}, {}, {}, {}};
  maker.load();
  maker.hang();
  fill_folder(folder, [&] { maker.write(); });
  return {folder, maker.told};
}

}  // namespace wellspring::show
