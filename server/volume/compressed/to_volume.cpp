// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/to_volume.h"

#include "base/parallel.h"
#include "volume/compressed/decode.h"

namespace wellspring::volume {
namespace {

constexpr int slab = 32;  // slices that one thread decodes at a time

template <class Sample>
void decode_all(const CompressedVolume& compressed, int detail, const Volume& volume,
                std::byte* bytes) {
  const size_t slice = size_t(volume.size.x) * size_t(volume.size.y) * size_t(volume.channels);
  parallel_each((volume.size.z + slab - 1) / slab, [&](int i) {
    const int first = i * slab, count = std::min(slab, volume.size.z - first);
    Sample* to = reinterpret_cast<Sample*>(bytes) + slice * size_t(first);
    decode(std::span(to, slice * size_t(count)), compressed, detail,
           {{0, 0, first}, {volume.size.x, volume.size.y, count}});
  });
}

}  // namespace

Volume to_volume(const CompressedVolume& compressed, int detail) {
  Volume volume;
  volume.size = size_at(compressed, detail);
  volume.channels = compressed.channels, volume.kind = compressed.kind;
  volume.slope = compressed.slope, volume.intercept = compressed.intercept;
  const double wide = double(1 << detail);
  glm::dmat4 to_finest(wide);
  to_finest[3] = glm::dvec4(glm::dvec3(0.5 * (wide - 1)), 1);
  volume.to_metres = compressed.to_metres * to_finest;
  const std::shared_ptr<std::byte[]> bytes(new std::byte[volume.byte_count()]);
  if (volume.kind == SampleKind::u8) decode_all<uint8_t>(compressed, detail, volume, bytes.get());
  else if (volume.kind == SampleKind::u16)
    decode_all<uint16_t>(compressed, detail, volume, bytes.get());
  else decode_all<int16_t>(compressed, detail, volume, bytes.get());
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  return volume;
}

}  // namespace wellspring::volume
