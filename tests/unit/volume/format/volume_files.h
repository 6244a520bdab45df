// SPDX-License-Identifier: Apache-2.0
// Makes files of volumes for tests.
#pragma once
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "base/load_error.h"
#include "unit/folder.h"
#include "volume/format/open_volume.h"

namespace wellspring::test {

// Appends numbers in one byte order.
struct BytesOf {
  bool is_big = false;
  std::string bytes = {};

  template <class Value>
  BytesOf& put(Value value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (is_big) std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
    return *this;
  }
  template <class Value>
  BytesOf& set(size_t place, Value value) {
    BytesOf one{is_big};
    one.put(value);
    if (bytes.size() < place + sizeof value) bytes.resize(place + sizeof value);
    bytes.replace(place, sizeof value, one.bytes);
    return *this;
  }
};

// A header of NIfTI-1 whose fields can be changed before it becomes bytes.
struct NiftiFile {
  bool is_big = false, is_version_2 = false;
  std::string magic = "n+1";
  std::vector<int64_t> dim{3, 2, 1, 1};
  int type = 2, sform_code = 0, qform_code = 0, unit = 2, orient = 0;
  std::vector<double> pixdim{1, 1, 1, 1};
  double offset = 352, slope = 0, intercept = 0;
  std::vector<double> quaternion{0, 0, 0, 0, 0, 0};
  std::vector<double> rows{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  std::string header() const {
    BytesOf to{is_big, std::string(is_version_2 ? 544 : 352, '\0')};
    if (is_version_2) {
      to.set(0, int32_t(540)).set(12, int16_t(type)).set(168, int64_t(544)).set(176, slope);
      to.bytes.replace(4, 8, std::string("n+2\0\r\n\x1a\n", 8));
      to.set(184, intercept).set(344, int32_t(qform_code)).set(348, int32_t(sform_code));
      for (size_t i = 0; i < dim.size(); i++) to.set(16 + 8 * i, dim[i]);
      for (size_t i = 0; i < pixdim.size(); i++) to.set(104 + 8 * i, pixdim[i]);
      for (size_t i = 0; i < 6; i++) to.set(352 + 8 * i, quaternion[i]);
      for (size_t i = 0; i < 12; i++) to.set(400 + 8 * i, rows[i]);
      to.set(500, int32_t(unit));
      return to.bytes;
    }
    to.set(0, int32_t(348)).set(70, int16_t(type)).set(108, float(offset)).set(112, float(slope));
    to.bytes.replace(344, magic.size(), magic);
    to.set(116, float(intercept)).set(252, int16_t(qform_code)).set(254, int16_t(sform_code));
    for (size_t i = 0; i < dim.size(); i++) to.set(40 + 2 * i, int16_t(dim[i]));
    for (size_t i = 0; i < pixdim.size(); i++) to.set(76 + 4 * i, float(pixdim[i]));
    for (size_t i = 0; i < 6; i++) to.set(256 + 4 * i, float(quaternion[i]));
    for (size_t i = 0; i < 12; i++) to.set(280 + 4 * i, float(rows[i]));
    if (magic.empty()) to.bytes[252] = char(orient);
    to.set(123, uint8_t(unit));
    return to.bytes;
  }
};

// Packs bytes by gzip, or by zlib.
inline std::string pack(const std::string& bytes, bool as_gzip = true, int level = 6) {
  z_stream state{};
  deflateInit2(&state, level, Z_DEFLATED, as_gzip ? 31 : 15, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&state, bytes.size()) + 64, '\0');
  state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  state.avail_in = uInt(bytes.size());
  state.next_out = reinterpret_cast<Bytef*>(packed.data());
  state.avail_out = uInt(packed.size());
  deflate(&state, Z_FINISH);
  packed.resize(size_t(state.total_out));
  deflateEnd(&state);
  return packed;
}

template <class Sample>
std::string samples_of(const std::vector<Sample>& samples, bool is_big = false) {
  BytesOf to{is_big};
  for (const Sample sample : samples) to.put(sample);
  return to.bytes;
}

// Returns what all samples of a channel measure, x fastest.
inline std::vector<double> values_of(const Volume& volume, int channel = 0) {
  std::vector<double> values;
  for (int z = 0; z < volume.size.z; z++)
    for (int y = 0; y < volume.size.y; y++)
      for (int x = 0; x < volume.size.x; x++) values.push_back(volume.at(x, y, z, channel));
  return values;
}

// Returns where a sample lies in the patient's frame, in millimetres.
inline glm::dvec3 place_of(const Volume& volume, glm::dvec3 index) {
  return glm::dvec3(volume.to_metres * glm::dvec4(index, 1)) * 1000.0;
}

// Returns the message with which a file is refused; empty: it is read.
inline std::string refusal(const std::string& path, const VolumeChoice& choice = {}) {
  try {
    open_volume(path, choice);
  } catch (const LoadError& error) {
    return error.what();
  }
  return {};
}

}  // namespace wellspring::test
