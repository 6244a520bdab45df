// SPDX-License-Identifier: Apache-2.0
#include "scan/format/ply.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

#include "scan/format/column_source.h"
#include "scan/format/number_text.h"
#include "scan/format/ply_header.h"

namespace wellspring::scan {
namespace {

class PlySource : public ColumnSource {
 public:
  explicit PlySource(const std::string& path)
      : file_(path), header_(read_ply_header(file_)), lines_(file_) {
    info_.file = path;
    info_.format = header_.is_text  ? "PLY, text"
                   : header_.is_big ? "PLY, binary, highest byte first"
                                    : "PLY, binary";
    if (has_splats(header_))
      file_.fail("element vertex", "holds Gaussian splats, which are no points");
    const PlyElement* vertex = header_.find("vertex");
    if (!vertex) file_.fail("", "has no element vertex");
    vertex_ = *vertex;
    choose_columns();
    lines_.count_from(header_.lines);
    for (const PlyElement& element : header_.elements) {
      if (&element == vertex) break;
      pass_element(file_, header_, element, lines_);
    }
    is_swapped_ = header_.is_big != (std::endian::native == std::endian::big);
    info_.points = vertex_.count;
    info_.is_counted = true;
    begin();
  }

 private:
  void choose_columns() {
    size_t offset = 0;
    for (const PlyProperty& property : vertex_.properties) {
      Role role = property.is_list ? Role::none : role_named(property.name);
      for (const Column& column : columns_)
        if (column.role == role) role = Role::none;
      columns_.push_back({role, property.kind, offset});
      if (!property.is_list) offset += bytes_of(property.kind);
    }
    for (const Role role : {Role::x, Role::y, Role::z})
      if (!has(role)) file_.fail("element vertex", "has no x, y, z");
    // Parts of a colour or a normal are none.
    for (const Role first : {Role::red, Role::normal_x}) {
      const Role all[] = {first, Role(int(first) + 1), Role(int(first) + 2)};
      if (has(all[0]) && has(all[1]) && has(all[2])) continue;
      for (Column& column : columns_)
        if (std::ranges::find(all, column.role) != std::end(all)) column.role = Role::none;
    }
    for (const Column& column : columns_) {
      if (column.role == Role::red) {
        colors_are_real_ = is_real(column.kind);
        if (bytes_of(column.kind) == 1) color_range_ = {0, 255};
      }
      if (column.role == Role::intensity && column.kind == NumberKind::u8)
        intensity_range_ = {0, 255};
    }
  }
  bool has(Role role) const {
    return std::ranges::any_of(columns_,
                               [role](const Column& column) { return column.role == role; });
  }

  void read_columns(PointColumns& columns, size_t most) override {
    const size_t count = size_t(std::min<uint64_t>(most, vertex_.count - done_));
    columns.count = count;
    for (const Column& column : columns_)
      if (column.role != Role::none) columns[column.role].resize(count);
    if (header_.is_text) read_text(columns);
    else if (vertex_.has_lists()) read_records(columns);
    else read_table(columns);
    done_ += count;
  }

  void read_table(PointColumns& columns) {
    const size_t record = vertex_.record_bytes();
    const std::string_view bytes = file_.take(columns.count * record);
    for (const Column& column : columns_)
      if (column.role != Role::none)
        read_numbers(column.kind, bytes.data() + column.offset, record, is_swapped_, columns.count,
                     columns[column.role].data());
  }

  void read_records(PointColumns& columns) {
    for (size_t i = 0; i < columns.count; i++)
      for (size_t k = 0; k < columns_.size(); k++) {
        const PlyProperty& property = vertex_.properties[k];
        if (property.is_list) {
          pass_list(file_, property, is_swapped_);
          continue;
        }
        const char* from = file_.take(bytes_of(property.kind)).data();
        if (columns_[k].role != Role::none)
          columns[columns_[k].role][i] = read_number(property.kind, from, is_swapped_);
      }
  }

  void read_text(PointColumns& columns) {
    std::string_view line;
    for (size_t i = 0; i < columns.count; i++) {
      do {
        if (!lines_.next(line))
          file_.fail(lines_.where(), fmt::format("is cut off: {} vertices of {} are there",
                                                 done_ + i, vertex_.count));
      } while (line.find_first_not_of(" \t") == std::string_view::npos);
      read_line(line, columns, i);
    }
  }

  void read_line(std::string_view line, PointColumns& columns, size_t i) {
    const char* at = line.data();
    const char* end = at + line.size();
    const auto number = [&] {
      double value = 0;
      const int found = next_number(at, end, value);
      if (found < 0) file_.fail(lines_.where(), fmt::format("'{}' is no number", word_at(at, end)));
      if (found == 0)
        file_.fail(lines_.where(), fmt::format("has fewer numbers than a vertex has properties, {}",
                                               vertex_.properties.size()));
      return value;
    };
    for (size_t k = 0; k < columns_.size(); k++) {
      const double value = number();
      if (vertex_.properties[k].is_list) {
        if (!(value >= 0 && value <= double(line.size())))
          file_.fail(lines_.where(), "a list's length is out of range");
        for (size_t left = size_t(value); left > 0; left--) number();
      } else if (columns_[k].role != Role::none) {
        columns[columns_[k].role][i] = value;
      }
    }
  }

  // A property is read as `role`; it stands `offset` bytes behind a record's begin.
  struct Column {
    Role role = Role::none;
    NumberKind kind = NumberKind::f32;
    size_t offset = 0;
  };
  InputFile file_;
  PlyHeader header_;
  InputLines lines_;
  PlyElement vertex_;
  std::vector<Column> columns_;
  bool is_swapped_ = false;
  uint64_t done_ = 0;
};

}  // namespace

std::unique_ptr<PointSource> open_ply(const std::string& path) {
  return std::make_unique<PlySource>(path);
}

}  // namespace wellspring::scan
