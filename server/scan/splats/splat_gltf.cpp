// SPDX-License-Identifier: Apache-2.0
#include "scan/splats/splat_gltf.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "gltf/animation.h"
#include "gltf/data.h"
#include "gltf/primitive.h"
#include "scan/splats/spz.h"
#include "scan/splats/splat_finish.h"

namespace wellspring::scan {
namespace {

constexpr const char* base = "KHR_gaussian_splatting";
constexpr const char* packed = "KHR_gaussian_splatting_compression_spz_2";

// Reads a required attribute's numbers, so many a splat.
std::vector<float> numbers_of(File& file, const gltf::json& attributes, const std::string& name,
                              int components, size_t count, const std::string& where) {
  const gltf::json* accessor = find(attributes, name.c_str());
  if (!accessor) refuse(file, where + "/attributes", "has no " + name);
  const Form form = form_of(file, accessor->get<size_t>());
  if (form.components != components || size_t(form.count) != count)
    refuse(file, at(where + "/attributes", name),
           fmt::format("is {} times {}, not {} times {} numbers", form.count, form.components,
                       count, components));
  return *read_floats(file, accessor->get<size_t>());
}

vec3 three(const std::vector<float>& numbers, size_t i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

// Encodes linear light as sRGB, beyond 0 to 1 along the curve's ends; and how steep it is there.
std::pair<float, float> encode(float linear) {
  if (linear <= 0.0031308f) return {12.92f * linear, 12.92f};
  return {1.055f * std::pow(linear, 1 / 2.4f) - 0.055f,
          1.055f / 2.4f * std::pow(linear, 1 / 2.4f - 1)};
}

class SplatGltf {
 public:
  explicit SplatGltf(const std::string& path)
      : file_(load_gltf(path, folder_of(path), {base, packed})) {}

  SplatSet read() {
    const std::vector<Node> nodes = make_pose(file_, 0);
    for (size_t i = 0; i < nodes.size(); i++) {
      const gltf::json* mesh = find(items(file_.root, "nodes")[i], "mesh");
      if (!mesh || !nodes[i].shown) continue;
      const size_t index = mesh->get<size_t>();
      const gltf::json& primitives = items(items(file_.root, "meshes")[index], "primitives");
      for (size_t p = 0; p < primitives.size(); p++) {
        const gltf::json* splats = extension(primitives[p], base);
        if (!splats) continue;
        const std::string where = at(at("/meshes", index) + "/primitives", p);
        SplatSet set = read_primitive(primitives[p], *splats, where);
        for (const dmat4& copy : read_instances(file_, i))
          add(set, nodes[i].global * copy, at("/nodes", i));
      }
    }
    if (!has_any_) refuse(file_, "/meshes", "shows no Gaussian splats");
    return std::move(all_);
  }

 private:
  static std::string folder_of(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
  }

  SplatSet read_primitive(const gltf::json& primitive, const gltf::json& splats,
                          const std::string& where) {
    has_any_ = true;
    const std::string inside = where + "/extensions/" + base;
    if (integer(primitive, "mode", 4) != 0) refuse(file_, where + "/mode", "is not 0, of points");
    check_primitive(file_, primitive, where);
    if (const gltf::json* spz = extension(splats, packed)) {
      const gltf::json* view = find(*spz, "bufferView");
      const size_t views = items(file_.root, "bufferViews").size();
      if (!view || !view->is_number_unsigned() || view->get<size_t>() >= views)
        refuse(file_, inside + "/extensions/" + packed, "has no bufferView");
      const auto bytes = view_bytes(file_, view->get<size_t>());
      SplatSet set = read_spz(file_.path, at("/bufferViews", view->get<size_t>()),
                              {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      // SPZ is packed as right, up, back; glTF is left, up, front.
      move_splats(set, mat3(-1, 0, 0, 0, 1, 0, 0, 0, -1), 1, vec3(0));
      set.format = "glTF, " + set.format;
      return set;
    }
    const gltf::json& attributes = primitive["attributes"];
    const gltf::json* position = find(attributes, "POSITION");
    if (!position) refuse(file_, where + "/attributes", "has no POSITION");
    const size_t count = size_t(form_of(file_, position->get<size_t>()).count);
    if (int64_t(count) > vertices_limit)
      refuse_beyond(file_, where, vertices_limit, "splats", "cut it into several files");
    const bool is_draft = find(attributes, "_ROTATION") && find(attributes, "_SCALE");
    SplatSet set;
    set.format = is_draft ? "glTF, early draft of KHR_gaussian_splatting" : "glTF";
    if (is_draft)
      set.notices.push_back(
          "is of an early draft of KHR_gaussian_splatting: COLOR_0 has colour and "
          "opacity, and there are no harmonics");
    else set.degree = find_degree(attributes);
    resize_splats(set, count);
    const std::string prefix = is_draft ? "_" : std::string(base) + ":";
    const auto places = numbers_of(file_, attributes, "POSITION", 3, count, where);
    const auto turns = numbers_of(file_, attributes, prefix + "ROTATION", 4, count, where);
    const auto scales = numbers_of(file_, attributes, prefix + "SCALE", 3, count, where);
    for (size_t i = 0; i < count; i++) {
      set.place[i] = three(places, i);
      set.scale[i] = three(scales, i);
      set.turn[i] = quat(turns[4 * i + 3], turns[4 * i], turns[4 * i + 1], turns[4 * i + 2]);
    }
    // A draft had the logarithms of scales. A file with a negative one can be nothing else.
    if (std::ranges::any_of(scales, [](float one) { return one < 0; })) {
      set.notices.push_back("has negative scales, so all are taken as logarithms");
      for (vec3& scale : set.scale) scale = glm::exp(scale);
    }
    if (is_draft) read_draft_colors(set, attributes, where);
    else read_colors(set, attributes, text(splats, "colorSpace"), where);
    return set;
  }

  static std::string harmonic(int degree, int number) {
    return fmt::format("{}:SH_DEGREE_{}_COEF_{}", base, degree, number);
  }

  static int find_degree(const gltf::json& attributes) {
    int degree = 0;
    while (degree < 3 && find(attributes, harmonic(degree + 1, 0).c_str())) degree++;
    return degree;
  }

  void read_draft_colors(SplatSet& set, const gltf::json& attributes, const std::string& where) {
    const auto colors = numbers_of(file_, attributes, "COLOR_0", 4, set.size(), where);
    for (size_t i = 0; i < set.size(); i++) {
      set.color[i] = {colors[4 * i], colors[4 * i + 1], colors[4 * i + 2]};
      set.opacity[i] = colors[4 * i + 3];
    }
  }

  void read_colors(SplatSet& set, const gltf::json& attributes, const std::string& space,
                   const std::string& where) {
    const size_t count = set.size(), all = size_t(splat_harmonics[set.degree]);
    set.opacity = numbers_of(file_, attributes, std::string(base) + ":OPACITY", 1, count, where);
    const auto constant = numbers_of(file_, attributes, harmonic(0, 0), 3, count, where);
    for (size_t i = 0; i < count; i++) set.color[i] = color_of_harmonic(three(constant, i));
    size_t at_harmonic = 0;
    for (int degree = 1; degree <= set.degree; degree++)
      for (int k = 0; k < 2 * degree + 1; k++, at_harmonic++) {
        const auto numbers = numbers_of(file_, attributes, harmonic(degree, k), 3, count, where);
        for (size_t i = 0; i < count; i++) set.harmonics[i * all + at_harmonic] = three(numbers, i);
      }
    if (space == "lin_rec709_display") {
      // Encoding is no sum: harmonics follow it to first order about the constant colour.
      set.notices.push_back("has linear colours, which are encoded as sRGB");
      for (size_t i = 0; i < count; i++)
        for (int channel = 0; channel < 3; channel++) {
          const auto [code, slope] = encode(set.color[i][channel]);
          set.color[i][channel] = code;
          for (size_t h = 0; h < all; h++) set.harmonics[i * all + h][channel] *= slope;
        }
    } else if (space != "srgb_rec709_display" && !space.empty()) {
      refuse(file_, where + "/extensions/" + base + "/colorSpace",
             fmt::format("'{}' is not read", space.substr(0, 60)));
    }
  }

  // Adds splats where a node has them: it may turn, mirror and scale all axes alike.
  void add(SplatSet set, const dmat4& global, const std::string& where) {
    const glm::dmat3 axes(global);
    const double size = std::cbrt(std::abs(glm::determinant(axes)));
    const glm::dmat3 turn = axes / size;
    const glm::dmat3 rest = glm::transpose(turn) * turn - glm::dmat3(1);
    double skew = 0;
    for (int i = 0; i < 9; i++) skew = std::max(skew, std::abs(rest[i / 3][i % 3]));
    if (!(size > 1e-12) || !(skew < 1e-3))
      refuse(file_, where, "scales its splats unevenly, which is not read");
    const bool is_still = global == dmat4(1);
    if (!is_still) move_splats(set, mat3(turn), float(size), vec3(global[3]));
    if (all_.format.empty()) {
      all_ = std::move(set);
      return;
    }
    if (set.degree != all_.degree) refuse(file_, where, "has harmonics of another degree");
    if ((file_.vertices_made += int64_t(set.size())) > vertices_limit)
      refuse_beyond(file_, where, vertices_limit, "splats in all", "cut it into several files");
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(all_.place, set.place), append(all_.scale, set.scale), append(all_.turn, set.turn);
    append(all_.opacity, set.opacity), append(all_.color, set.color);
    append(all_.harmonics, set.harmonics);
  }

  File file_;
  SplatSet all_;
  bool has_any_ = false;
};

}  // namespace

SplatSet read_splat_gltf(const std::string& path) { return SplatGltf(path).read(); }

}  // namespace wellspring::scan
