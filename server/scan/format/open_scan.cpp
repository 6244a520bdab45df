// SPDX-License-Identifier: Apache-2.0
#include "scan/format/open_scan.h"

#include <filesystem>
#include <string_view>

#include "base/load_error.h"
#include "scan/format/e57.h"
#include "scan/format/gltf_points.h"
#include "scan/format/input_file.h"
#include "scan/format/pcd.h"
#include "scan/format/ply.h"
#include "scan/format/text.h"
#include "scan/las/ept.h"
#include "scan/las/las_source.h"

namespace wellspring::scan {
namespace {

using Bytes = std::string_view;

bool is_named(Bytes path, std::initializer_list<const char*> ends) {
  std::string small;
  for (const char letter : path.substr(path.size() - std::min<size_t>(path.size(), 12)))
    small += letter >= 'A' && letter <= 'Z' ? char(letter - 'A' + 'a') : letter;
  for (const char* end : ends)
    if (small.ends_with(end)) return true;
  return false;
}

bool is_las(Bytes head, Bytes) { return head.starts_with("LASF"); }
bool is_e57(Bytes head, Bytes) { return head.starts_with("ASTM-E57"); }
bool is_ply_text(Bytes head, Bytes) {
  return head.starts_with("ply\n") || head.starts_with("ply\r") || head.starts_with("ply ");
}
bool is_pcd_text(Bytes head, Bytes) { return is_pcd(head); }
bool is_gltf(Bytes head, Bytes path) {
  return head.starts_with("glTF") || (is_named(path, {".gltf"}) && may_be_text(head));
}
bool is_splats(Bytes head, Bytes path) {
  return head.starts_with("NGSP") || is_named(path, {".spz", ".splat", ".ksplat", ".sog"});
}
bool is_text(Bytes head, Bytes) { return may_be_text(head); }

std::unique_ptr<PointSource> refuse_splats(const std::string& path) {
  throw LoadError(path, "", "holds Gaussian splats, which are no points");
}

// The first row that knows the file opens it.
struct Format {
  bool (*is_it)(Bytes head, Bytes path);
  std::unique_ptr<PointSource> (*open)(const std::string& path);
};
constexpr Format formats[] = {
    {is_las, open_las},      {is_e57, open_e57},          {is_ply_text, open_ply},
    {is_pcd_text, open_pcd}, {is_gltf, open_gltf_points}, {is_splats, refuse_splats},
    {is_text, open_text},
};

}  // namespace

std::unique_ptr<PointSource> open_scan(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error) ||
      std::filesystem::path(path).filename() == "ept.json")
    return open_ept(path);
  std::string head;
  {
    InputFile file(path);
    head = std::string(file.peek(4096).substr(0, 4096));
  }
  if (head.empty()) throw LoadError(path, "", "is empty");
  for (const Format& format : formats)
    if (format.is_it(head, path)) return format.open(path);
  throw LoadError(path, "byte 0",
                  "is of no format of points that is read: LAS, LAZ, COPC, E57, PLY, PCD, XYZ, "
                  "PTS, TXT, CSV, glTF");
}

}  // namespace wellspring::scan
