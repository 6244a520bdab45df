// SPDX-License-Identifier: Apache-2.0
#include "store/band_files/band_source.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <regex>

#include "base/load_error.h"
#include "base/read_file.h"
#include "image/image.h"
#include "json/text.h"
#include "store/picture/pyramid.h"

namespace wellspring::store {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_file_bytes = size_t(2) << 30;
constexpr int64_t most_png_texels = int64_t(1) << 28;

std::string ending_of(const std::string& file) {
  std::string ending = fs::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}
bool is_tiff(const std::string& file) {
  return ending_of(file) == ".tif" || ending_of(file) == ".tiff";
}
bool is_png(const std::string& file) { return ending_of(file) == ".png"; }

// Returns the wavelength that a name tells, "oil_0450nm.png" or "450 nm"; 0: none.
double wavelength_in(const std::string& name) {
  static const std::regex number(R"(([0-9]{3,5}(?:\.[0-9]+)?)[ _-]?nm)", std::regex::icase);
  std::smatch found;
  return std::regex_search(name, found, number) ? std::stod(found[1]) : 0;
}

// Checks wavelengths that names tell: they rise.
void check_rising(const std::string& file, const std::vector<double>& nm) {
  for (size_t i = 1; i < nm.size(); i++)
    if (nm[i] <= nm[i - 1])
      throw LoadError(file, "",
                      fmt::format("{:g} nm ", nm[i]) +
                          (nm[i] == nm[i - 1] ? "is there twice" : "comes after longer ones"));
}

}  // namespace

BandSource::BandSource(const std::string& path, int level) {
  std::error_code error;
  if (fs::is_directory(path, error)) open_folder(path);
  else if (!fs::is_regular_file(path, error)) throw LoadError(path, "", "is not there");
  else if (ending_of(path) == ".json") open_json(path);
  else if (is_tiff(path)) open_tiff(path, level);
  else throw LoadError(path, "", "is no picture of bands: a TIFF, NAME.bands.json or a folder");
  if (all_.size() != bands_.nm.size())
    throw LoadError(path, "",
                    fmt::format("has {} bands for {} wavelengths", all_.size(), bands_.nm.size()));
}

void BandSource::open_json(const std::string& file) {
  bands_ = read_bands(file, read_json_text(file));
  const fs::path folder = fs::path(file).parent_path();
  std::vector<std::string> files = bands_.files;
  if (files.empty()) {
    // The file beside it has the same name.
    std::string name = fs::path(file).filename().string();
    const size_t end = name.ends_with(".bands.json") ? name.size() - 11 : name.rfind('.');
    for (const char* ending : {".tif", ".tiff"})
      if (fs::is_regular_file(folder / (name.substr(0, end) + ending)))
        files = {name.substr(0, end) + ending};
    if (files.empty())
      throw LoadError(file, "", "names no \"files\", and there is no TIFF of its name beside it");
  }
  open_files(folder.string(), files);
}

void BandSource::open_folder(const std::string& folder) {
  std::vector<std::string> descriptions;
  std::vector<std::pair<double, std::string>> named;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (ending_of(name) == ".json") descriptions.push_back(entry.path().string());
    const double nm = wavelength_in(name);
    if (nm > 0 && (is_png(name) || is_tiff(name))) named.emplace_back(nm, name);
  }
  if (descriptions.size() > 1)
    throw LoadError(folder, "", "has several .json files; name the one that describes the bands");
  if (!descriptions.empty()) return open_json(descriptions[0]);
  if (named.empty())
    throw LoadError(folder, "",
                    "has neither a .json that describes bands, nor PNG or TIFF files whose names "
                    "tell wavelengths, as band_450nm.png");
  std::ranges::sort(named);
  std::vector<std::string> files;
  for (const auto& [nm, name] : named) bands_.nm.push_back(nm), files.push_back(name);
  check_rising(folder, bands_.nm);
  open_files(folder, files);
}

