// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring lamps [content/ID] [--pigments FILE] [--picture FILE]`: how an exhibit's
// materials, or pigments that were measured, look under lamps, and which places of a picture of
// many bands look alike under one of them and unlike under another. Exit status: 0 done, 1 the
// input is wrong, 2 the command line is wrong.
#include <CLI/CLI.hpp>
#include <bit>
#include <filesystem>
#include <fmt/core.h>
#include <iostream>
#include <ranges>
#include <sstream>

#include "about/version.h"
#include "base/load_error.h"
#include "base/log.h"
#include "base/read_file.h"
#include "base/rng.h"
#include "base/write_file.h"
#include "main_shard.h"
#include "show/exhibit/load/exhibit_load.h"
#include "spectrum/read/dispersion_file.h"
#include "spectrum/read/spectra_file.h"
#include "spectrum/report/lamp_report.h"
#include "spectrum/report/place_pairs.h"
#include "spectrum/upsample.h"
#include "store/band_files/band_places.h"

using namespace wellspring;
using namespace wellspring::program;

namespace {

constexpr size_t most_shard_bytes = 1 << 30;

struct Options {
  std::string package, csv, html, json;
  std::string picture;  // a picture of many bands
  int places = 1024;
  Shard shard;  // which pairs of them are compared
  std::string out;
  std::vector<std::string> merge;
  std::vector<std::string> pigments, lamp_files, glasses;
  std::vector<std::string> lamps;
  Adaptation adaptation = Adaptation::cat16;
  SpectraChoice choice;
  bool list = false;
};

// A candle, a bulb, north light and lamps of today.
const std::vector<std::string> usual_lamps{"candle", "A",      "north-light", "LED-B1",
                                           "LED-B3", "LED-V2", "FL11",        "HP1"};

void take_notes(const std::string& file, std::vector<SpectraNote> from,
                std::vector<SpectraNote>& notes) {
  for (SpectraNote& note : from) {
    note.where = std::filesystem::path(file).filename().string() + ": " + note.where + ":";
    log::warn("{} {}", note.where, note.what);
    notes.push_back(std::move(note));
  }
}

std::vector<LampSpectrum> find_lamps(const Options& options, std::vector<SpectraNote>& notes) {
  std::vector<LampSpectrum> lamps;
  const bool are_usual = options.lamps.empty() && options.lamp_files.empty();
  for (const std::string& name : are_usual ? usual_lamps : options.lamps) {
    const auto lamp = find_lamp(name);
    if (!lamp)
      throw CLI::ValidationError(
          "--lamps", "there is no lamp '" + name + "'; --list-lamps lists those that have names");
    lamps.push_back(*lamp);
  }
  SpectraChoice choice = options.choice;
  choice.quantity = Quantity::power;
  for (const std::string& file : options.lamp_files) {
    SpectraFile read = read_spectra(file, choice);
    for (NamedSpectrum& one : read.spectra) lamps.push_back({one.name, one.source, one.spectrum});
    take_notes(file, std::move(read.notes), notes);
  }
  return lamps;
}

// Returns the mean of a material's base colour over its picture.
dvec3 mean_color(const Scene& scene, const Material& material) {
  const dvec3 factor(material.base_color.x, material.base_color.y, material.base_color.z);
  if (material.base_color_texture.texture < 0) return factor;
  const Texture& texture = scene.textures[size_t(material.base_color_texture.texture)];
  if (texture.image < 0) return factor;
  constexpr int side = 64;  // places each way; enough for a mean
  dvec3 sum(0);
  for (int y = 0; y < side; y++)
    for (int x = 0; x < side; x++) {
      const vec2 at = (vec2(x, y) + 0.5f) / float(side);
      sum += dvec3(vec3(eval_texture(scene.images[size_t(texture.image)], texture, at)));
    }
  return factor * sum / double(side * side);
}

// Makes a smooth reflectance of each material that has a name and a colour of its own.
void add_materials(const std::string& package, std::vector<NamedSpectrum>& pigments,
                   std::vector<SpectraNote>& notes) {
  const Exhibit exhibit = load_exhibit(package);
  const std::string source = "colour of " + exhibit.id + "'s material, a guess by three numbers";
  for (const Material& material : exhibit.scene.materials) {
    if (material.name.empty() || material.transmission > 0) continue;
    const SmoothReflectance fit = fit_reflectance(mean_color(exhibit.scene, material));
    pigments.push_back({material.name, source, {}, sample_reflectance(fit)});
  }
  notes.push_back({exhibit.id + ":",
                   "of materials only red, green and blue are known: their "
                   "spectra are guessed, smooth ones of the same colour",
                   false});
}

LampReport make_report(const Options& options) {
  std::vector<SpectraNote> notes;
  const std::vector<LampSpectrum> lamps = find_lamps(options, notes);
  std::vector<NamedSpectrum> pigments;
  for (const std::string& file : options.pigments) {
    SpectraFile read = read_spectra(file, options.choice);
    std::ranges::move(read.spectra, std::back_inserter(pigments));
    take_notes(file, std::move(read.notes), notes);
  }
  if (!options.package.empty()) add_materials(options.package, pigments, notes);
  const std::string& first = !options.package.empty()    ? options.package
                             : !options.pigments.empty() ? options.pigments[0]
                                                         : options.glasses[0];
  const std::filesystem::path whole = std::filesystem::absolute(first + "/");
  LampReport report = make_lamp_report(whole.lexically_normal().parent_path().stem().string(),
                                       {.adaptation = options.adaptation}, lamps, pigments);
  for (const std::string& file : options.glasses) {
    report.glasses.push_back(read_dispersion(file));
    for (const std::string& note : report.glasses.back().notes)
      take_notes(file, {{report.glasses.back().name, note}}, notes);
  }
  report.notes = std::move(notes);
  return report;
}

// Holds places of a picture of many bands that are compared, and the lamps.
struct PlaceTask {
  std::vector<LampSpectrum> lamps;
  LampReportSettings settings;
  std::vector<double> nm;
  std::vector<std::string> names;
  std::vector<std::vector<double>> spectra;
};

PlaceTask load_places(const Options& options) {
  PlaceTask task;
  std::vector<SpectraNote> notes;
  task.lamps = find_lamps(options, notes);
  if (std::ranges::find(task.lamps, daylight_name, &LampSpectrum::name) == task.lamps.end())
    task.lamps.insert(task.lamps.begin(), *find_lamp(daylight_name));
  const BandSource source(options.picture);
  weigh_bands(options.picture, source.bands(), {});  // refuses bands that tell no colours
  task.nm = source.bands().nm;
  for (BandPlace& place : sample_places(source, options.places)) {
    task.names.push_back(std::to_string(place.x) + ", " + std::to_string(place.y));
    task.spectra.push_back(std::move(place.reflectances));
  }
  task.settings = {.adaptation = options.adaptation, .most_pairs = 12};
  return task;
}

// Returns the first line of a shard's file: what was compared, as a number, and by whom.
std::string shard_title(const PlaceTask& task, const Shard& shard) {
  uint64_t number = uint64_t(task.settings.adaptation);
  const auto add = [&](double value) { number = mix64(number ^ std::bit_cast<uint64_t>(value)); };
  std::ranges::for_each(task.nm, add);
  for (const std::vector<double>& spectrum : task.spectra) std::ranges::for_each(spectrum, add);
  for (const LampSpectrum& lamp : task.lamps) {
    std::ranges::for_each(lamp.power, add);
  }
  return fmt::format("places {:016x} {}", number, to_text(shard));
}

void write_shard(const Options& options, const PlaceTask& task) {
  std::string text = shard_title(task, options.shard) + "\n";
  for (const auto& [first, second] :
       find_unlike_places(task.nm, task.spectra, task.lamps, task.settings, options.shard))
    text += fmt::format("{} {}\n", first, second);
  write_file(options.out, std::span<const char>(text));
}

// Reads the pairs of all shards. Throws LoadError.
std::vector<Places> read_shards(const Options& options, const PlaceTask& task) {
  std::vector<Places> pairs;
  const int count = int(options.merge.size());
  std::vector<char> is_there(size_t(count), 0);
  for (const std::string& file : options.merge) {
    std::istringstream lines(read_file(file, most_shard_bytes));
    std::string title;
    std::getline(lines, title);
    const auto is_title = [&](int i) { return title == shard_title(task, {i, count}); };
    const auto range = std::views::iota(0, count);
    const auto shard = std::ranges::find_if(range, is_title);
    if (shard == range.end())
      throw LoadError(file, "", fmt::format("is no shard of {} of these places", count));
    if (is_there[size_t(*shard)]++)
      throw LoadError(file, "", fmt::format("is shard {} again", *shard + 1));
    size_t first = 0, second = 0;
    for (int line = 2; lines >> first; line++) {
      if (!(lines >> second) || first >= second || second >= task.spectra.size())
        throw LoadError(file, fmt::format("line {}", line), "is no pair of places");
      pairs.emplace_back(first, second);
    }
    if (!lines.eof()) throw LoadError(file, "", "holds what is no pair of places");
  }
  return pairs;
}

// Prints which places of a picture match under one lamp alone.
void print_places(const Options& options) {
  const PlaceTask task = load_places(options);
  if (!options.out.empty()) return write_shard(options, task);
  const std::vector<Places> unlike =
      options.merge.empty() ? find_unlike_places(task.nm, task.spectra, task.lamps, task.settings)
                            : read_shards(options, task);
  const std::vector<PlacePair> pairs =
      choose_place_pairs(task.nm, task.spectra, task.lamps, task.settings, unlike);
  std::cout << options.picture << ": CIEDE2000 between places, column and row of texels, of "
            << task.names.size() << " that were compared\n";
  if (pairs.empty())
    std::cout << "  no two of them are nearer than " << task.settings.near_de00
              << " under one lamp and farther than " << task.settings.far_de00
              << " under another\n";
  else std::cout << place_pairs_text(pairs, task.names, task.lamps);
}

// Writes a report to a file that was asked for.
void write(const std::string& file, const LampReport& report,
           std::string (*print)(const LampReport&)) {
  if (!file.empty()) write_file(file, std::span<const char>(print(report)));
}

void add_options(CLI::App& app, Options& o) {
  app.add_option("package", o.package, "an exhibit's folder, content/ID: its materials");
  app.add_option("--pigments", o.pigments,
                 "files of reflectances: tables (.csv, .tsv, .txt) or .json");
  app.add_option("--lamps", o.lamps,
                 "names of lamps, also 2700K, D5700K, and lines as 589.0*2+589.6; without them a "
                 "candle, bulbs, north light and lamps of today")
      ->delimiter(',');
  app.add_option("--lamp-file", o.lamp_files, "files of lamps that were measured, likewise");
  app.add_option("--glass", o.glasses, "files of refractiveindex.info (.yml): index, Abbe number");
  app.add_option("--adaptation", o.adaptation,
                 "whether eyes get used to each lamp: cat16, or none, to daylight only")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Adaptation>{
          {"none", Adaptation::none}, {"cat16", Adaptation::cat16}}));
  app.add_option("--wavelengths", o.choice.wavelengths, "nm or um; without it found by the numbers")
      ->transform(CLI::CheckedTransformer(std::map<std::string, WavelengthUnit>{
          {"nm", WavelengthUnit::nanometres}, {"um", WavelengthUnit::micrometres}}));
  app.add_option("--values", o.choice.values,
                 "fraction or percent; without it found by the numbers")
      ->transform(CLI::CheckedTransformer(std::map<std::string, ValueUnit>{
          {"fraction", ValueUnit::fractions}, {"percent", ValueUnit::per_cent}}));
  app.add_option("--csv", o.csv, "write a table of all colours");
  app.add_option("--html", o.html, "write a page to look at");
  app.add_option("--json", o.json, "write all of it for programs");
  app.add_option("--picture", o.picture,
                 "a picture of many bands: which places of it match under one lamp alone");
  app.add_option("--places", o.places, "of the picture that are compared, at most")
      ->check(CLI::Range(2, 10'000))
      ->capture_default_str();
  CLI::Option* out = app.add_option("--out", o.out, "file of a shard's pairs of such places");
  CLI::Option* shard = add_shard(app, o.shard, "i/N: a part of those pairs, for N machines");
  shard->needs(out), out->needs(shard);
  app.add_option("--merge", o.merge, "files of all shards: the table is made of them")
      ->excludes(shard);
  app.add_flag("--list-lamps", o.list, "list lamps that have names");
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  log::start("lamps");
  CLI::App app{"Tells how materials and pigments look under other lamps."};
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
    if (options.list) {
      for (const std::string& name : lamp_names())
        std::cout << name << "  " << find_lamp(name)->about << "\n";
      return 0;
    }
    if (options.picture.empty() && (!options.out.empty() || !options.merge.empty()))
      throw CLI::RequiredError("--picture");
    if (!options.picture.empty()) print_places(options);
    if (options.package.empty() && options.pigments.empty() && options.glasses.empty()) {
      if (!options.picture.empty()) return 0;
      throw CLI::RequiredError("an exhibit's folder, --pigments, --picture or --glass");
    }
    const LampReport report = make_report(options);
    std::cout << lamp_report_text(report);
    write(options.csv, report, lamp_report_csv);
    write(options.html, report, lamp_report_html);
    write(options.json, report, lamp_report_json);
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
