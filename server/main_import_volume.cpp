// SPDX-License-Identifier: Apache-2.0
#include "main_import_volume.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <nlohmann/json.hpp>
#include <unistd.h>
#include <vector>

#include "base/child.h"
#include "base/clock.h"
#include "base/load_error.h"
#include "base/parallel.h"
#include "json/text.h"
#include "main_import_preview.h"
#include "volume/bricks/write_bricks.h"
#include "volume/compressed/coding_loss.h"
#include "volume/compressed/compress.h"
#include "volume/compressed/compressed_file.h"
#include "volume/compressed/to_volume.h"
#include "volume/draw/shown_volume.h"
#include "volume/format/byte_stream.h"
#include "volume/format/open_volume.h"
#include "volume/format/patient_frame.h"

namespace wellspring::program {
namespace {

namespace fs = std::filesystem;

constexpr size_t bricks_from = size_t(64) << 20;  // samples; whole in memory they take 512 MiB

struct TemporaryFolder {
  fs::path path;
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "wellspring-import-XXXXXX").string();
    if (!mkdtemp(name.data())) throw LoadError(name, "", "cannot be made");
    path = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path, error);
  }
};

struct Series {
  std::string file, description;
  StoredVolume stored;
  int64_t number = 0;  // the scanner counts series
};

bool is_dicom(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return true;
  if (!fs::is_regular_file(path, error)) return false;
  const std::string bytes = first_bytes(path, 132);
  return bytes.size() == 132 && bytes.ends_with("DICM");
}

// Runs dcm2niix, and repeats its warnings. Names of patients come into no name of a file.
void run_dcm2niix(const std::string& path, const fs::path& out) {
  ChildSettings settings;
  settings.words = {"dcm2niix", "-z", "i", "-b", "y", "-f", "series_%s"};
  if (!fs::is_directory(path)) settings.words.insert(settings.words.end(), {"-s", "y"});
  settings.words.insert(settings.words.end(), {"-o", out.string(), path});
  settings.writes = 1;
  std::string told;
  int status = 127;
  try {
    Child child(settings);
    char bytes[4096];
    for (ssize_t got; (got = read(child.from(), bytes, sizeof bytes)) > 0;)
      told.append(bytes, size_t(got));
    status = child.wait().value_or(-1);
  } catch (const std::runtime_error&) {
    status = 127;
  }
  if (status == 127)
    throw LoadError(path, "", "is DICOM, and the program dcm2niix is missing (Debian: dcm2niix)");
  for (size_t at = 0; at < told.size();) {
    const size_t end = std::min(told.find('\n', at), told.size());
    const std::string line = told.substr(at, end - at);
    if (line.starts_with("Warning") || line.starts_with("Error"))
      std::cerr << "dcm2niix: " << line << "\n";
    at = end + 1;
  }
}

// Returns what the scanner called a series. A volume that dcm2niix turned or filled has its own
// name and the description of the one from which it was made.
void describe_series(Series& series) {
  std::string stem = series.file.substr(0, series.file.size() - std::string(".nii.gz").size());
  std::string how;
  for (const auto& [mark, word] : {std::pair{"_Tilt", "tilt of the gantry taken out"},
                                   std::pair{"_Eq", "slices at equal distances"}})
    if (const size_t at = stem.rfind(mark); at != std::string::npos && !fs::exists(stem + ".json"))
      stem.resize(at), how += std::string(", ") + word;
  if (!fs::exists(stem + ".json")) return;
  const auto json = parse_json_file(stem + ".json", read_json_text(stem + ".json"));
  if (!json.is_object()) return;
  for (const char* name : {"SeriesDescription", "ProtocolName"})
    if (series.description.empty() && json.contains(name) && json[name].is_string())
      series.description = json[name].get<std::string>();
  if (json.contains("SeriesNumber") && json["SeriesNumber"].is_number_integer())
    series.number = json["SeriesNumber"].get<int64_t>();
  series.description += how;
}

std::string size_text(const StoredVolume& stored) {
  std::string text =
      fmt::format("{} x {} x {} samples", stored.size.x, stored.size.y, stored.size.z);
  if (stored.times > 1) text += fmt::format(", {} times", stored.times);
  return text;
}

