// SPDX-License-Identifier: Apache-2.0
#include "scan/splats/splat_ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>

#include "scan/format/number_text.h"
#include "scan/format/ply_header.h"
#include "scan/splats/splat_finish.h"

namespace wellspring::scan {
namespace {

constexpr size_t splats_a_piece = 4096;

// How many f_rest there are, of all channels, and the degree that is read of them.
int find_degree(const InputFile& file, const PlyElement& element, size_t& rest, SplatSet& set) {
  rest = 0;
  while (element.has("f_rest_" + std::to_string(rest))) rest++;
  for (int degree = 0; degree <= 3; degree++)
    if (rest == 3 * size_t(splat_harmonics[degree])) return degree;
  if (rest == 72) {
    set.notices.push_back("harmonics of degree 4 are not read");
    return 3;
  }
  file.fail("element " + element.name,
            fmt::format("has {} numbers f_rest, which no degree has", rest));
}

// Reads the columns of a table piece by piece, text or binary.
class PlyTable {
 public:
  PlyTable(InputFile& file, const PlyHeader& header, const PlyElement& element)
      : file_(&file), header_(&header), element_(&element), lines_(file) {
    is_swapped_ = header.is_big != (std::endian::native == std::endian::big);
    lines_.count_from(header.lines);
    if (element.has_lists()) file.fail("element " + element.name, "has lists");
    for (const PlyElement& other : header.elements) {
      if (&other == &element) break;
      pass_element(file, header, other, lines_);
    }
  }

  // Gives every property's numbers of the next records.
  void read(size_t count, std::vector<std::vector<double>>& values) {
    const std::vector<PlyProperty>& properties = element_->properties;
    values.resize(properties.size());
    for (std::vector<double>& column : values) column.resize(count);
    if (header_->is_text) return read_text(count, values);
    const size_t record = element_->record_bytes();
    const char* from = file_->take(count * record).data();
    for (size_t k = 0; k < properties.size(); k++) {
      read_numbers(properties[k].kind, from, record, is_swapped_, count, values[k].data());
      from += bytes_of(properties[k].kind);
    }
  }

