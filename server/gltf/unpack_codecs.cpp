// SPDX-License-Identifier: Apache-2.0
#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <meshoptimizer.h>
#include <new>

#include "gltf/data.h"

namespace wellspring::gltf {
namespace {

constexpr const char* draco_name = "KHR_draco_mesh_compression";
constexpr uint16_t least_version = 0x0202;   // bitstream version that the extension asks for
constexpr uint32_t most_attributes = 16;     // each keeps a set of corners, with memory of its own
constexpr uint64_t most_faces_a_byte = 256;  // no real mesh comes near

// Holds the size that a stream claims, before anything is made of it.
struct DracoClaim {
  uint64_t faces = 0, points = 0;
};

std::optional<DracoClaim> read_claim(std::span<const uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  struct Header {
    char magic[5];
    uint8_t major = 0, minor = 0, type = 0, method = 0;
    uint16_t flags = 0;
  } header;
  const bool read = buffer.Decode(header.magic, 5) && buffer.Decode(&header.major) &&
                    buffer.Decode(&header.minor) && buffer.Decode(&header.type) &&
                    buffer.Decode(&header.method) && buffer.Decode(&header.flags);
  const uint16_t version = uint16_t(header.major << 8 | header.minor);
  if (!read || std::string_view(header.magic, 5) != "DRACO" || version < least_version ||
      header.type != draco::TRIANGULAR_MESH || header.method > 1)
    return {};
  buffer.set_bitstream_version(version);
  if (header.flags & METADATA_FLAG_MASK) {
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) return {};
  }
  uint32_t first = 0, second = 0;
  if (header.method == draco::MESH_SEQUENTIAL_ENCODING) {
    if (!draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer)) return {};
    return DracoClaim{first, second};
  }
  uint8_t traversal = 0, attributes = 0;
  if (!buffer.Decode(&traversal) || !draco::DecodeVarint(&first, &buffer) ||
      !draco::DecodeVarint(&second, &buffer) || !buffer.Decode(&attributes) ||
      attributes > most_attributes)
    return {};
  return DracoClaim{second, first};
}

template <class T>
bool write_values(const draco::PointAttribute& from, uint32_t points, int components, Bytes& to) {
  const size_t begin = to.size(), row = sizeof(T) * size_t(components);
  to.resize(begin + points * row);
  std::vector<T> values(static_cast<size_t>(components));
  for (uint32_t i = 0; i < points; i++) {
    const auto value = from.mapped_index(draco::PointIndex(i));
    if (value.value() >= from.size() ||
        !from.ConvertValue<T>(value, int8_t(components), values.data()))
      return false;
    std::memcpy(&to[begin + i * row], values.data(), row);
  }
  return true;
}

bool write_values(const draco::PointAttribute& from, uint32_t points, const Form& form, Bytes& to) {
  switch (form.component_type) {
    case byte_component: return write_values<int8_t>(from, points, form.components, to);
    case unsigned_byte: return write_values<uint8_t>(from, points, form.components, to);
    case short_component: return write_values<int16_t>(from, points, form.components, to);
    case unsigned_short: return write_values<uint16_t>(from, points, form.components, to);
    case unsigned_int: return write_values<uint32_t>(from, points, form.components, to);
    default: return write_values<float>(from, points, form.components, to);
  }
}

// Makes the file's JSON say that an accessor's bytes are `length` from `offset` on in the buffer.
void point_to(File& file, json& accessor, size_t buffer, size_t offset, size_t length,
              uint32_t count) {
  json& views = file.root["bufferViews"];
  accessor["bufferView"] = views.size();
  accessor["count"] = count;
  accessor.erase("byteOffset"), accessor.erase("sparse");
  views.push_back({{"buffer", buffer}, {"byteOffset", offset}, {"byteLength", length}});
}

std::unique_ptr<draco::Mesh> decode(File& file, const std::string& where,
                                    std::span<const uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    auto made = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!made.ok())
      refuse(file, where,
             "Draco data cannot be decoded: " + made.status().error_msg_string().substr(0, 100));
    return std::move(made).value();
  } catch (const std::bad_alloc&) {
    refuse(file, where, "Draco data asks for more memory than there is");
  }
}

struct DracoPrimitive {
  json& primitive;
  const std::string where;  // place of the extension in the file
};