void BandSource::open_files(const std::string& folder, const std::vector<std::string>& files) {
  if (files.size() > most_bands)
    throw LoadError(folder, "", fmt::format("has more than {} bands", most_bands));
  const bool has_all = files.size() == 1 && bands_.nm.size() > 1;
  for (const std::string& name : files) {
    const std::string file = (fs::path(folder) / name).string();
    std::error_code error;
    if (!fs::is_regular_file(file, error))
      throw LoadError(file, "", "is not there, and is named as a file of bands");
    if (!is_tiff(name) && !is_png(name))
      throw LoadError(file, "", "is neither PNG nor TIFF, which alone are read as bands");
    if (has_all && is_png(name))
      throw LoadError(file, "", "is one PNG for several wavelengths; a PNG has one band");
    if (has_all) open_tiff(file, 0);
    else if (is_png(name)) add_png(file);
    else add_tiff_page(file);
  }
}

void BandSource::open_tiff(const std::string& file, int level) {
  auto tiff = std::make_shared<TiffFile>(file);
  std::vector<TiffFile::BandPage> pages = tiff->read_band_pages();
  if (bands_.nm.empty()) {
    if (const auto known = find_bands(file, tiff->description())) bands_ = *known;
    else
      for (const TiffFile::BandPage& one : pages) {
        if (const double nm = wavelength_in(one.page_name); nm > 0) bands_.nm.push_back(nm);
        else
          throw LoadError(file, one.page.name,
                          "tells no wavelength: there is neither a description of the bands "
                          "inside or in NAME.bands.json, nor a PageName as \"450 nm\"");
        check_rising(file, bands_.nm);
      }
  }
  // Smaller versions are no bands of their own.
  if (size_t(pages[0].page.channels) == bands_.nm.size()) {
    if (level > 0) {
      // One band can be shown even where all of them tell no colours.
      auto levels = std::make_shared<TiffFile>(file, BandView{.shown_nm = {bands_.nm[0]}});
      const std::vector<TiffPage> known = levels->read_pages();
      return add_channels(levels, file, known.at(size_t(level)));
    }
    return add_channels(tiff, file, pages[0].page);
  }
  for (const TiffFile::BandPage& one : pages) {
    if (one.page.channels != 1)
      throw LoadError(file, one.page.name,
                      fmt::format("has {} samples a pixel for {} wavelengths", one.page.channels,
                                  bands_.nm.size()));
    add_channels(tiff, file, one.page);
  }
}

void BandSource::add(Band band, int64_t width, int64_t height) {
  if (all_.empty()) {
    width_ = width, height_ = height;
  } else if (width != width_ || height != height_) {
    const std::string where = band.tiff ? band.page.name : "";
    throw LoadError(band.file, where,
                    fmt::format("is {} x {} texels, while the first band, {}, is {} x {}", width,
                                height, all_[0].file, width_, height_));
  }
  all_.push_back(std::move(band));
}

void BandSource::add_png(const std::string& file) {
  const auto bytes = read_file<std::vector<uint8_t>>(file, most_file_bytes);
  const ImageCodes codes = decode_png(bytes, most_png_texels, file);
  const bool wide = codes.codes8.empty();
  const size_t count = size_t(codes.width) * size_t(codes.height);
  Band band{file, wide ? BandCode::u16 : BandCode::u8, {}, nullptr, {}, 0};
  png_bytes_ += int64_t(count) * bytes_of(band.code);
  if (png_bytes_ > most_png_bytes)
    throw LoadError(file, "", "is too much, with the bands before it: as TIFFs they can be larger");
  band.codes.resize(count * size_t(bytes_of(band.code)));
  const auto take = [&](const auto& rgba) {
    for (size_t i = 0; i < count; i++) {
      if (rgba[4 * i] != rgba[4 * i + 1] || rgba[4 * i] != rgba[4 * i + 2])
        throw LoadError(
            file, fmt::format("pixel {}, {}", i % size_t(codes.width), i / size_t(codes.width)),
            "is coloured: a band is grey");
      std::memcpy(&band.codes[i * sizeof(rgba[0])], &rgba[4 * i], sizeof(rgba[0]));
    }
  };
  if (wide) take(codes.codes16);
  else take(codes.codes8);
  add(std::move(band), codes.width, codes.height);
}