 private:
  void read_text(size_t count, std::vector<std::vector<double>>& values) {
    std::string_view line;
    for (size_t i = 0; i < count; i++) {
      if (!lines_.next(line)) file_->fail(lines_.where(), "is cut off");
      const char* at = line.data();
      const char* end = at + line.size();
      for (std::vector<double>& column : values)
        if (next_number(at, end, column[i]) != 1)
          file_->fail(lines_.where(), fmt::format("does not have {} numbers", values.size()));
    }
  }
  InputFile* file_;
  const PlyHeader* header_;
  const PlyElement* element_;
  InputLines lines_;
  bool is_swapped_ = false;
};

SplatSet read_trained(InputFile& file, const PlyHeader& header, const PlyElement& vertex) {
  SplatSet set;
  set.format = header.is_text ? "PLY, text" : "PLY";
  size_t rest = 0;
  set.degree = find_degree(file, vertex, rest, set);
  const auto column = [&](const std::string& name) {
    const size_t index = vertex.find(name);
    if (index == vertex.properties.size()) file.fail("element vertex", "has no " + name);
    return index;
  };
  const size_t x[] = {column("x"), column("y"), column("z")};
  const size_t color[] = {column("f_dc_0"), column("f_dc_1"), column("f_dc_2")};
  const size_t turn[] = {column("rot_0"), column("rot_1"), column("rot_2"), column("rot_3")};
  const size_t opacity = column("opacity");
  const bool is_flat = !vertex.has("scale_2");
  if (is_flat) set.notices.push_back("splats are flat: they have two scales");
  const size_t scale[] = {column("scale_0"), column("scale_1"),
                          column(is_flat ? "scale_1" : "scale_2")};
  const size_t first_rest = rest > 0 ? column("f_rest_0") : 0;
  for (size_t k = 0; k < rest; k++)
    if (column("f_rest_" + std::to_string(k)) != first_rest + k)
      file.fail("element vertex", "has numbers f_rest that do not follow one another");
  const size_t all = size_t(splat_harmonics[set.degree]);
  PlyTable table(file, header, vertex);
  std::vector<std::vector<double>> of;
  for (uint64_t done = 0; done < vertex.count;) {
    const size_t count = size_t(std::min<uint64_t>(splats_a_piece, vertex.count - done));
    table.read(count, of);
    resize_splats(set, size_t(done) + count);
    const auto three = [&of](const size_t(&columns)[3], size_t k) {
      return vec3(of[columns[0]][k], of[columns[1]][k], of[columns[2]][k]);
    };
    for (size_t k = 0; k < count; k++) {
      const size_t i = size_t(done) + k;
      set.place[i] = three(x, k);
      set.color[i] = color_of_harmonic(three(color, k));
      set.scale[i] = glm::exp(three(scale, k));
      if (is_flat) set.scale[i].z = 0;
      set.turn[i] = quat(float(of[turn[0]][k]), float(of[turn[1]][k]), float(of[turn[2]][k]),
                         float(of[turn[3]][k]));
      set.opacity[i] = sigmoid(float(of[opacity][k]));
      // All of red, then green, then blue.
      for (size_t h = 0; h < all; h++)
        for (size_t channel = 0; channel < 3; channel++)
          set.harmonics[i * all + h][int(channel)] =
              float(of[first_rest + channel * (rest / 3) + h][k]);
    }
    done += count;
  }
  return set;
}

float unit(uint32_t bits, int shift, int count) {
  const uint32_t mask = (1u << count) - 1;
  return float(bits >> shift & mask) / float(mask);
}

vec3 unpack_11_10_11(uint32_t bits) {
  return {unit(bits, 21, 11), unit(bits, 11, 10), unit(bits, 0, 11)};
}

// Two bits say which of w, x, y, z is the largest; the others have 10 bits each.
quat unpack_turn(uint32_t bits) {
  std::array<float, 4> wxyz{};
  const size_t largest = bits >> 30;
  float rest = 1;
  for (size_t i = 0, k = 0; i < 4; i++) {
    if (i == largest) continue;
    wxyz[i] = (unit(bits, 20 - 10 * int(k++), 10) - 0.5f) * 1.41421356f;
    rest -= wxyz[i] * wxyz[i];
  }
  wxyz[largest] = std::sqrt(std::max(rest, 0.0f));
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

SplatSet read_compressed(InputFile& file, const PlyHeader& header, const PlyElement& vertex) {
  SplatSet set;
  set.format = "PLY, compressed by PlayCanvas";
  const PlyElement& chunk = *header.find("chunk");
  const PlyElement* sh = header.find("sh");
  if (header.is_text || header.is_big) file.fail("format", "is not binary_little_endian");
  const uint64_t chunks = (vertex.count + 255) / 256;
  if (chunk.count != chunks)
    file.fail("element chunk", fmt::format("has {} chunks, not {}", chunk.count, chunks));
  if (sh && sh->count != vertex.count)
    file.fail("element sh", fmt::format("has {} items, not {}", sh->count, vertex.count));
  size_t rest = 0;
  if (sh) set.degree = find_degree(file, *sh, rest, set);
  const auto offset = [&file](const PlyElement& element, const std::string& name, NumberKind kind) {
    const size_t index = element.find(name);
    if (index == element.properties.size() || element.properties[index].kind != kind)
      file.fail("element " + element.name, "has no " + name + " of the right type");
    size_t bytes = 0;
    for (size_t i = 0; i < index; i++) bytes += bytes_of(element.properties[i].kind);
    return bytes;
  };
  // The least and the most of place, scale and colour; old files have no range of colours.
  const bool has_colors = chunk.has("min_r");
  std::vector<size_t> low, high;
  for (const char* name : {"x", "y", "z", "scale_x", "scale_y", "scale_z", "r", "g", "b"}) {
    if (low.size() >= 6 && !has_colors) break;
    low.push_back(offset(chunk, std::string("min_") + name, NumberKind::f32));
    high.push_back(offset(chunk, std::string("max_") + name, NumberKind::f32));
  }
  const size_t place = offset(vertex, "packed_position", NumberKind::u32);
  const size_t turn = offset(vertex, "packed_rotation", NumberKind::u32);
  const size_t scale = offset(vertex, "packed_scale", NumberKind::u32);
  const size_t color = offset(vertex, "packed_color", NumberKind::u32);
  for (size_t k = 0; k < rest; k++)
    if (offset(*sh, "f_rest_" + std::to_string(k), NumberKind::u8) != k)
      file.fail("element sh", "has other numbers than f_rest, or in another order");
  std::string tables[3];  // chunks, splats, harmonics
  InputLines lines(file);
  for (const PlyElement& element : header.elements) {
    const int which = &element == &chunk ? 0 : &element == &vertex ? 1 : &element == sh ? 2 : -1;
    if (which >= 0 && element.has_lists()) file.fail("element " + element.name, "has lists");
    if (which < 0) pass_element(file, header, element, lines);
    else tables[which] = std::string(file.take(element.count * element.record_bytes()));
  }
  resize_splats(set, size_t(vertex.count));
  const size_t all = size_t(splat_harmonics[set.degree]);
  for (size_t i = 0; i < set.size(); i++) {
    const char* range = tables[0].data() + i / 256 * chunk.record_bytes();
    const char* splat = tables[1].data() + i * vertex.record_bytes();
    const auto between = [&](size_t first, vec3 t) {
      const auto at = [&](const std::vector<size_t>& offsets) {
        return vec3(number_at<float>(range + offsets[first]),
                    number_at<float>(range + offsets[first + 1]),
                    number_at<float>(range + offsets[first + 2]));
      };
      return at(low) * (1.0f - t) + at(high) * t;
    };
    set.place[i] = between(0, unpack_11_10_11(number_at<uint32_t>(splat + place)));
    set.scale[i] = glm::exp(between(3, unpack_11_10_11(number_at<uint32_t>(splat + scale))));
    set.turn[i] = unpack_turn(number_at<uint32_t>(splat + turn));
    const uint32_t rgba = number_at<uint32_t>(splat + color);
    const vec3 rgb(unit(rgba, 24, 8), unit(rgba, 16, 8), unit(rgba, 8, 8));
    set.color[i] = has_colors ? between(6, rgb) : rgb;
    set.opacity[i] = unit(rgba, 0, 8);
    for (size_t h = 0; h < all; h++)
      for (size_t channel = 0; channel < 3; channel++) {
        const size_t k = channel * (rest / 3) + h;
        const uint8_t code = uint8_t(tables[2][i * sh->record_bytes() + k]);
        // Codes are the middles of 256 steps from -4 to 4; the first and the last are the ends.
        const float t = code == 0 ? 0 : code == 255 ? 1 : (float(code) + 0.5f) / 256;
        set.harmonics[i * all + h][int(channel)] = (t - 0.5f) * 8;
      }
  }
  return set;
}

}  // namespace

SplatSet read_splat_ply(const std::string& path) {
  InputFile file(path);
  const PlyHeader header = read_ply_header(file);
  if (!has_splats(header)) file.fail("element vertex", "holds no Gaussian splats");
  const PlyElement& vertex = *header.find("vertex");
  return vertex.has("packed_position") ? read_compressed(file, header, vertex)
                                       : read_trained(file, header, vertex);
}

}  // namespace wellspring::scan
