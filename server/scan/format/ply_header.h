// SPDX-License-Identifier: Apache-2.0
// The head of a PLY file (Turk, "The PLY Polygon File Format"): elements, each with properties.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scan/format/input_file.h"

namespace wellspring::scan {

// Numbers as PLY and PCD files have them.
enum class NumberKind : uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };
size_t bytes_of(NumberKind kind);
inline bool is_real(NumberKind kind) { return kind >= NumberKind::f32; }
// Reads one number.
double read_number(NumberKind kind, const char* from, bool is_swapped);
// Reads `count` numbers that lie `stride` bytes apart.
void read_numbers(NumberKind kind, const char* from, size_t stride, bool is_swapped, size_t count,
                  double* to);

struct PlyProperty {
  std::string name;
  NumberKind kind = NumberKind::f32;
  bool is_list = false;
  NumberKind count_kind = NumberKind::u8;  // a list's length is of this kind
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
  bool has_lists() const;
  size_t record_bytes() const;  // without lists
  // Returns a property's index; the number of properties: there is none of this name.
  size_t find(std::string_view property) const;
  bool has(std::string_view property) const { return find(property) < properties.size(); }
};

struct PlyHeader {
  bool is_text = false, is_big = false;  // big: the highest byte is first
  std::vector<PlyElement> elements;
  uint64_t lines = 0;  // the head has so many
  const PlyElement* find(std::string_view element) const;
};

// Says whether a file begins as PLY does.
bool is_ply(InputFile& file);
// Reads the head; the file is at the first element then. Throws LoadError for what is no PLY, and
// for elements that need more bytes than the file has.
PlyHeader read_ply_header(InputFile& file);
// Passes an element's data. Throws LoadError if the file ends before.
void pass_element(InputFile& file, const PlyHeader& header, const PlyElement& element,
                  InputLines& lines);
// Passes a list in binary data.
void pass_list(InputFile& file, const PlyProperty& list, bool is_swapped);

// Says whether the vertices are Gaussian splats, as training or PlayCanvas writes them.
bool has_splats(const PlyHeader& header);

}  // namespace wellspring::scan
