// SPDX-License-Identifier: Apache-2.0
// Runs `wellspring import picture FILE...`: makes tiled TIFFs with smaller versions inside of
// pictures of any format that vips reads, for `pieces` of exhibit.json; and `wellspring import
// volume PATH`: reads a scanned volume, of DICOM by dcm2niix, and puts it into an exhibit; and
// `wellspring import scan FILE...`: makes a tree of the points of a place or thing; and `wellspring
// import bands PATH`: makes a tiled TIFF of a picture of many bands. Exit status: 0 done, 1 the
// input is wrong, 2 the command line is wrong.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <regex>
#include <unistd.h>

#include "about/version.h"
#include "base/child.h"
#include "base/clock.h"
#include "base/load_error.h"
#include "base/log.h"
#include "main_import_bands.h"
#include "main_import_scan.h"
#include "main_import_volume.h"
#include "main_shard.h"
#include "store/bands/bands.h"
#include "store/open/open_picture.h"
#include "volume/format/raw_json.h"

using namespace wellspring;
using namespace wellspring::program;

namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> files;
  std::string out = ".";
  double width = 0;  // metres; 0: unknown
  int quality = 90;
  bool overwrite = false;
  Shard shard;         // which files are read
  bool merge = false;  // all are made: their pieces are printed
};

// Shows how far vips has come, by what it writes: "vips temp-3: 34% complete".
void show_progress(int from, Progress& progress) {
  static const std::regex percent("([0-9]{1,3})% complete");
  std::string text;
  char bytes[4096];
  for (ssize_t got; (got = read(from, bytes, sizeof bytes)) > 0;) {
    text.append(bytes, size_t(got));
    std::string last;
    for (std::sregex_iterator match(text.begin(), text.end(), percent), end; match != end; ++match)
      last = (*match)[1];
    if (last.empty()) continue;
    progress.tell(std::stoi(last) / 100.0);
    text.erase(0, text.rfind(last + "%"));
  }
}

// Writes the pyramid of `file` to `made`. Codes become 8-bit sRGB; a colour profile stays inside.
void run_vips(const std::string& file, const std::string& made, int quality) {
  const std::string how =
      "[tile,pyramid,bigtiff,tile-width=256,tile-height=256,compression=jpeg,Q=" +
      std::to_string(quality) + "]";
  ChildSettings settings;
  settings.words = {"vips", "--vips-progress", "colourspace", file, made + how, "srgb"};
  settings.writes = 1;
  Child vips(settings);
  Progress progress("import");
  show_progress(vips.from(), progress);
  if (const int status = vips.wait().value_or(-1); status != 0)
    throw LoadError(file, "",
                    status == 127 ? "the program vips is missing (Debian: libvips-tools)"
                                  : "vips cannot turn it into a TIFF; its reason stands above");
}

fs::path made_of(const Options& options, const std::string& file) {
  return fs::path(options.out) / fs::path(file).stem().concat(".tif");
}

void print_picture(const Options& options, const fs::path& made) {
  std::cout << "{\"id\": \"" << made.stem().string() << "\", \"kind\": \"picture\", \"source\": \""
            << made.filename().string()
            << "\", \"width_m\": " << (options.width > 0 ? options.width : 1)
            << ", \"place\": {\"position\": [0, 1.5, 0], \"yaw_deg\": 0}}\n";
}

void import_picture(const Options& options, const std::string& file) {
  if (!fs::is_regular_file(file)) throw LoadError(file, "", "is no file");
  const fs::path made = made_of(options, file);
  std::error_code error;
  if (fs::exists(made) && (!options.overwrite || fs::equivalent(made, file, error)))
    throw LoadError(made.string(), "", "is there already; --overwrite replaces it");
  // Nobody finds half a file.
  const std::string half = made.string() + ".part.tif";
  const double began = seconds_now();
  try {
    run_vips(file, half, options.quality);
    const auto picture = open_picture(half);
    fs::rename(half, made);
    const PyramidLevel& whole = picture->levels().front();
    std::cerr << made.string() << ": " << whole.width << " x " << whole.height << " texels, "
              << picture->levels().size() << " levels, " << fs::file_size(made) / 1'000'000
              << " MB, " << int(seconds_now() - began + 0.5) << " s\n";
  } catch (...) {
    fs::remove(half, error);
    throw;
  }
  print_picture(options, made);
}

// Imports the files of a shard; or, when all shards are done, prints what each would have printed.
void import_pictures(const Options& options) {
  fs::create_directories(options.out);
  for (size_t i = 0; i < options.files.size(); i++) {
    if (!options.merge) {
      if (options.shard.has(i)) import_picture(options, options.files[i]);
      continue;
    }
    const fs::path made = made_of(options, options.files[i]);
    if (!fs::exists(made)) throw LoadError(made.string(), "", "is missing: its shard is not done");
    open_picture(made.string());
    print_picture(options, made);
  }
}

// Several imports have the next three options.
void add_overwrite(CLI::App& app, bool& overwrite) {
  app.add_flag("--overwrite", overwrite, "replace what is there");
}

