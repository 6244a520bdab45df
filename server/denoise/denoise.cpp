// SPDX-License-Identifier: Apache-2.0
#include "denoise/denoise.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <vector>

#include "base/load_error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "denoise/tile.h"

namespace wellspring::denoise {
namespace {

constexpr const char* net_names[] = {"small", "base", "large"};
// These were trained for guides without noise, which ours are: drawn, or means of many rays.
constexpr const char* net_files[] = {"rt_hdr_calb_cnrm_small.tza", "rt_hdr_calb_cnrm.tza",
                                     "rt_hdr_calb_cnrm_large.tza"};
constexpr float middle_grey = 0.18f, least_luminance = 1e-8f;
constexpr int block_side = 16;
constexpr int rows_at_once = 8;

uint16_t pack_share(float share) {
  return uint16_t((share > 0 ? std::min(share, 1.0f) : 0.0f) * 65535.0f + 0.5f);  // NaN becomes 0
}

float finite_luminance(vec3 color) {
  float l = luminance(color);
  return l > 0 ? std::min(l, std::numeric_limits<float>::max()) : 0.0f;
}

}  // namespace

std::optional<NetSize> find_net_size(std::string_view name) {
  for (size_t i = 0; i < std::size(net_names); i++)
    if (name == net_names[i]) return NetSize(i);
  return std::nullopt;
}
const char* net_name(NetSize size) { return net_names[size_t(size)]; }

float input_scale(int width, int height, std::span<const vec3> color) {
  auto count_of = [](int extent) { return std::max(1, (extent + block_side - 1) / block_side); };
  const int columns = count_of(width), rows = count_of(height);
  std::vector<double> logs(size_t(rows), 0.0);
  std::vector<int> lit(size_t(rows), 0);
  parallel_ranges(rows, 1, [&](int begin, int end) {
    for (int row = begin; row < end; row++)
      for (int column = 0; column < columns; column++) {
        auto edge = [](int i, int count, int extent) { return int(int64_t(i) * extent / count); };
        int left = edge(column, columns, width), right = edge(column + 1, columns, width);
        int top = edge(row, rows, height), bottom = edge(row + 1, rows, height);
        double sum = 0;
        for (int y = top; y < bottom; y++)
          for (int x = left; x < right; x++)
            sum += finite_luminance(color[size_t(y) * size_t(width) + size_t(x)]);
        double mean = sum / std::max(1.0, double(right - left) * double(bottom - top));
        if (!(mean > least_luminance)) continue;
        logs[size_t(row)] += std::log2(mean);
        lit[size_t(row)]++;
      }
  });
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < logs.size(); i++) sum += logs[i], count += lit[i];
  if (count == 0) return 1;
  return float(std::clamp(middle_grey / std::exp2(sum / count), 1e-30, 1e30));
}

Denoiser::Denoiser(const std::string& file) : net_(load_weights(file), file) {}

void Denoiser::start(const DenoiseInput& input) {
  const size_t width = size_t(input.width);
  scale_ = input.scale > 0 ? input.scale : input_scale(input.width, input.height, input.color);
  input_.resize(width * size_t(input.height) * input_channels);
  parallel_ranges(input.height, rows_at_once, [&](int begin, int end) {
    for (size_t i = size_t(begin) * width; i < size_t(end) * width; i++) {
      uint16_t* to = &input_[i * input_channels];
      const vec3 color = input.color[i] * scale_, normal = input.normal[i] * 0.5f + 0.5f;
      for (int c = 0; c < 3; c++) {
        to[c] = pack_share(encode_radiance(color[c]));
        to[3 + c] = pack_share(input.albedo[i][c]);
        to[6 + c] = pack_share(normal[c]);
      }
    }
  });
  net_.start(input.width, input.height, input_);
}

bool Denoiser::advance(double seconds, const std::atomic<bool>* stop) {
  return net_.advance(seconds, stop);
}

void Denoiser::finish(std::span<vec3> color) const {
  const RawVector<vec3>& encoded = net_.output();
  parallel_ranges(int(encoded.size()), 1 << 13, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      for (int c = 0; c < 3; c++)
        color[i][c] =
            std::min(decode_radiance(encoded[i][c]) / scale_, std::numeric_limits<float>::max());
  });
}

void Denoiser::run(const DenoiseInput& input, std::span<vec3> color) {
  start(input);
  while (advance(1)) {}
  finish(color);
}

size_t Denoiser::memory_bytes() const { return net_.memory_bytes() + bytes_of(input_); }

std::string weights_file(NetSize size, std::string folder) {
  if (folder.empty())
    if (const char* set = std::getenv("WELLSPRING_WEIGHTS")) folder = set;
  return folder.empty() ? std::string() : folder + "/" + net_files[size_t(size)];
}

std::unique_ptr<Denoiser> load_denoiser(NetSize size, std::string& problem,
                                        const std::string& folder) {
  problem.clear();
  if (const char* missing = unet_problem()) problem = missing;
  const std::string file = weights_file(size, folder);
  std::error_code error;
  if (problem.empty() && (file.empty() || !std::filesystem::exists(file, error)))
    problem = "the weights of the network \"" + std::string(net_name(size)) +
              "\" are not installed" + (file.empty() ? "" : " (" + file + ")");
  if (!problem.empty()) return nullptr;
  try {
    return std::make_unique<Denoiser>(file);
  } catch (const LoadError& wrong) {
    problem = wrong.what();
    return nullptr;
  }
}

}  // namespace wellspring::denoise
