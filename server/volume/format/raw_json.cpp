// SPDX-License-Identifier: Apache-2.0
#include "volume/format/raw_json.h"

#include <bit>
#include <cmath>
#include <filesystem>

#include "base/load_error.h"
#include "json/fields.h"
#include "volume/format/byte_stream.h"
#include "volume/format/header_text.h"
#include "volume/format/patient_frame.h"

namespace wellspring::volume {
namespace {

struct RawDescription {
  std::string file, byte_order, axes;
  Number kind = Number::u8;
  bool is_colored = false;
  glm::dvec3 size{0}, spacing_mm{1}, origin_mm{0};
  double slope = 1, intercept = 0;
  int64_t skip_bytes = 0;
};

void read_fields(FieldReader& fields, RawDescription& raw) {
  constexpr Need must = Need::required;
  fields.text("file", raw.file, "file of samples beside this one; x runs fastest, then y", must);
  fields.vector("size", double(longest_volume), raw.size, "samples along x, y and z", must);
  fields.choice("kind", {"u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64", "u64", "i64"},
                raw.kind, "kind of a sample: unsigned, signed or real, and its bits", must);
  fields.boolean("colors", raw.is_colored, "each sample is red, green and blue, as u8");
  fields.vector("spacing_mm", 1e6, raw.spacing_mm, "from sample to sample, in millimetres", must);
  fields.word("byte_order", {"little", "big"}, raw.byte_order, "of samples; little if absent");
  fields.number("slope", -1e12, 1e12, raw.slope, "a sample s measures slope * s + intercept");
  fields.number("intercept", -1e12, 1e12, raw.intercept, "see slope");
  fields.vector("origin", 1e9, raw.origin_mm,
                "place of the first sample in millimetres, along the letters of axes");
  fields.text("axes", raw.axes,
              "to where x, y and z run: L or R is the patient's left or right, A or P front or "
              "back, S or I up or down; LPS if absent");
  fields.integer("skip_bytes", 0, 0x1p40, raw.skip_bytes, "in the file before the samples");
}

}  // namespace

nlohmann::ordered_json raw_json_schema() {
  return FieldReader::object_schema([](FieldReader& fields) {
    RawDescription raw;
    read_fields(fields, raw);
  });
}

StoredVolume read_raw_json(const std::string& file) {
  const std::string text = read_json_text(file);
  const nlohmann::json json = parse_json_file(file, text);
  Faults faults(file, true, text);
  RawDescription raw;
  FieldReader::read_object(JsonValue(json, faults),
                           [&](FieldReader& fields) { read_fields(fields, raw); });
  const auto fail = [&](const char* where, const std::string& what) { faults.add(where, what); };
  if (!raw.axes.empty() && !are_axes(raw.axes))
    fail("/axes", "is not one letter each of LR, AP and SI");
  if (raw.is_colored && raw.kind != Number::u8) fail("/colors", "needs the kind u8");
  if (raw.slope == 0) fail("/slope", "is 0");
  if (raw.size != glm::floor(raw.size)) fail("/size", "has a number that is not whole");

  StoredVolume stored;
  stored.file = file, stored.format = "raw samples";
  stored.number = raw.kind;
  if (raw.is_colored) stored.components = stored.channels = 3;
  stored.is_swapped = (raw.byte_order == "big") == (std::endian::native == std::endian::little);
  stored.slope = raw.slope, stored.intercept = raw.intercept;
  set_size(stored, to_whole(raw.size[0]), to_whole(raw.size[1]), to_whole(raw.size[2]), "/size");
  complete_spacing(stored, raw.spacing_mm, "/spacing_mm");
  stored.is_placed = !raw.axes.empty();
  set_place(stored, affine_of(raw.spacing_mm, raw.origin_mm),
            raw.axes.empty() ? unstated_axes : raw.axes, 1e-3, "/spacing_mm");
  const std::string samples = companion(file, raw.file, "/file");
  if (is_gzip(samples)) stored.packing = Packing::deflate;
  set_parts(stored, {samples}, 0, 0, raw.skip_bytes, "/skip_bytes");
  return stored;
}

std::string find_raw_json(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path path(file);
  for (const fs::path& beside :
       {fs::path(path).replace_extension(".json"), fs::path(file + ".json")})
    if (beside != path && fs::is_regular_file(beside, error)) return beside.string();
  return {};
}

}  // namespace wellspring::volume
