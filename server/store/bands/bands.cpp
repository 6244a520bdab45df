// SPDX-License-Identifier: Apache-2.0
#include "store/bands/bands.h"

#include <filesystem>
#include <fmt/core.h>

#include "json/fields.h"

namespace wellspring::store {
namespace {

constexpr double most_code = 1e9;

// Returns the entries of a list.
std::vector<JsonValue> read_list(FieldReader& fields, const char* name, const char* type,
                                 const char* about) {
  const auto field =
      fields.take(name, FieldReader::list_schema({{"type", type}}, 1, most_bands), about);
  return field ? field->list(1, most_bands) : std::vector<JsonValue>{};
}

// Reads the code of white: one number, or one for each band.
void read_white(FieldReader& fields, std::vector<double>& white) {
  const char* about =
      "code of a reflectance of 1, or one for each band; without it the largest code, 1 of floats";
  const nlohmann::ordered_json number = {{"type", "number"}};
  const auto field = fields.take(
      "white", {{"anyOf", {number, FieldReader::list_schema(number, 1, most_bands)}}}, about);
  if (!field) return;
  const std::vector<JsonValue> list =
      field->value().is_array() ? field->list(1, most_bands) : std::vector<JsonValue>{*field};
  for (const JsonValue& one : list)
    if (double code; one.number(-most_code, most_code, code)) white.push_back(code);
}

// Takes over how OpenLIME describes such pictures.
void read_openlime(FieldReader& fields, Bands& bands) {
  std::string title, address;
  fields.text("title", title, "of the picture; not used");
  fields.text("attribution", bands.source, "the same as source", Need::optional, 2000);
  fields.text("url", address, "where it comes from; not used");
  fields.parts("dataset", most_bands, "files and wavelengths, as OpenLIME lists them",
               [&](FieldReader& one) {
                 std::string name;
                 double nm = 0;
                 one.text("filename", name, "of a band's picture", Need::required);
                 one.number("wavelength", 0, longest_nm, nm, "nanometres", Need::required);
                 bands.files.push_back(name), bands.nm.push_back(nm);
               });
}

void read_fields(FieldReader& fields, Bands& bands) {
  for (const JsonValue& one : read_list(fields, "wavelengths_nm", "number",
                                        "middle of each band, in nanometres, from short to long"))
    if (double nm; one.number(0, longest_nm, nm)) bands.nm.push_back(nm);
  for (const JsonValue& one :
       read_list(fields, "files", "string",
                 "files beside this one, for the import: one with all bands, or one for each band"))
    if (std::string name; one.text(name, max_text_bytes, Need::required))
      bands.files.push_back(name);
  read_white(fields, bands.white);
  fields.number("black", -most_code, most_code, bands.black, "code of no light, 0");
  fields.number("gamma", 0.2, 5, bands.gamma,
                "((code - black) / (white - black)) to this power is the reflectance, 1");
  fields.text("source", bands.source, "who measured it, and whose it is", Need::optional, 2000);
  read_openlime(fields, bands);
}

void check_wavelengths(const std::vector<double>& nm, const char* field, Faults& faults) {
  const auto at = [&](size_t i) { return fmt::format("/{}/{}", field, i); };
  if (nm.empty())
    return faults.add("", "names no wavelengths: \"wavelengths_nm\": [400, 410, ...]");
  if (std::ranges::all_of(nm, [](double one) { return one > 0 && one < 30; }))
    return faults.add(at(0), fmt::format("is {:g}: wavelengths are nanometres here, not "
                                         "micrometres: {:g}",
                                         nm[0], nm[0] * 1000));
  for (size_t i = 0; i < nm.size(); i++) {
    if (nm[i] < shortest_nm)
      return faults.add(at(i), fmt::format("is {:g}: nanometres from {:g} to {:g} are read", nm[i],
                                           shortest_nm, longest_nm));
    if (i > 0 && nm[i] == nm[i - 1])
      return faults.add(at(i), fmt::format("{:g} nm is there twice", nm[i]));
    if (i > 0 && nm[i] < nm[i - 1])
      return faults.add(at(i), fmt::format("{:g} nm comes after {:g} nm: bands go from short to "
                                           "long wavelengths",
                                           nm[i], nm[i - 1]));
  }
}

}  // namespace

Bands read_bands(const std::string& file, const std::string& text) {
  const nlohmann::json json = parse_json_file(file, text);
  Faults faults(file, true, text);
  Bands bands;
  FieldReader::read_object(JsonValue(json, faults),
                           [&](FieldReader& fields) { read_fields(fields, bands); });
  check_wavelengths(bands.nm, json.contains("dataset") ? "dataset" : "wavelengths_nm", faults);
  const size_t count = bands.nm.size();
  if (bands.files.size() > 1 && bands.files.size() != count)
    faults.add("/files", fmt::format("names {} files for {} wavelengths: there is one for each, or "
                                     "one with all bands",
                                     bands.files.size(), count));
  if (bands.white.size() > 1 && bands.white.size() != count)
    faults.add("/white", fmt::format("has {} codes for {} wavelengths", bands.white.size(), count));
  for (const double white : bands.white)
    if (white <= bands.black)
      faults.add("/white", fmt::format("{:g} is not above black, {:g}", white, bands.black));
  return bands;
}

std::string write_bands(const Bands& bands) {
  nlohmann::ordered_json json = {{"wavelengths_nm", bands.nm}};
  if (bands.white.size() == 1) json["white"] = bands.white[0];
  else if (!bands.white.empty()) json["white"] = bands.white;
  if (bands.black != 0) json["black"] = bands.black;
  if (bands.gamma != 1) json["gamma"] = bands.gamma;
  if (!bands.source.empty()) json["source"] = bands.source;
  return json.dump();
}

nlohmann::ordered_json bands_schema() {
  return FieldReader::object_schema([](FieldReader& fields) {
    Bands bands;
    read_fields(fields, bands);
  });
}

std::string bands_file_of(const std::string& tiff) {
  return std::filesystem::path(tiff).replace_extension(".bands.json").string();
}

std::optional<Bands> find_bands(const std::string& tiff, const std::string& image_description) {
  // Other programs write JSON, too, such as {"shape": ..}.
  if (image_description.starts_with("{") &&
      image_description.find("\"wavelengths_nm\"") != std::string::npos)
    return read_bands(tiff, image_description);
  std::error_code error;
  const std::string beside = bands_file_of(tiff);
  if (!std::filesystem::is_regular_file(beside, error)) return std::nullopt;
  return read_bands(beside, read_json_text(beside));
}

}  // namespace wellspring::store
