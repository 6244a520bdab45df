// SPDX-License-Identifier: Apache-2.0
// pieces.bands: a picture of many bands. How long does a tile take that is computed from 31 bands,
// beside one that is stored as red, green and blue; how large are files, and how far are colours
// off by ways to store a painting in 31 bands?
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <tiffio.h>

#include "base/clock.h"
#include "large_picture_room.h"
#include "own_folder.h"
#include "report.h"
#include "reports.h"
#include "spectrum/band_matrix.h"
#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "store/band_files/band_places.h"
#include "store/band_files/band_pyramid.h"
#include "store/open/open_picture.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

constexpr int made_side = 512, made_bands = 31;

// Writes floats in strips: smooth spots of pigments with a hundredth of noise.
std::string make_painting(const std::string& file) {
  TIFF* tiff = TIFFOpen(file.c_str(), "w");
  if (!tiff) throw std::runtime_error(file + ": cannot be written");
  Bands bands;
  for (int i = 0; i < made_bands; i++) bands.nm.push_back(400 + 10 * i);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, made_side);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, made_side);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, made_bands);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1);
  TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, write_bands(bands).c_str());
  std::mt19937 random(9);
  std::vector<float> row(size_t(made_side) * made_bands);
  for (int y = 0; y < made_side; y++) {
    for (int x = 0; x < made_side; x++)
      for (int band = 0; band < made_bands; band++) {
        const double edge = 15 + 12 * std::sin(x / 31.0) * std::cos(y / 23.0);
        const double noise = 0.01 * (double(random()) / 4294967296.0 - 0.5);
        row[size_t(x * made_bands + band)] =
            float(std::max(0.0, 0.04 + 0.6 / (1 + std::exp((edge - band) / 2)) + noise));
      }
    TIFFWriteEncodedStrip(tiff, uint32_t(y), row.data(), tmsize_t(row.size() * sizeof(float)));
  }
  TIFFClose(tiff);
  return file;
}

std::string find_painting(const BenchOptions& options) {
  const char* data = std::getenv("WELLSPRING_DATA");
  const std::string folder = (data ? data : options.content + "/../../shared/data") +
                             std::string("/10_exhibits/pictures/oil_painting_31_bands");
  return fs::exists(folder) ? folder : "";
}

// Measures tiles of the finest level, each fetched anew.
void measure_band_tile(BenchReport& report, const std::string& file, const std::string& layout,
                       const std::string& view_name, const BandView& view, double seconds) {
  const auto picture = open_picture(file, "", "en", {}, view);
  const PyramidLevel& level = picture->levels()[0];
  const int columns = int(level.width) / level.tile_width;
  const int rows = int(level.height) / level.tile_height;
  std::vector<double> times;
  std::mt19937 random(3);
  for (const double end = seconds_now() + seconds; seconds_now() < end;) {
    const uint32_t column = random() % uint32_t(columns), row = random() % uint32_t(rows);
    const double began = seconds_now();
    picture->fetch({1, 0, column, row});
    times.push_back(1000 * (seconds_now() - began));
  }
  report.add("pieces.bands.tile_ms", quantile(times, 0.5), "ms",
             {{"layout", layout}, {"view", view_name}});
}

// Measures how far colours in daylight and by candle are from those of `truth`.
void measure_band_colors(BenchReport& report, const BandSource& truth, const std::string& file,
                         const std::string& layout) {
  const std::vector<BandPlace> wanted = sample_places(truth, 10'000, 1);
  const std::vector<BandPlace> found = sample_places(BandSource(file), 10'000, 1);
  std::vector<double> differences;
  for (const char* lamp : {"D65", "candle"}) {
    const std::vector<dvec3> matrix = band_matrix(truth.bands().nm, find_lamp(lamp)->power);
    dvec3 white(0);
    for (const dvec3& one : matrix) white += one;
    const auto lab = [&](const BandPlace& place) {
      dvec3 xyz(0);
      for (size_t i = 0; i < matrix.size(); i++) xyz += matrix[i] * place.reflectances[i];
      return lab_of(xyz, white);
    };
    for (size_t i = 0; i < wanted.size(); i++)
      differences.push_back(ciede2000(lab(wanted[i]), lab(found[i])));
  }
  double sum = 0;
  for (const double one : differences) sum += one;
  report.add("pieces.bands.de00_mean", sum / double(differences.size()), "dE00",
             {{"layout", layout}});
  report.add("pieces.bands.de00_p99", quantile(differences, 0.99), "dE00", {{"layout", layout}});
}

}  // namespace

void bench_pieces_bands(BenchReport& report, const BenchOptions& options) {
  const LargePictureRoom room;  // a tiled TIFF of JPEGs
  const std::string plain = room.picture();
  const double seconds = options.quick ? 0.5 : 2;
  const OwnFolder folder;
  const std::string real = find_painting(options);
  const BandSource source(real.empty() ? make_painting(folder.path() + "/raw.tif") : real);
  struct Layout {
    const char* name;
    BandPyramidSettings settings;
  };
  for (const Layout& layout : {Layout{"8 bits", {}}, Layout{"16 bits", {.bits = 16}},
                               Layout{"8 bits, JPEG of 90", {.quality = 90}}}) {
    const std::string file = folder.path() + "/a.tif";
    write_band_pyramid(source, file, layout.settings);
    report.add("pieces.bands.bytes_a_texel",
               double(fs::file_size(file)) / double(source.width() * source.height()), "B",
               {{"layout", layout.name}});
    measure_band_colors(report, source, file, layout.name);
    measure_band_tile(report, file, layout.name, "lamp", {"candle", false, {}}, seconds);
    measure_band_tile(report, file, layout.name, "false colours", {"", false, {700, 650, 550}},
                      seconds);
    measure_band_tile(report, file, layout.name, "one band", {"", false, {650}}, seconds);
  }
  const std::string rgb = "red, green, blue, JPEG of 90";
  const auto picture = open_picture(plain);
  const PyramidLevel& level = picture->levels()[0];
  report.add("pieces.bands.bytes_a_texel",
             double(fs::file_size(plain)) / double(level.width * level.height), "B",
             {{"layout", rgb}});
  measure_band_tile(report, plain, rgb, "lamp", {}, seconds);
}

ReportPage pieces_bands_page() {
  return {
      "pieces.bands",
      "What do pictures of many bands take, a tile and a file, and how far are their colours off?",
      {"A painting in 31 bands, 512x512 texels (CAVE's where it is at hand, else a made one). A "
       "tile "
       "of 256x256 is read and computed by one thread, from files that are in memory; bytes are "
       "those of the file with its smaller versions; CIEDE2000 is that of what is stored, by "
       "daylight and by candle."},
      {{.caption = "A tile, ms",
        .rows = {{"layout", "stored as"}},
        .columns = {{"pieces.bands.tile_ms", "median"}},
        .across = "view",
        .most_rows = 4},
       {.caption = "A file",
        .rows = {{"layout", "stored as"}},
        .columns = {{"pieces.bands.bytes_a_texel", "a texel"},
                    {"pieces.bands.de00_mean", "colours off, mean"},
                    {"pieces.bands.de00_p99", "99th percentile"}},
        .most_rows = 4}}};
}

}  // namespace wellspring::test