// Turns DICOM into NIfTI below `folder`; returns the file of the wanted series.
std::string convert_dicom(const VolumeImport& import, const fs::path& folder) {
  run_dcm2niix(import.path, folder);
  std::vector<Series> all;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().string().ends_with(".nii.gz")) {
      Series series;
      series.file = entry.path().string();
      try {
        series.stored = describe_volume(series.file);
      } catch (const LoadError& error) {
        std::cerr << entry.path().filename().string() << ": " << error.what_ << "\n";
        continue;
      }
      describe_series(series);
      all.push_back(std::move(series));
    }
  if (all.empty()) throw LoadError(import.path, "", "has no DICOM that dcm2niix makes a volume of");
  std::ranges::sort(all, [](const Series& a, const Series& b) {
    return std::pair(a.number, a.file) < std::pair(b.number, b.file);
  });
  size_t chosen = 0;
  const auto samples = [](const Series& series) {
    return double(series.stored.stored_bytes()) / bytes_of(series.stored.number);
  };
  for (size_t i = 0; i < all.size(); i++)
    if (samples(all[i]) > samples(all[chosen])) chosen = i;
  if (import.series > int(all.size()))
    throw LoadError(
        import.path, "",
        fmt::format("has {} series, so there is no series {}", all.size(), import.series));
  if (import.series > 0) chosen = size_t(import.series) - 1;
  if (all.size() > 1)
    for (size_t i = 0; i < all.size(); i++)
      std::cerr << fmt::format("{} series {}: {}, {}\n", i == chosen ? "->" : "  ", i + 1,
                               size_text(all[i].stored), all[i].description);
  return all[chosen].file;
}

// Makes the folder of a file that is to be written.
void make_place(const fs::path& to, bool overwrite) {
  if (fs::exists(to) && !overwrite)
    throw LoadError(to.string(), "", "is there already; --overwrite replaces it");
  fs::create_directories(to.parent_path());
}

// Copies a file so that nobody finds half of it.
void copy_whole(const fs::path& from, const fs::path& to, bool overwrite) {
  std::error_code error;
  if (fs::equivalent(from, to, error)) return;
  make_place(to, overwrite);
  const fs::path half = fs::path(to).concat(".part");
  try {
    fs::copy_file(from, half, fs::copy_options::overwrite_existing);
    fs::permissions(half, fs::perms::owner_write, fs::perm_options::add);
    fs::rename(half, to);
  } catch (...) {
    fs::remove(half, error);
    throw;
  }
}

struct Range {
  double least = INFINITY, most = -INFINITY;
};

Range range_of(const Volume& volume) {
  std::vector<Range> slices(static_cast<size_t>(volume.size.z));
  parallel_each(volume.size.z, [&](int z) {
    Range& range = slices[size_t(z)];
    for (int y = 0; y < volume.size.y; y++)
      for (int x = 0; x < volume.size.x; x++)
        for (int channel = 0; channel < volume.channels; channel++)
          if (const double value = volume.at(x, y, z, channel); std::isfinite(value)) {
            range.least = std::min(range.least, value);
            range.most = std::max(range.most, value);
          }
  });
  Range all;
  for (const Range& range : slices) {
    all.least = std::min(all.least, range.least);
    all.most = std::max(all.most, range.most);
  }
  return all;
}

// Returns the name without folder and ending, as an id of a piece.
std::string id_of(const std::string& path) {
  std::string name = fs::path(path).lexically_normal().filename().string();
  if (name.empty()) name = fs::path(path).lexically_normal().parent_path().filename().string();
  std::error_code error;
  if (!fs::is_directory(path, error))
    for (const char* end : {".nii.gz", ".hdr.gz", ".img.gz"})
      if (name.ends_with(end)) name.resize(name.size() - std::string_view(end).size());
  if (fs::is_regular_file(path, error)) name = fs::path(name).stem().string();
  std::string id;
  for (const char letter : name)
    if (id.size() < 64)
      id += std::isalnum(static_cast<unsigned char>(letter)) || letter == '_' || letter == '-'
                ? letter
                : '-';
  return id.empty() || id.find_first_not_of("-_") == std::string::npos ? "volume" : id;
}

