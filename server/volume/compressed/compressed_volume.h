// SPDX-License-Identifier: Apache-2.0
// A volume as indices into codebooks: residual vector quantisation (Parys, Knittel, "Giga-Voxel
// Rendering from Compressed Data on a Display Wall", section 3.1). A block of 4x4x4 voxels is the
// sum of one codevector of each level, whose indices lie side by side: a code of fixed length.
//
// The file, little-endian, without gaps:
//   header, 248 bytes: magic "WSRVQ\r\n\x1a"; uint32 version (1), channels (1 or 3), kind (0:
//   uint8,
//     1: uint16, 2: int16); int32 size x, y, z; uint32 levels, codevectors a level;
//     double slope, intercept, to_metres[16] (column by column); for each of 8 levels int32
//     fraction and offset
//   codes: blocks x fastest, then y, then z; all bits in one row, least significant first; a code
//     is the index of level 0 in its lowest bits, then those of further levels, each of
//     ceil(log2 codevectors) bits; the last byte is filled up
//   codebooks, a level after the other, a codevector after the other, voxels x fastest:
//     colours: uint32 words of 11-11-10 bit, see rgb_word.h
//     grey: int16, which mean (int16 + offset) / 2^fraction of their level
//   ranges of bricks of 32^3 voxels, x fastest: the least of each channel, then the greatest, of
//     the sample's kind, over the brick and the blocks that touch it
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "base/layers.h"
#include "volume/volume.h"

namespace wellspring::volume {

inline constexpr int block_side = 4, block_voxels = 64;
inline constexpr int brick_side = 32;
inline constexpr int most_code_levels = 8, most_codevectors = 1 << 16, most_code_bits = 56;
inline constexpr int details = 3;  // resolutions: 1:1, 2:1, 4:1 along each axis

// Returns ceil(log2 codevectors), the bits of an index.
int index_bits(int codevectors);
glm::ivec3 blocks_of(glm::ivec3 size);  // the last ones may reach beyond
glm::ivec3 bricks_of(glm::ivec3 size);
// Returns the bytes of all codes: 6 for each block by four levels of 4096 codevectors.
uint64_t code_bytes(glm::ivec3 size, int levels, int codevectors);

// Copies share the file's bytes.
struct CompressedVolume {
  glm::ivec3 size{0};
  int channels = 1;                  // 1 or 3
  SampleKind kind = SampleKind::u8;  // u8, u16 or i16; colours: u8
  double slope = 1, intercept = 0;   // see Volume
  glm::dmat4 to_metres{1};
  int levels = 4, codevectors = 4096;
  std::array<int, most_code_levels> fraction{}, offset{};

  std::shared_ptr<const std::byte> file;  // the whole file, in memory or mapped
  uint64_t file_bytes = 0;
  const std::byte* codes = nullptr;
  const std::byte* ranges = nullptr;

  // Codebooks as decoding needs them: for each level 2^index_bits codevectors, so that no index
  // of a damaged file leads outside.
  std::vector<uint32_t> words;  // colours, 64 a codevector; level 0 with a bias, see rgb_word.h
  std::vector<float> values;    // grey, 64 a codevector
  std::vector<float> halves;    // at 2:1: 2x2x2 voxels of each channel, channel after channel
  std::vector<float> quarters;  // at 4:1: one voxel, colours as 4 floats of which the last is 0

  glm::ivec3 blocks() const { return blocks_of(size); }
  int entries() const { return 1 << index_bits(codevectors); }
  uint64_t code(size_t block) const;
};

// Returns the number of voxels at a detail: 0 for 1:1, 1 for 2:1, 2 for 4:1.
glm::ivec3 size_at(const CompressedVolume& volume, int detail);

// Returns the volume in a file's bytes, which it keeps. Throws LoadError if they are no such file,
// in this version, of exactly the size that its header leads to. Codes are not read.
CompressedVolume open_compressed(std::shared_ptr<const std::byte> bytes, uint64_t count,
                                 const std::string& name);

// Describes where the parts of a file lie, in bytes from its beginning.
struct CompressedLayout {
  uint64_t codes = 0, codebooks = 0, ranges = 0, end = 0;
};
CompressedLayout layout_of(const CompressedVolume& volume);
inline constexpr uint64_t compressed_header_bytes = 248;
// Writes the header of such a volume to that many bytes.
void write_header(std::byte* to, const CompressedVolume& volume);

// The least and the greatest sample of a brick and of the blocks that touch it; raw samples.
struct SampleRange {
  glm::ivec3 least{0}, greatest{0};  // grey: x alone
};
SampleRange brick_range(const CompressedVolume& volume, glm::ivec3 brick);

}  // namespace wellspring::volume