void BandSource::add_tiff_page(const std::string& file) {
  const auto tiff = std::make_shared<TiffFile>(file);
  const TiffPage page = tiff->read_band_pages()[0].page;
  if (page.channels != 1)
    throw LoadError(
        file, page.name,
        fmt::format("has {} samples a pixel: one band of several has 1", page.channels));
  add_channels(tiff, file, page);
}

void BandSource::add_channels(const std::shared_ptr<TiffFile>& tiff, const std::string& file,
                              const TiffPage& page) {
  if (!page.orientation.is_upright())
    throw LoadError(file, page.name, "is turned; bands have their first row at the top");
  check_stored(page, tiff->size(), file);
  for (int channel = 0; channel < page.channels; channel++)
    add({file, code_of(page), {}, tiff, page, channel}, page.width, page.height);
}

void BandSource::read_blocks(size_t number, int64_t top, int rows, std::span<float> to) const {
  const Band& band = all_[number];
  const TiffPage& page = band.page;
  const int plane = page.is_planar ? band.channel : 0;
  const size_t stride = page.is_planar ? 1 : size_t(page.channels);
  const size_t code_bytes = size_t(bytes_of(band.code));
  const int64_t bottom = top + rows;
  for (int row = int(top / page.block_height); int64_t(row) * page.block_height < bottom; row++)
    for (int column = 0; int64_t(column) * page.block_width < page.width; column++) {
      if (last_.tiff != band.tiff.get() || last_.page != page.offset || last_.column != column ||
          last_.row != row || last_.plane != plane) {
        last_.codes = band.tiff->read_codes(page, column, row, plane);
        last_.tiff = band.tiff.get(), last_.page = page.offset;
        last_.column = column, last_.row = row, last_.plane = plane;
      }
      const int64_t left = int64_t(column) * page.block_width;
      const int64_t high = int64_t(row) * page.block_height;
      const size_t wide = size_t(std::min<int64_t>(page.block_width, page.width - left));
      const int64_t end = std::min({high + page.block_height, bottom, page.height});
      for (int64_t y = std::max(top, high); y < end; y++) {
        const size_t first = size_t(y - high) * size_t(page.block_width) * stride +
                             (page.is_planar ? 0 : size_t(band.channel));
        const std::span<float> line =
            to.subspan(size_t(y - top) * size_t(width_) + size_t(left), wide);
        read_reflectances(bands_, number, band.code,
                          {last_.codes.data() + first * code_bytes, stride}, line);
      }
    }
}

void BandSource::read(int64_t top, int rows, std::vector<float>& reflectances) const {
  const size_t texels = size_t(width_) * size_t(rows);
  reflectances.resize(texels * all_.size());
  for (size_t i = 0; i < all_.size(); i++) {
    const std::span<float> to = std::span(reflectances).subspan(i * texels, texels);
    if (all_[i].tiff) read_blocks(i, top, rows, to);
    else
      read_reflectances(
          bands_, i, all_[i].code,
          {all_[i].codes.data() + size_t(top) * size_t(width_) * size_t(bytes_of(all_[i].code)), 1},
          to);
    const auto wrong = std::ranges::find_if(to, [](float r) { return !std::isfinite(r); });
    if (wrong != to.end()) {
      const int64_t at = wrong - to.begin();
      throw LoadError(all_[i].file,
                      fmt::format("band {} ({:g} nm), pixel {}, {}", i + 1, bands_.nm[i],
                                  at % width_, top + at / width_),
                      "is no number");
    }
  }
}

}  // namespace wellspring::store