void add_width(CLI::App& app, double& metres) {
  app.add_option("--width", metres, "of the picture, in metres")->check(CLI::Range(0.001, 1000.0));
}

CLI::Option* add_quality(CLI::App& app, int& quality, const char* about) {
  return app.add_option("--quality", quality, about)->check(CLI::Range(1, 100));
}

void add_band_options(CLI::App& app, BandImport& import) {
  CLI::App& bands = *app.add_subcommand(
      "bands", "a picture of many bands, as a tiled TIFF; prints a piece for exhibit.json");
  bands
      .add_option("path", import.path,
                  "NAME.bands.json, a TIFF whose samples or pages are bands, or a folder of a PNG "
                  "or TIFF for each")
      ->required();
  bands.add_option("--out", import.out, "folder for the picture")->capture_default_str();
  bands.add_option("--name", import.name, "of the picture; without it that of the path");
  add_width(bands, import.width);
  bands.add_option("--bits", import.bits, "of a value: 8 of its square root, or 16 of itself")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
  add_quality(bands, import.quality,
              "of JPEG tiles, which are a third as large; without it nothing else is lost");
  bands.add_option("--lamps", import.lamps, "of layers that are proposed")
      ->delimiter(',')
      ->capture_default_str();
  add_overwrite(bands, import.overwrite);
  bands.add_flag_callback(
      "--schema",
      [] {
        std::cout << bands_schema().dump(2) << "\n";
        throw CLI::Success();
      },
      "print the JSON Schema of NAME.bands.json");
}

}  // namespace

int main(int argc, char** argv) {
  if (answer_version(argc, argv)) return 0;
  log::start("import");
  CLI::App app{"Makes of large files and of scans what an exhibit can show."};
  app.require_subcommand(1);
  Options options;
  CLI::App& picture = *app.add_subcommand(
      "picture", "a tiled TIFF with smaller versions inside; prints a piece for exhibit.json");
  picture.add_option("files", options.files, "pictures of any format that vips reads")->required();
  picture.add_option("--out", options.out, "folder for what is made")->capture_default_str();
  add_width(picture, options.width);
  add_quality(picture, options.quality, "of JPEG tiles")->capture_default_str();
  add_overwrite(picture, options.overwrite);
  add_shard(picture, options.shard, "i/N: every N-th file, for N machines");
  picture.add_flag("--merge", options.merge,
                   "all shards are done: prints the pieces that one import would have printed");
  VolumeImport scan;
  CLI::App& volume = *app.add_subcommand(
      "volume", "a scan, for an exhibit: checks it, copies it, prints a piece for exhibit.json");
  volume
      .add_option("path", scan.path,
                  "a folder of DICOM, or NIfTI, Analyze, NRRD, MetaImage, SLC, or JSON of raw "
                  "samples")
      ->required();
  volume.add_option("--out", scan.out, "folder for the volume")->capture_default_str();
  volume
      .add_option("--series", scan.series, "of DICOM, as they are listed; that with most samples")
      ->check(CLI::Range(1, 100000));
  volume.add_option("--time", scan.time, "of several in a file, from 0, to be looked at")
      ->check(CLI::Range(0, 1 << 20));
  volume.add_option("--preview", scan.preview, "a PNG that shows it in the presets that fit it");
  volume.add_flag("--compress", scan.compress,
                  "write it at 0.75 bits a voxel and 2 to 4 MB of codebooks, with losses");
  volume.add_flag("--bricks", scan.bricks,
                  "write bricks, which are shown without all being in memory; of more than 64 Mi "
                  "samples they are always written");
  add_overwrite(volume, scan.overwrite);
  volume.add_flag_callback(
      "--raw-schema",
      [] {
        std::cout << raw_json_schema().dump(2) << "\n";
        throw CLI::Success();
      },
      "print the JSON Schema of the file that describes raw samples");
  ScanImport place;
  CLI::App& points = *app.add_subcommand(
      "scan", "points of a place or thing, as a tree that is larger than memory; prints a piece");
  points
      .add_option("files", place.files,
                  "LAS, LAZ, COPC, EPT, E57, PLY, PTS, XYZ, PCD or glTF; all of one scan; or a "
                  ".scanner.json, which scans a scene")
      ->required();
  points.add_option("--out", place.out,
                    "folder for the tree; the current one, of a .scanner.json its own");
  points.add_option("--name", place.name, "of the tree; without it that of the first file");
  points.add_option("--up", place.up, "axis of the files that points up")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  points.add_option("--unit", place.unit, "metres of a unit of the files; without it as they say")
      ->check(CLI::Range(1e-6, 1e6));
  points.add_option("--turn", place.turn, "degrees by which it is turned to the left")
      ->check(CLI::Range(-360.0, 360.0));
  points.add_option("--memory", place.memory, "MiB that may be used")
      ->check(CLI::Range(64, 1 << 20))
      ->capture_default_str();
  add_overwrite(points, place.overwrite);
  BandImport bands;
  add_band_options(app, bands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (volume.parsed()) return import_volume(scan), 0;
    if (points.parsed()) return import_scan(place), 0;
    if (!bands.path.empty()) return import_bands(bands), 0;
    import_pictures(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
