// SPDX-License-Identifier: Apache-2.0
#include "volume/format/open_volume.h"

#include <cstring>
#include <sstream>

#include "base/load_error.h"
#include "base/read_file.h"

namespace wellspring::volume {

Volume open_volume(const std::string& path) {
  const std::string bytes = read_file(path, size_t(1) << 32);
  const size_t end = bytes.find("\n\n");
  if (!bytes.starts_with("NRRD") || end == std::string::npos)
    throw LoadError(path, "", "is no NRRD with its samples attached");
  Volume volume;
  dvec3 spacing(1), origin(0);
  double to_metres = 0.001;
  std::istringstream header(bytes.substr(0, end));
  for (std::string line; std::getline(header, line);) {
    const size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    const std::string name = line.substr(0, colon), value = line.substr(colon + 2);
    std::istringstream words(value);
    if (name == "sizes") words >> volume.size.x >> volume.size.y >> volume.size.z;
    if (name == "spacings") words >> spacing.x >> spacing.y >> spacing.z;
    if (name == "encoding" && value != "raw") throw LoadError(path, name, "only raw is read");
    if (name == "type") {
      if (value == "uchar" || value == "uint8" || value == "unsigned char")
        volume.kind = SampleKind::u8;
      else if (value == "short" || value == "int16")
        volume.kind = SampleKind::i16;
      else if (value == "ushort" || value == "uint16" || value == "unsigned short")
        volume.kind = SampleKind::u16;
      else if (value == "float")
        volume.kind = SampleKind::f32;
      else
        throw LoadError(path, name, "is not read: " + value);
    }
  }
  for (int i = 0; i < 3; i++) {
    if (volume.size[i] < 1 || volume.size[i] > 4096) throw LoadError(path, "sizes", "are wrong");
    if (!(spacing[i] > 0)) throw LoadError(path, "spacings", "are wrong");
    volume.to_metres[i][i] = spacing[i] * to_metres;
  }
  volume.to_metres[3] = glm::dvec4(origin * to_metres, 1);
  if (bytes.size() - end - 2 < volume.byte_count()) throw LoadError(path, "", "is cut short");
  const std::shared_ptr<std::byte[]> samples(new std::byte[volume.byte_count()]);
  std::memcpy(samples.get(), &bytes[end + 2], volume.byte_count());
  volume.bytes = std::shared_ptr<const std::byte>(samples, samples.get());
  return volume;
}

}  // namespace wellspring::volume