// Compresses the volume into `to`, and returns what is then shown.
Volume compress_to(const fs::path& to, const Volume& volume, bool overwrite) {
  make_place(to, overwrite);
  Progress progress("import");
  const CompressedVolume compressed =
      compress_volume(volume, {}, [&](double done) { progress.tell(done); });
  write_compressed(to.string(), compressed);
  const CodingLoss loss = compare_compressed(volume, compressed);
  std::cerr << fmt::format("  {:.3f} bits a voxel, {:.1f} dB\n", loss.bits_a_voxel, loss.decibel);
  return to_volume(compressed);
}

void write_bricks_to(const fs::path& to, const Volume& volume, bool overwrite) {
  make_place(to, overwrite);
  const double began = seconds_now();
  Progress progress("import");
  write_bricks(volume, to.string(), [&](double done) { progress.tell(done); });
  std::cerr << fmt::format("  {}: {:.0f} MiB of bricks, in {:.1f} s\n", to.string(),
                           double(fs::file_size(to)) / 0x1p20, seconds_now() - began);
}

void tell(const std::string& file, const StoredVolume& stored, const Volume& volume) {
  glm::dvec3 spacing;
  for (int i = 0; i < 3; i++) spacing[i] = 1000 * glm::length(glm::dvec3(volume.to_metres[i]));
  const glm::dvec3 extent = spacing * glm::dvec3(volume.size);
  const Range range = range_of(volume);
  std::cerr << fmt::format(
      "{}: {}, {}{}, {:.4g} x {:.4g} x {:.4g} mm apart, {:.4g} x "
      "{:.4g} x {:.4g} mm in all\n",
      file, stored.format, size_text(stored), volume.channels == 3 ? " of colour" : "", spacing.x,
      spacing.y, spacing.z, extent.x, extent.y, extent.z);
  if (range.least <= range.most)
    std::cerr << fmt::format("  values {:.6g} to {:.6g}\n", range.least, range.most);
  else std::cerr << "  no value is finite\n";
  std::cerr << "  " << describe_axes(volume.to_metres)
            << (stored.is_placed ? "" : "; the file does not say, so this is a guess") << "\n";
}

}  // namespace

void import_volume(const VolumeImport& import) {
  std::error_code error;
  if (!fs::exists(import.path, error)) throw LoadError(import.path, "", "is not there");
  const TemporaryFolder folder;
  const bool converts = is_dicom(import.path);
  std::string from = import.path;
  if (converts) from = convert_dicom(import, folder.path);
  // All of it is read before anything is put anywhere.
  const VolumeChoice choice{.time = import.time};
  const StoredVolume stored = describe_volume(from, choice);
  Volume volume = open_volume(from, choice);
  const std::string id = id_of(converts ? import.path : stored.file);
  const fs::path home = fs::path(stored.file).parent_path();
  fs::path made;
  if (import.compress) {
    made = fs::path(import.out) / (id + ".rvq");
    volume = compress_to(made, volume, import.overwrite);
  } else
    for (const std::string& file : files_of(stored)) {
      const fs::path name =
          converts ? fs::path(id + ".nii.gz") : fs::path(file).lexically_relative(home);
      const fs::path to = fs::path(import.out) / (name.empty() ? fs::path(file).filename() : name);
      copy_whole(file, to, import.overwrite);
      if (made.empty()) made = to;
    }
  tell(made.string(), stored, volume);
  if (import.bricks || volume.samples() > bricks_from) {
    made = fs::path(import.out) / (id + ".bricks");
    write_bricks_to(made, volume, import.overwrite);
  }
  if (!import.preview.empty())
    write_preview(made.extension() == ".bricks" ? open_shown_volume(made.string())
                                                : make_shown_volume(volume),
                  import.preview);
  nlohmann::ordered_json piece;
  piece["id"] = id, piece["kind"] = "volume";
  piece["source"] = made.lexically_relative(import.out).string();
  std::cout << piece.dump() << "\n";
}

}  // namespace wellspring::program
