// SPDX-License-Identifier: Apache-2.0
#include "main_import_bands.h"

#include <filesystem>
#include <fmt/core.h>
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/load_error.h"
#include "spectrum/lamps.h"
#include "store/band_files/band_pyramid.h"
#include "store/open/open_picture.h"

namespace wellspring::program {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double infrared_nm = 780;  // from here on nobody sees anything
constexpr double shown_infrared_nm = 900, shown_red_nm = 650, shown_green_nm = 550;

std::string name_of(const BandImport& import) {
  if (!import.name.empty()) return import.name;
  const fs::path path = fs::absolute(import.path + (fs::is_directory(import.path) ? "/" : ""));
  std::string name = path.lexically_normal().filename().string();
  if (name.empty()) return path.lexically_normal().parent_path().filename().string();
  if (const std::string ending = ".bands.json"; name.ends_with(ending))
    return name.substr(0, name.size() - ending.size());
  return fs::path(name).stem().string();
}

Json propose_layers(const Bands& bands, const std::vector<std::string>& lamps) {
  Json layers = Json::array();
  for (const std::string& lamp : lamps) {
    std::string id;
    for (const char c : lamp) id += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
    layers.push_back(
        {{"id", id}, {"label", {{"en", "By " + find_lamp(lamp)->about}}}, {"lamp", lamp}});
  }
  if (bands.nm.front() > shown_green_nm || bands.nm.back() < infrared_nm) return layers;
  layers.push_back(
      {{"id", "false-colours"},
       {"label", {{"en", "Infrared, red and green as red, green and blue"}}},
       {"false_color_nm",
        {std::min(shown_infrared_nm, bands.nm.back()), shown_red_nm, shown_green_nm}}});
  return layers;
}

}  // namespace

void import_bands(const BandImport& import) {
  for (const std::string& lamp : import.lamps)
    if (!find_lamp(lamp))
      throw LoadError(
          "--lamps", "",
          "there is no lamp '" + lamp + "'; `./wellspring lamps --list-lamps` lists them");
  const BandSource source(import.path);
  const Bands& bands = source.bands();
  const fs::path made = fs::path(import.out) / (name_of(import) + ".tif");
  std::error_code error;
  if (fs::exists(made) && (!import.overwrite || fs::equivalent(made, import.path, error)))
    throw LoadError(made.string(), "",
                    "is there already; --overwrite replaces it, unless it is read itself");
  fs::create_directories(import.out);
  // Nobody finds half a file.
  const std::string half = made.string() + ".part.tif";
  const double began = seconds_now();
  BandPyramidStats stats;
  try {
    Progress progress("import");
    BandPyramidSettings settings{import.bits, import.quality,
                                 [&](double done) { progress.tell(done); }};
    stats = write_band_pyramid(source, half, settings);
    open_picture(half, "", "en", {}, {.shown_nm = {bands.nm[0]}});
    fs::rename(half, made);
  } catch (...) {
    fs::remove(half, error);
    throw;
  }
  std::cerr << fmt::format(
      "{}: {} x {} texels, {} bands of {:g} to {:g} nm, {} levels, {:.1f} MB, {:.1f} s\n",
      made.string(), source.width(), source.height(), bands.nm.size(), bands.nm.front(),
      bands.nm.back(), stats.levels, double(fs::file_size(made)) / 1e6, seconds_now() - began);
  if (stats.above > 0.001 || stats.below > 0.001)
    std::cerr << fmt::format(
        "  {:.1f} % of all values were above white and {:.1f} % below black; they were cut: look "
        "at \"white\" and \"black\"\n",
        100 * stats.above, 100 * stats.below);
  const std::string id = made.stem().string(), file = made.filename().string();
  try {
    weigh_bands(file, bands, {});
  } catch (const LoadError& error) {
    std::cerr << "  " << error.what_ << "; it can be a layer of another picture:\n";
    std::cout << Json({{"id", id},
                       {"label", {{"en", fmt::format("{:g} nm", bands.nm[0])}}},
                       {"source", file},
                       {"band_nm", bands.nm[0]}})
                     .dump(2)
              << "\n";
    return;
  }
  const Json piece = {{"id", id},
                      {"kind", "picture"},
                      {"source", file},
                      {"width_m", import.width > 0 ? import.width : 1},
                      {"place", {{"position", {0, 1.5, 0}}, {"yaw_deg", 0}}},
                      {"layers", propose_layers(bands, import.lamps)}};
  std::cout << piece.dump(2) << "\n";
}

}  // namespace wellspring::program
