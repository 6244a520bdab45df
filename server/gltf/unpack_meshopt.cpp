// SPDX-License-Identifier: Apache-2.0
#include <meshoptimizer.h>

#include "gltf/data.h"
#include "gltf/unpack.h"

namespace wellspring::gltf {
namespace {

constexpr const char* meshopt_names[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

std::string meshopt_place(const json& view, size_t index) {
  const char* name = extension(view, meshopt_names[0]) ? meshopt_names[0] : meshopt_names[1];
  return at("/bufferViews", index) + "/extensions/" + name;
}

void apply_filter(const std::string& filter, void* data, size_t count, size_t stride) {
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(data, count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(data, count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(data, count, stride);
}

bool fits_filter(const std::string& filter, int64_t stride) {
  if (filter == "OCTAHEDRAL") return stride == 4 || stride == 8;
  if (filter == "QUATERNION") return stride == 8;
  return filter == "NONE" || (filter == "EXPONENTIAL" && stride % 4 == 0);
}

}  // namespace

const json* meshopt_of(const json& view) {
  for (const char* name : meshopt_names)
    if (const json* found = extension(view, name)) return found;
  return nullptr;
}

void check_meshopt(File& file, size_t index) {
  const json& view = items(file.root, "bufferViews")[index];
  const json& packed = *meshopt_of(view);
  const std::string where = meshopt_place(view, index);
  const int64_t stride = integer(packed, "byteStride", 0), count = integer(packed, "count", 0);
  const int64_t length = integer(view, "byteLength", 0);
  const std::string mode = text(packed, "mode"), filter = text(packed, "filter", "NONE");
  const bool attributes = mode == "ATTRIBUTES";
  if (!attributes && mode != "TRIANGLES" && mode != "INDICES")
    refuse(file, where + "/mode", "is no mode of meshopt: \"" + mode.substr(0, 20) + "\"");
  if (attributes ? stride % 4 != 0 || stride > 256 : stride != 2 && stride != 4)
    refuse(file, where + "/byteStride", std::to_string(stride) + " cannot be that of " + mode);
  if (!fits_filter(filter, stride) || (!attributes && filter != "NONE"))
    refuse(file, where + "/filter",
           "\"" + filter.substr(0, 20) + "\" cannot be that of " + mode + " with a stride of " +
               std::to_string(stride));
  if (mode == "TRIANGLES" && count % 3 != 0)
    refuse(file, where + "/count", "is not a multiple of three");
  if (count > length || count * stride != length)
    refuse(file, where + "/count",
           "times the stride is not the view's length of " + std::to_string(length) + " bytes");
  const int64_t buffer = integer(packed, "buffer", 0), offset = integer(packed, "byteOffset", 0);
  const int64_t there = integer(items(file.root, "buffers")[size_t(buffer)], "byteLength", 0);
  if (offset > there || integer(packed, "byteLength", 0) > there - offset)
    refuse(file, where,
           "reaches beyond buffer " + std::to_string(buffer) + " of " + std::to_string(there) +
               " bytes");
}

const Bytes& unpack_meshopt(File& file, size_t index) {
  if (auto known = file.unpacked.find(index); known != file.unpacked.end()) return known->second;
  const json& view = items(file.root, "bufferViews")[index];
  const json& packed = *meshopt_of(view);
  const std::string where = meshopt_place(view, index), mode = text(packed, "mode");
  const size_t stride = size_t(integer(packed, "byteStride", 0));
  const size_t count = size_t(integer(packed, "count", 0));
  charge_unpacked(file, where, integer(view, "byteLength", 0));
  const Bytes& buffer = buffer_bytes(file, size_t(integer(packed, "buffer", 0)));
  const uint8_t* data = buffer.data() + integer(packed, "byteOffset", 0);
  const size_t length = size_t(integer(packed, "byteLength", 0));
  Bytes bytes(count * stride);
  int problem = 0;
  if (mode == "ATTRIBUTES")
    problem = meshopt_decodeVertexBuffer(bytes.data(), count, stride, data, length);
  else if (mode == "TRIANGLES")
    problem = meshopt_decodeIndexBuffer(bytes.data(), count, stride, data, length);
  else problem = meshopt_decodeIndexSequence(bytes.data(), count, stride, data, length);
  if (problem != 0)
    refuse(
        file, where,
        problem == -1 ? "is no meshopt data of a version that is known" : "is broken or cut off");
  apply_filter(text(packed, "filter", "NONE"), bytes.data(), count, stride);
  return file.unpacked[index] = std::move(bytes);
}

}  // namespace wellspring::gltf
