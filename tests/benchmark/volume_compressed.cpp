// SPDX-License-Identifier: Apache-2.0
// volume.compressed: residual vector quantisation of a coloured volume. How much does it lose at
// 0.75 bit a voxel, beside what zstd makes of the same bricks without loss; how long does it take;
// how quickly is it decoded, from its file; how many bricks need not be?
#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <vector>
#include <zstd.h>

#include "base/clock.h"
#include "base/rng.h"
#include "made_anatomy.h"
#include "own_folder.h"
#include "report.h"
#include "reports.h"
#include "volume/compressed/compress.h"
#include "volume/compressed/compressed_file.h"
#include "volume/compressed/decode.h"
#include "volume/compressed/coding_loss.h"
#include "volume/compressed/fetch.h"
#include "volume/compressed/opacity.h"

namespace wellspring::test {
namespace {

constexpr float camera_noise = 3;  // display codes
constexpr int zstd_level = 3;

std::vector<glm::ivec3> bricks_in_random_order(glm::ivec3 size) {
  const glm::ivec3 bricks = size / brick_side;  // whole ones
  std::vector<glm::ivec3> all;
  for (int z = 0; z < bricks.z; z++)
    for (int y = 0; y < bricks.y; y++)
      for (int x = 0; x < bricks.x; x++) all.emplace_back(x, y, z);
  Rng random(5);
  for (size_t i = all.size(); i > 1; i--) std::swap(all[i - 1], all[random.next() % i]);
  return all;
}

// Returns the bits a voxel of bricks that zstd compresses, each alone.
double zstd_bits(const Volume& volume, const std::vector<glm::ivec3>& bricks) {
  constexpr size_t row = brick_side * 3, whole = row * brick_side * brick_side;
  std::vector<std::byte> brick(whole), packed(ZSTD_compressBound(whole));
  size_t bytes = 0;
  for (const glm::ivec3 at : bricks) {
    std::byte* to = brick.data();
    for (int z = 0; z < brick_side; z++)
      for (int y = 0; y < brick_side; y++, to += row) {
        const glm::ivec3 from = at * brick_side + glm::ivec3(0, y, z);
        const size_t index =
            (size_t(from.z) * size_t(volume.size.y) + size_t(from.y)) * size_t(volume.size.x) +
            size_t(from.x);
        std::copy_n(volume.bytes.get() + 3 * index, row, to);
      }
    const size_t size =
        ZSTD_compress(packed.data(), packed.size(), brick.data(), whole, zstd_level);
    if (ZSTD_isError(size)) throw std::runtime_error("zstd compresses no brick");
    bytes += size;
  }
  return 8 * double(bytes) / (double(bricks.size()) * brick_side * brick_side * brick_side);
}

// Returns voxels a second of this thread's processor time.
double decode_rate(const CompressedVolume& volume, const std::vector<glm::ivec3>& bricks,
                   int detail, double seconds) {
  std::vector<uint8_t> samples;
  double voxels = 0;
  const double began = thread_seconds_now();
  for (size_t i = 0; thread_seconds_now() - began < seconds; i = (i + 1) % bricks.size()) {
    const Box box = brick_box(bricks[i], detail, 0);
    const size_t count = size_t(box.size.x) * size_t(box.size.y) * size_t(box.size.z);
    samples.resize(3 * count);
    decode(std::span<uint8_t>(samples), volume, detail, box);
    voxels += double(count);
  }
  return voxels / (thread_seconds_now() - began);
}

double fetch_rate(const CompressedVolume& volume, double seconds) {
  Rng random(6);
  const glm::vec3 extent(volume.size);
  double count = 0;
  glm::vec3 sum(0);
  const double began = thread_seconds_now();
  while (thread_seconds_now() - began < seconds) {
    // A ray's steps of half a voxel.
    glm::vec3 at = glm::vec3(random.uniform(), random.uniform(), random.uniform()) * extent;
    for (int i = 0; i < 256; i++, at.x += 0.5f) sum += fetch_between(volume, at);
    count += 256;
  }
  if (!(sum.x + sum.y + sum.z >= 0)) throw std::runtime_error("colours are no numbers");
  return count / (thread_seconds_now() - began);
}

// Bones alone are seen, and all else is clear.
OpacityTable bones_alone() {
  return {32, [](glm::vec3 color) {
            return glm::distance(color, glm::vec3(232, 222, 198)) < 30 ? 0.8f : 0.f;
          }};
}

// Returns the part of the volume that is seen: the rest might be culled.
double seen_share(const CompressedVolume& volume) {
  const OpacityTable bones = bones_alone();
  Rng random(9);
  constexpr int looks = 100000;
  int seen = 0;
  for (int i = 0; i < looks; i++) {
    const glm::vec3 at(random.uniform(), random.uniform(), random.uniform());
    seen += bones.trilinear(fetch_between(volume, at * glm::vec3(volume.size - 1))) >= 1 / 256.f;
  }
  return double(seen) / looks;
}

// Returns the part of the bricks that need not be decoded.
double culled_share(const CompressedVolume& volume, const std::vector<glm::ivec3>& bricks) {
  const OpacityTable bones = bones_alone();
  const auto culled = std::ranges::count_if(
      bricks, [&](glm::ivec3 brick) { return opacity_bound(volume, bones, brick) < 1 / 256.f; });
  return double(culled) / double(bricks.size());
}

}  // namespace

void bench_volume_compressed(BenchReport& report, const BenchOptions& options) {
  const glm::ivec3 size(options.quick ? 192 : 504);
  const Volume volume = made_anatomy(size, camera_noise, 1);
  const double voxels = double(volume.samples());
  CompressionSettings settings;
  settings.codevectors = options.quick ? 256 : 4096;
  settings.least_training_blocks = 1;  // a twentieth, whatever that is
  const std::vector<glm::ivec3> bricks = bricks_in_random_order(size);

  double trained = 0;
  const double began = seconds_now();
  const CompressedVolume made = compress_volume(volume, settings, [&](double part) {
    if (part <= 0.4) trained = seconds_now();
  });
  const double took = seconds_now() - began;
  const OwnFolder folder;
  const std::string file = folder.path() + "/volume.rvq";
  write_compressed(file, made);
  const CompressedVolume compressed = read_compressed(file);
  const CodingLoss deviation = compare_compressed(volume, compressed);

  const auto name = [&](const char* technique) {
    return nlohmann::json{{"technique", technique},
                          {"size", std::to_string(size.x) + "^3"},
                          {"codevectors", settings.codevectors}};
  };
  report.add("volume.compressed.bits_a_voxel", 24, "bit", name("raw"));
  report.add("volume.compressed.bits_a_voxel", zstd_bits(volume, bricks), "bit", name("zstd"));
  report.add("volume.compressed.bits_a_voxel", deviation.bits_a_voxel, "bit", name("rvq"));
  report.add("volume.compressed.code_bits_a_voxel",
             8 * double(code_bytes(size, settings.levels, compressed.codevectors)) / voxels, "bit",
             name("rvq"));
  report.add("volume.compressed.decibel", deviation.decibel, "dB", name("rvq"));
  report.add("volume.compressed.background",
             double(deviation.background) / double(deviation.background + deviation.foreground), "",
             name("rvq"));
  report.add("volume.compressed.train_s", trained - began, "s", name("rvq"));
  report.add("volume.compressed.encode_rate", voxels / took / 1e6, "Mvoxel/s", name("rvq"));
  const double seconds = options.quick ? 0.5 : 3;
  for (int detail = 0; detail < details; detail++) {
    nlohmann::json where = name("rvq");
    where["detail"] = std::to_string(1 << detail) + ":1";
    report.add("volume.compressed.decode_rate",
               decode_rate(compressed, bricks, detail, seconds) / 1e9, "Gvoxel/s", where);
  }
  report.add("volume.compressed.seen", seen_share(compressed), "", name("rvq"));
  report.add("volume.compressed.culled", culled_share(compressed, bricks), "", name("rvq"));
  report.add("volume.compressed.fetch_rate", fetch_rate(compressed, seconds) / 1e6, "M/s",
             name("rvq"));
}

ReportPage volume_compressed_page() {
  return {"volume.compressed",
          "What does residual vector quantisation make of a coloured volume (four levels, blocks "
          "of 4x4x4), and how quickly is it decoded?",
          {"A made body of tissues, bones and vessels on black, with noise of 3 display codes as a "
           "camera's. Codebooks are trained on a twentieth of the blocks; bits count the whole "
           "file. Blocks of black count as voxels, but not in dB. zstd: bricks of 32^3, level 3, "
           "without loss.",
           "Encoding: wall time of all cores, training too. Decoding and fetching: one core's "
           "processor time; bricks of 32^3 of the mapped file in random order; fetch: trilinear, "
           "along rays of half "
           "voxels. Culled: if bones alone are seen. Wanted: 32 dB at 0.75 bit, 2 Gvoxel/s."},
          {{.caption = "Size and loss",
            .rows = {{"technique", "technique"}, {"size", "voxels"}},
            .columns = {{"volume.compressed.bits_a_voxel", "a voxel", 1, "bit"},
                        {"volume.compressed.code_bits_a_voxel", "codes alone", 1, "bit"},
                        {"volume.compressed.decibel", "signal to noise"},
                        {"volume.compressed.background", "background"},
                        {"volume.compressed.train_s", "training"},
                        {"volume.compressed.encode_rate", "encoding"},
                        {"volume.compressed.fetch_rate", "fetching"},
                        {"volume.compressed.seen", "voxels seen"},
                        {"volume.compressed.culled", "bricks culled"}},
            .most_rows = 3},
           {.caption = "Decoding",
            .rows = {{"detail", "detail"}},
            .columns = {{"volume.compressed.decode_rate", "voxels out"}},
            .only = {{"detail", {"1:1", "2:1", "4:1"}}},
            .most_rows = 3}}};
}

}  // namespace wellspring::test
