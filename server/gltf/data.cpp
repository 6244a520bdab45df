// SPDX-License-Identifier: Apache-2.0
#include "gltf/data.h"

#include <algorithm>
#include <cstring>

#include "gltf/file.h"

namespace wellspring::gltf {
namespace {

struct NamedType {
  const char* name;
  int components, rows;  // rows: in a matrix's column, 0 for the rest
};
constexpr NamedType types[] = {{"SCALAR", 1, 0}, {"VEC2", 2, 0}, {"VEC3", 3, 0}, {"VEC4", 4, 0},
                               {"MAT2", 4, 2},   {"MAT3", 9, 3}, {"MAT4", 16, 4}};

const NamedType* type_named(const std::string& name) {
  for (const NamedType& type : types)
    if (name == type.name) return &type;
  return nullptr;
}

int component_size(int component_type) {
  switch (component_type) {
    case byte_component:
    case unsigned_byte: return 1;
    case short_component:
    case unsigned_short: return 2;
    case unsigned_int:
    case float_component: return 4;
  }
  return 0;
}

const char* component_name(int component_type) {
  switch (component_type) {
    case byte_component: return "BYTE";
    case unsigned_byte: return "UNSIGNED_BYTE";
    case short_component: return "SHORT";
    case unsigned_short: return "UNSIGNED_SHORT";
    case unsigned_int: return "UNSIGNED_INT";
    case float_component: return "FLOAT";
  }
  return "an unknown component type";
}

// Holds byte offsets of the components in an element; columns of matrices start at multiples of
// four.
struct ElementLayout {
  int components = 0, size = 0;
  int offset[16] = {};
};

ElementLayout layout_of(const NamedType& type, int component_type) {
  ElementLayout layout;
  int bytes = component_size(component_type);
  layout.components = type.components;
  int column = type.rows ? (type.rows * bytes + 3) / 4 * 4 : 0;
  for (int i = 0; i < type.components; i++)
    layout.offset[i] = type.rows ? i / type.rows * column + i % type.rows * bytes : i * bytes;
  layout.size = type.rows ? type.components / type.rows * column : type.components * bytes;
  return layout;
}

template <class T>
float component(const uint8_t* p, bool normalized) {
  T value;
  std::memcpy(&value, p, sizeof value);
  if constexpr (std::is_same_v<T, float>) return value;
  else {
    if (!normalized) return float(value);
    // Section 3.11: signed integers reach -1 twice.
    return std::max(float(double(value) / double(std::numeric_limits<T>::max())), -1.0f);
  }
}

template <class T>
void read_elements(const uint8_t* data, int64_t count, int64_t stride, const ElementLayout& layout,
                   bool normalized, float* out) {
  for (int64_t i = 0; i < count; i++, data += stride)
    for (int c = 0; c < layout.components; c++)
      *out++ = component<T>(data + layout.offset[c], normalized);
}

void read_elements(int component_type, const uint8_t* data, int64_t count, int64_t stride,
                   const ElementLayout& layout, bool normalized, float* out) {
  switch (component_type) {
    case byte_component: return read_elements<int8_t>(data, count, stride, layout, normalized, out);
    case unsigned_byte: return read_elements<uint8_t>(data, count, stride, layout, normalized, out);
    case short_component:
      return read_elements<int16_t>(data, count, stride, layout, normalized, out);
    case unsigned_short:
      return read_elements<uint16_t>(data, count, stride, layout, normalized, out);
    case unsigned_int: return read_elements<uint32_t>(data, count, stride, layout, normalized, out);
    default: return read_elements<float>(data, count, stride, layout, normalized, out);
  }
}

uint32_t unsigned_component(const uint8_t* p, int component_type) {
  if (component_type == unsigned_byte) return *p;
  if (component_type == unsigned_short) return uint32_t(p[0]) | uint32_t(p[1]) << 8;
  uint32_t value;
  std::memcpy(&value, p, 4);
  return value;
}

std::string accessor_place(size_t accessor) { return at("/accessors", accessor); }

// Checks that `count` elements at byteOffset of a view fit into it: sections 3.6.2.4 and 3.6.2.3.
void check_fit(const File& file, const std::string& where, const json& reader, int64_t count,
               int64_t stride, int64_t size) {
  int64_t view = integer(reader, "bufferView", 0);
  int64_t length = integer(items(file.root, "bufferViews")[size_t(view)], "byteLength", 0);
  int64_t offset = integer(reader, "byteOffset", 0);
  if (count <= 0) return;
  if (count > length || offset > length || (count - 1) * stride + size > length - offset)
    refuse(file, where,
           "reaches beyond bufferView " + std::to_string(view) + " of " + std::to_string(length) +
               " bytes");
}

void check_sparse(const File& file, const json& accessor, int64_t count, int64_t size,
                  const std::string& where) {
  const json* sparse = find(accessor, "sparse");
  if (!sparse) return;
  int64_t replaced = integer(*sparse, "count", 0);
  if (replaced > count)
    refuse(file, where + "/sparse/count", "replaces more elements than there are");
  const json& indices = (*sparse)["indices"];
  int type = int(integer(indices, "componentType", 0));
  if (type != unsigned_byte && type != unsigned_short && type != unsigned_int)
    refuse(file, where + "/sparse/indices/componentType", "is not an unsigned integer type");
  check_fit(file, where + "/sparse/indices", indices, replaced, component_size(type),
            component_size(type));
  check_fit(file, where + "/sparse/values", (*sparse)["values"], replaced, size, size);
}

void check_accessor(File& file, size_t index) {
  const std::string where = accessor_place(index);
  const json& accessor = items(file.root, "accessors")[index];
  const NamedType* type = type_named(text(accessor, "type"));
  int64_t component_type = integer(accessor, "componentType", 0);
  int bytes = component_type <= float_component ? component_size(int(component_type)) : 0;
  int64_t count = integer(accessor, "count", 0);
  // Accessors with bytes are bounded by these: check_fit.
  if (const int64_t most = empty_numbers_limit / (type ? type->components : 1);
      !find(accessor, "bufferView") && count > most)
    refuse_beyond(file, where + "/count", most, "elements without bytes of their own",
                  "give it a bufferView");
  if (!type || bytes == 0) {
    warn(file, where, "an accessor of unknown type");
    return;  // the file is refused if something uses the accessor
  }
  ElementLayout layout = layout_of(*type, int(component_type));
  check_sparse(file, accessor, count, layout.size, where);
  const json* view_index = find(accessor, "bufferView");
  if (!view_index) {
    if (integer(accessor, "byteOffset", 0) != 0)
      warn(file, where + "/byteOffset", "an offset without a buffer view is ignored");
    return;
  }
  const json& view = items(file.root, "bufferViews")[view_index->get<size_t>()];
  int64_t stride = integer(view, "byteStride", layout.size);
  if (stride < layout.size)
    refuse(file, where,
           "elements of " + std::to_string(layout.size) +
               " bytes are longer than their stride of " + std::to_string(stride));
  if (integer(accessor, "byteOffset", 0) % bytes != 0)
    warn(file, where + "/byteOffset", "misaligned data");
  check_fit(file, where, accessor, count, stride, layout.size);
}

void check_view(File& file, size_t index) {
  const std::string where = at("/bufferViews", index);
  const json& view = items(file.root, "bufferViews")[index];
  int64_t buffer = integer(view, "buffer", 0);
  int64_t available = integer(items(file.root, "buffers")[size_t(buffer)], "byteLength", 0);
  int64_t offset = integer(view, "byteOffset", 0), length = integer(view, "byteLength", 0);
  if (offset > available || length > available - offset)
    refuse(file, where,
           "reaches beyond buffer " + std::to_string(buffer) + " of " + std::to_string(available) +
               " bytes");
  if (meshopt_of(view)) check_meshopt(file, index);
  if (!find(view, "byteStride")) return;
  int64_t stride = integer(view, "byteStride", 0);
  if (stride > (int64_t(1) << 30)) refuse(file, where + "/byteStride", "is out of range");
  if (stride % 4 != 0 || stride > 252)
    warn(file, where + "/byteStride", "a stride that is not a multiple of 4 up to 252");
  if (stride > length) warn(file, where + "/byteStride", "a stride longer than its buffer view");
}

// Returns where an accessor's or a sparse part's bytes start. The layout was checked against the
// view.
const uint8_t* start_of(File& file, const json& reader) {
  std::span<const uint8_t> view = view_bytes(file, size_t(integer(reader, "bufferView", 0)));
  return view.data() + integer(reader, "byteOffset", 0);
}

const NamedType& readable_type(const File& file, size_t accessor, const Form& form) {
  const NamedType* type = type_named(text(items(file.root, "accessors")[accessor], "type"));
  if (!type || form.component_type == 0)
    refuse(file, accessor_place(accessor), "cannot be read: its type is unknown to glTF 2.0");
  return *type;
}

void charge(File& file, size_t accessor, const Form& form) {
  file.numbers_read += form.count * form.components;
  if (file.numbers_read > numbers_limit)
    refuse_beyond(file, accessor_place(accessor), numbers_limit,
                  "numbers in all, each time that something uses an accessor", fewer_vertices);
}

std::vector<uint32_t> sparse_indices(File& file, const json& sparse, int64_t count,
                                     const std::string& where) {
  const json& indices = sparse["indices"];
  int type = int(integer(indices, "componentType", 0)), bytes = component_size(type);
  int64_t replaced = integer(sparse, "count", 0);
  std::vector<uint32_t> list(static_cast<size_t>(replaced));
  if (replaced == 0) return list;
  const uint8_t* data = start_of(file, indices);
  for (int64_t i = 0; i < replaced; i++) {
    list[size_t(i)] = unsigned_component(data + i * bytes, type);
    if (list[size_t(i)] >= count)
      refuse(file, where + "/sparse/indices",
             "element " + std::to_string(i) + " is " + std::to_string(list[size_t(i)]) + ", of " +
                 std::to_string(count) + " elements");
  }
  return list;
}

}  // namespace

const Bytes& buffer_bytes(File& file, size_t index) {
  if (!file.buffer_ready[index]) {
    const std::string where = at("/buffers", index);
    const json& buffer = items(file.root, "buffers")[index];
    size_t length = size_t(integer(buffer, "byteLength", 0));
    Bytes& bytes = file.buffers[index];
    if (const json* uri = find(buffer, "uri")) {
      std::optional<Bytes> found = read_uri(file, where + "/uri", uri->get<std::string>());
      if (!found)
        refuse(file, where + "/uri", no_such_file(file, where + "/uri", uri->get<std::string>()));
      bytes = std::move(*found);
      file.bytes_read += int64_t(bytes.size());
      if (file.bytes_read > all_bytes_limit)
        refuse_beyond(file, where, all_bytes_limit, "bytes of buffers in all", fewer_vertices);
    } else if (index == 0 && file.has_binary) {
      bytes = std::move(file.binary);
    } else {
      refuse(file, where, "has no data");
    }
    if (bytes.size() < length)
      refuse(
          file, where + "/byteLength",
          "says " + std::to_string(length) + " bytes, there are " + std::to_string(bytes.size()));
    file.buffer_ready[index] = 1;
  }
  return file.buffers[index];
}

void charge_unpacked(File& file, const std::string& where, int64_t bytes) {
  file.unpacked_bytes += bytes;
  if (file.unpacked_bytes > unpacked_bytes_limit)
    refuse_beyond(file, where, unpacked_bytes_limit, "bytes unpacked in all", fewer_vertices);
}

void check_layout(File& file) {
  for (size_t i = 0; i < items(file.root, "bufferViews").size(); i++) check_view(file, i);
  unpack_draco(file);
  for (size_t i = 0; i < items(file.root, "accessors").size(); i++) check_accessor(file, i);
}

Form form_of(const File& file, size_t accessor) {
  const json& object = items(file.root, "accessors")[accessor];
  const NamedType* type = type_named(text(object, "type"));
  int64_t component_type = integer(object, "componentType", 0);
  bool known = component_type <= float_component && component_size(int(component_type)) > 0;
  return {integer(object, "count", 0), type ? type->components : 0, known ? int(component_type) : 0,
          boolean(object, "normalized", false)};
}

std::string describe(const File& file, size_t accessor) {
  Form form = form_of(file, accessor);
  return text(items(file.root, "accessors")[accessor], "type").substr(0, 20) + " of " +
         (form.normalized ? "normalised " : "") + component_name(form.component_type);
}

std::span<const uint8_t> view_bytes(File& file, size_t view) {
  const json& object = items(file.root, "bufferViews")[view];
  if (meshopt_of(object)) return unpack_meshopt(file, view);
  const Bytes& buffer = buffer_bytes(file, size_t(integer(object, "buffer", 0)));
  return {buffer.data() + integer(object, "byteOffset", 0),
          size_t(integer(object, "byteLength", 0))};
}

bool has_data(const File& file, size_t accessor) {
  const json* view = find(items(file.root, "accessors")[accessor], "bufferView");
  if (!view) return true;
  const json& object = items(file.root, "bufferViews")[view->get<size_t>()];
  const json* packed = meshopt_of(object);
  const size_t buffer = size_t(integer(packed ? *packed : object, "buffer", 0));
  if (file.buffer_ready[buffer]) return true;
  return find(items(file.root, "buffers")[buffer], "uri") || (buffer == 0 && file.has_binary);
}

std::shared_ptr<const std::vector<float>> read_floats(File& file, size_t accessor) {
  if (auto known = file.decoded.find(accessor); known != file.decoded.end()) return known->second;
  Form form = form_of(file, accessor);
  const NamedType& type = readable_type(file, accessor, form);
  const json& object = items(file.root, "accessors")[accessor];
  ElementLayout layout = layout_of(type, form.component_type);
  charge(file, accessor, form);
  auto made = std::make_shared<std::vector<float>>(size_t(form.count) * size_t(layout.components));
  std::vector<float>& values = *made;
  if (form.count == 0) return made;
  if (const json* view_index = find(object, "bufferView")) {
    const json& view = items(file.root, "bufferViews")[view_index->get<size_t>()];
    read_elements(form.component_type, start_of(file, object), form.count,
                  integer(view, "byteStride", layout.size), layout, form.normalized, values.data());
  }
  if (const json* sparse = find(object, "sparse")) {
    std::vector<uint32_t> replaced =
        sparse_indices(file, *sparse, form.count, accessor_place(accessor));
    if (!replaced.empty()) {
      const uint8_t* data = start_of(file, (*sparse)["values"]);
      for (size_t i = 0; i < replaced.size(); i++)
        read_elements(form.component_type, data + i * size_t(layout.size), 1, layout.size, layout,
                      form.normalized, &values[replaced[i] * size_t(layout.components)]);
    }
  }
  constexpr int64_t keep = int64_t(1) << 26;
  if (int64_t(values.size()) > keep) return made;
  if (file.decoded_numbers + int64_t(values.size()) > keep) {
    file.decoded.clear();
    file.decoded_numbers = 0;
  }
  file.decoded_numbers += int64_t(values.size());
  file.decoded[accessor] = made;
  return made;
}

std::vector<uint32_t> read_integers(File& file, size_t accessor) {
  Form form = form_of(file, accessor);
  readable_type(file, accessor, form);
  const json& object = items(file.root, "accessors")[accessor];
  if (form.component_type != unsigned_byte && form.component_type != unsigned_short &&
      form.component_type != unsigned_int)
    refuse(file, accessor_place(accessor),
           "must hold unsigned integers, not " + describe(file, accessor));
  charge(file, accessor, form);
  int bytes = component_size(form.component_type), components = form.components;
  std::vector<uint32_t> values(size_t(form.count) * size_t(components), 0);
  if (form.count == 0) return values;
  auto read_one = [&](const uint8_t* data, size_t element) {
    for (int c = 0; c < components; c++)
      values[element * size_t(components) + size_t(c)] =
          unsigned_component(data + c * bytes, form.component_type);
  };
  if (const json* view_index = find(object, "bufferView")) {
    const json& view = items(file.root, "bufferViews")[view_index->get<size_t>()];
    int64_t stride = integer(view, "byteStride", int64_t(components) * bytes);
    const uint8_t* data = start_of(file, object);
    for (int64_t i = 0; i < form.count; i++) read_one(data + i * stride, size_t(i));
  }
  if (const json* sparse = find(object, "sparse")) {
    std::vector<uint32_t> replaced =
        sparse_indices(file, *sparse, form.count, accessor_place(accessor));
    if (!replaced.empty()) {
      const uint8_t* data = start_of(file, (*sparse)["values"]);
      for (size_t i = 0; i < replaced.size(); i++)
        read_one(data + i * size_t(components * bytes), replaced[i]);
    }
  }
  return values;
}

}  // namespace wellspring::gltf
