// SPDX-License-Identifier: Apache-2.0
#include "cache_visit_truth.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/rng.h"
#include "frame/picture_file.h"

namespace wellspring::test {
namespace {

constexpr int probe_width = 48, probe_height = 27, probe_spp = 4;

struct Hash {
  uint64_t value = 0x57656c6c73707269ull;
  void add(uint64_t word) { value = mix64(value ^ word); }
  void add(float number) { add(uint64_t(std::bit_cast<uint32_t>(number))); }
  void add(vec3 v) { add(v.x), add(v.y), add(v.z); }
};

StillSettings half_settings(const TruthSettings& settings, int half) {
  StillSettings still;
  still.spp = settings.spp;
  still.seed = 0x7472757468 + uint64_t(half);
  still.transport.max_depth = settings.max_depth;
  return still;
}

uint64_t key_of(const World& world, const Lights& lights, const View& view,
                const TruthSettings& settings) {
  Hash hash;
  hash.add(settings.content);
  hash.add(uint64_t(settings.spp));
  hash.add(uint64_t(settings.max_depth));
  for (vec3 v : {view.position, view.right, view.up, view.forward}) hash.add(v);
  hash.add(view.tan_half_fov);
  hash.add(view.middle.x), hash.add(view.middle.y);
  hash.add(uint64_t(view.width) << 32 | uint64_t(view.height));
  View probe = view;
  probe.width = probe_width;
  probe.height = probe_height;
  StillSettings still = half_settings(settings, 0);
  still.spp = probe_spp;
  Frame frame = render_still(*find_technique("path"), world, lights, probe, still);
  for (vec3 color : frame.color) hash.add(color);
  return hash.value;
}

}  // namespace

Truth find_truth(const World& world, const Lights& lights, const View& view,
                 const TruthSettings& settings) {
  Truth truth;
  char name[32];
  std::snprintf(name, sizeof name, "%016llx",
                (unsigned long long)key_of(world, lights, view, settings));
  std::filesystem::create_directories(settings.folder);
  truth.kept = true;
  for (int half = 0; half < 2; half++) {
    std::string file = settings.folder + "/" + name + (half ? "b.pfm" : "a.pfm");
    if (std::filesystem::exists(file)) {
      truth.half[half] = load_linear_picture(file);
    } else {
      truth.kept = false;
      truth.half[half] =
          render_still(*find_technique("path"), world, lights, view, half_settings(settings, half));
      save_picture(file, truth.half[half], {});
    }
  }
  truth.picture.width = view.width;
  truth.picture.height = view.height;
  truth.picture.color.resize(truth.half[0].color.size());
  for (size_t i = 0; i < truth.picture.color.size(); i++)
    truth.picture.color[i] = 0.5f * (truth.half[0].color[i] + truth.half[1].color[i]);
  return truth;
}

uint64_t hash_files(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  Hash hash;
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    for (char c : std::filesystem::relative(file, folder).string()) hash.add(uint64_t(uint8_t(c)));
    hash.add(uint64_t(bytes.size()));
    for (size_t i = 0; i < bytes.size(); i += 8) {
      uint64_t word = 0;
      std::copy_n(bytes.data() + i, std::min<size_t>(8, bytes.size() - i),
                  reinterpret_cast<char*>(&word));
      hash.add(word);
    }
  }
  return hash.value;
}

}  // namespace wellspring::test