void unpack_primitive(File& file, const DracoPrimitive& one) {
  const json& packed = *extension(one.primitive, draco_name);
  const std::string where = one.where;
  const json* indices = find(one.primitive, "indices");
  const int64_t mode = integer(one.primitive, "mode", 4);
  if (!indices || (mode != 4 && mode != 5))
    refuse(file, where, "compresses what are no triangles with indices");
  const std::span<const uint8_t> bytes = view_bytes(file, size_t(integer(packed, "bufferView", 0)));
  const std::optional<DracoClaim> claim = read_claim(bytes);
  if (!claim) refuse(file, where, "is no Draco mesh of bitstream 2.2");
  if (claim->faces > most_faces_a_byte * bytes.size())
    refuse(file, where, "claims more triangles than its bytes can hold");
  if (claim->faces > uint64_t(triangles_limit))
    refuse_beyond(file, where, triangles_limit, "triangles in all", fewer_triangles);
  if (claim->points > uint64_t(vertices_limit) || claim->points > 3 * claim->faces)
    refuse_beyond(file, where, vertices_limit, "vertices, or three a triangle", fewer_vertices);
  const std::unique_ptr<draco::Mesh> mesh = decode(file, where, bytes);
  const uint32_t points = mesh->num_points();
  if (mesh->num_faces() > claim->faces || points > uint64_t(vertices_limit))
    refuse(file, where, "has more triangles or vertices than it says");

  const size_t buffer = file.buffers.size();
  json& accessors = file.root["accessors"];
  Bytes made;
  for (const auto& [name, id] : packed["attributes"].items()) {
    const json* accessor = find(one.primitive["attributes"], name.c_str());
    if (!accessor) continue;
    const std::string place = at(where + "/attributes", name);
    const size_t index = accessor->get<size_t>();
    if (!id.is_number_unsigned() || id.get<uint64_t>() > 0xffffffffu)
      refuse(file, place, "must be the number of an attribute");
    const draco::PointAttribute* from = mesh->GetAttributeByUniqueId(id.get<uint32_t>());
    if (!from) refuse(file, place, "there is no such attribute in the Draco data");
    const Form form = form_of(file, index);
    if (form.components == 0 || form.component_type == 0 ||
        form.components != from->num_components())
      refuse(file, place, "cannot be " + describe(file, index));
    const size_t begin = made.size();
    charge_unpacked(file, place, int64_t(points) * form.components * 4);
    if (!write_values(*from, points, form, made))
      refuse(file, place, "has values that are not of " + describe(file, index));
    point_to(file, accessors[index], buffer, begin, made.size() - begin, points);
    made.resize((made.size() + 3) / 4 * 4);
  }
  const uint32_t corners = 3 * mesh->num_faces();
  charge_unpacked(file, where, int64_t(corners) * 4);
  const size_t begin = made.size();
  made.resize(begin + size_t(corners) * 4);
  for (uint32_t f = 0; f < mesh->num_faces(); f++)
    for (uint32_t c = 0; c < 3; c++) {
      const uint32_t point = mesh->face(draco::FaceIndex(f))[c].value();
      std::memcpy(&made[begin + (size_t(f) * 3 + c) * 4], &point, 4);
    }
  json& list = accessors[indices->get<size_t>()];
  list["componentType"] = int(unsigned_int);
  if (corners > 0) point_to(file, list, buffer, begin, made.size() - begin, corners);
  one.primitive["mode"] = 4;
  file.root["buffers"].push_back({{"byteLength", std::max<size_t>(made.size(), 1)}});
  made.resize(std::max<size_t>(made.size(), 1));
  file.buffers.push_back(std::move(made));
  file.buffer_ready.push_back(1);
}

}  // namespace

void unpack_draco(File& file) {
  if (!file.root.contains("meshes")) return;
  // Primitives may share all of their data; accessors of data that is unpacked already keep it.
  std::set<std::pair<json, json>> done;
  json& meshes = file.root["meshes"];
  for (size_t m = 0; m < meshes.size(); m++) {
    json& primitives = meshes[m]["primitives"];
    for (size_t p = 0; p < primitives.size(); p++) {
      if (!extension(primitives[p], draco_name)) continue;
      const std::string where =
          at(at("/meshes", m) + "/primitives", p) + "/extensions/" + draco_name;
      const std::pair<json, json> data(
          json{*extension(primitives[p], draco_name), primitives[p]["attributes"]},
          primitives[p].value("indices", json()));
      if (done.insert(data).second) unpack_primitive(file, {primitives[p], where});
      else primitives[p]["mode"] = 4;
    }
  }
}

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
