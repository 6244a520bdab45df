// SPDX-License-Identifier: Apache-2.0
#include "scan/las/laz_chunks.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <utility>

#include "base/load_error.h"
#include "scan/las/las_bytes.h"
#include "scan/las/laz_layers.h"

namespace wellspring::scan {

namespace {
// The record of LASzip: coding, sizes and options, then six bytes an item.
constexpr size_t layout_bytes = 34, layout_item_bytes = 6;
constexpr uint32_t every_chunk_differs = 0xffffffff;
constexpr size_t table_head_bytes = 8;  // version and number of chunks
}  // namespace

size_t LazLayout::record_bytes() const {
  size_t bytes = 0;
  for (const LazItem& item : items) bytes += item.size;
  return bytes;
}

LazLayout load_laz_layout(const std::string& file, std::span<const uint8_t> record) {
  const auto fail = [&](const std::string& what) {
    throw LoadError(file, "record of LASzip", what);
  };
  if (record.size() < layout_bytes) fail(fmt::format("has {} bytes", record.size()));
  const auto number = [&](size_t at) { return las_number<uint16_t>(record.data() + at); };
  const int compressor = number(0), coder = number(2);
  if (compressor < 1 || compressor > 3) fail(fmt::format("names the compressor {}", compressor));
  if (coder != 0) fail(fmt::format("names the coder {}", coder));
  const size_t items = number(32);
  if (items == 0 || record.size() < layout_bytes + items * layout_item_bytes)
    fail(fmt::format("has {} bytes for {} items", record.size(), items));

  LazLayout layout;
  layout.has_chunks = compressor != 1;
  layout.is_layered = compressor == 3;
  layout.chunk_points = las_number<uint32_t>(record.data() + 12);
  if (layout.chunk_points == every_chunk_differs) layout.chunk_points = 0;
  else if (layout.has_chunks && layout.chunk_points == 0) fail("says that chunks have no points");
  for (size_t i = 0; i < items; i++) {
    const size_t at = layout_bytes + i * layout_item_bytes;
    const LazItem item{LazItemKind(number(at)), number(at + 2), number(at + 4)};
    if (const std::string fault = find_fault(item); !fault.empty()) fail(fault);
    if (is_layered(item) != layout.is_layered) fail("mixes items in layers with others");
    const bool holds_place = item.kind == LazItemKind::point10 || item.kind == LazItemKind::point14;
    if (holds_place != (i == 0)) fail("has its items in another order");
    layout.items.push_back(item);
  }
  return layout;
}

namespace {

// Reads points and bytes of each chunk from the table at `table`.
std::vector<LazChunk> load_laz_table(const std::string& file, std::span<const uint8_t> bytes,
                                     uint64_t begin, uint64_t table, const LazLayout& layout) {
  const auto fail = [&](const std::string& what) {
    throw LoadError(file, fmt::format("byte {}", table), "the table of chunks " + what);
  };
  if (table < begin || table > bytes.size() || bytes.size() - table < table_head_bytes)
    fail("lies outside of the file");
  const uint8_t* head = bytes.data() + table;
  if (const uint32_t version = las_number<uint32_t>(head); version != 0)
    fail(fmt::format("has version {}", version));
  const uint32_t count = las_number<uint32_t>(head + 4);
  if (count > (table - begin) / layout.record_bytes())
    fail(fmt::format("promises {} chunks, for which there are {} bytes", count, table - begin));
  std::vector<LazChunk> chunks(count);
  if (count == 0) return chunks;
  ArithmeticDecoder decoder(bytes.subspan(table + table_head_bytes));
  IntegerDecoder numbers(32, 2);
  uint64_t at = begin;
  uint32_t points = 0, size = 0;
  for (LazChunk& chunk : chunks) {
    if (layout.chunk_points == 0) points = uint32_t(numbers.read(decoder, int32_t(points), 0));
    size = uint32_t(numbers.read(decoder, int32_t(size), 1));
    if (decoder.is_damaged() || size > table - at || (size < layout.record_bytes() && size > 0))
      fail("is damaged");
    chunk = {at, at + size, layout.chunk_points == 0 ? points : layout.chunk_points};
    at += size;
  }
  return chunks;
}

}  // namespace

std::vector<LazChunk> load_laz_chunks(const std::string& file, std::span<const uint8_t> bytes,
                                      uint64_t begin, uint64_t points, const LazLayout& layout) {
  const auto fail = [&](const std::string& what) {
    throw LoadError(file, fmt::format("byte {}", begin), what);
  };
  if (points == 0) return {};
  if (begin > bytes.size() || bytes.size() - begin < 8)
    fail("the points lie behind the file's end");
  if (!layout.has_chunks) return {{begin, bytes.size(), points}};
  uint64_t table = las_number<uint64_t>(bytes.data() + begin);
  // Who could not go back in the file wrote the table's place to its end.
  if (table == UINT64_MAX) table = las_number<uint64_t>(bytes.data() + bytes.size() - 8);
  begin += 8;
  if (table == begin - 8 || table == 0) fail("the table of chunks was never written");
  std::vector<LazChunk> chunks = load_laz_table(file, bytes, begin, table, layout);
  // The last chunk has fewer points, and no more are read than the header says.
  for (LazChunk& chunk : chunks) {
    chunk.points = std::min(chunk.points, points);
    points -= chunk.points;
  }
  std::erase_if(chunks, [](const LazChunk& chunk) { return chunk.points == 0; });
  return chunks;
}

struct LazChunkDecoder::Items {
  ArithmeticDecoder decoder;  // serves all items that go point by point
  std::vector<std::unique_ptr<PointwiseItem>> pointwise;
  std::vector<std::unique_ptr<LayeredItem>> layered;

  bool is_damaged() const {
    return decoder.is_damaged() ||
           std::ranges::any_of(layered, [](const auto& item) { return item->is_damaged(); });
  }
};

LazChunkDecoder::LazChunkDecoder(std::string file, std::string where, const LazLayout& layout,
                                 std::span<const uint8_t> bytes, uint64_t points)
    : file_(std::move(file)),
      where_(std::move(where)),
      layout_(layout),
      bytes_(bytes),
      left_(points),
      record_bytes_(layout.record_bytes()) {
  if (bytes.size() < record_bytes_) fail(fmt::format("has {} bytes", bytes.size()));
}

LazChunkDecoder::~LazChunkDecoder() = default;

void LazChunkDecoder::fail(const std::string& what) const { throw LoadError(file_, where_, what); }

void LazChunkDecoder::begin_pointwise() {
  const uint8_t* at = bytes_.data();
  for (const LazItem& item : layout_.items) {
    items_->pointwise.push_back(make_pointwise_item(item, at));
    at += item.size;
  }
  // A chunk of a single point may end here.
  if (left_ > 1) items_->decoder = ArithmeticDecoder(bytes_.subspan(record_bytes_));
}

void LazChunkDecoder::begin_layers() {
  size_t layers = 0;
  for (const LazItem& item : layout_.items) layers += layers_of(item);
  size_t at = record_bytes_;
  if (bytes_.size() - at < 4 * (1 + layers)) fail("ends before its layers");
  const auto number = [&] {
    at += 4;
    return las_number<uint32_t>(bytes_.data() + at - 4);
  };
  // The header may promise fewer points than the chunk has, never more.
  if (const uint32_t points = number(); points < left_)
    fail(fmt::format("holds {} points, and should hold {}", points, left_));
  std::vector<LazLayer> streams(layers);
  size_t begin = record_bytes_ + 4 * (1 + layers);
  for (LazLayer& stream : streams) {
    const uint32_t size = number();
    if (size > bytes_.size() - begin)
      fail(fmt::format("a layer has {} bytes, and {} are left", size, bytes_.size() - begin));
    stream = bytes_.subspan(begin, size);
    begin += size;
  }
  const uint8_t* first = bytes_.data();
  uint32_t channel = 0;
  size_t layer = 0;
  for (const LazItem& item : layout_.items) {
    const std::span<const LazLayer> own(&streams[layer], layers_of(item));
    items_->layered.push_back(make_layered_item(item, first, own, channel));
    first += item.size;
    layer += own.size();
  }
}

void LazChunkDecoder::read(uint8_t* records, size_t count) {
  size_t done = 0;
  if (!items_ && count > 0) {
    items_ = std::make_unique<Items>();
    if (layout_.is_layered) begin_layers();
    else begin_pointwise();
    std::memcpy(records, bytes_.data(), record_bytes_);  // the first point is not coded
    records += record_bytes_;
    done = 1;
  }
  const std::vector<LazItem>& kinds = layout_.items;
  for (; done < count; done++) {
    uint32_t channel = 0;
    for (size_t i = 0; i < kinds.size(); i++) {
      if (layout_.is_layered) items_->layered[i]->read(records, channel);
      else items_->pointwise[i]->read(items_->decoder, records);
      records += kinds[i].size;
    }
  }
  left_ -= count;
  if (items_ && items_->is_damaged()) fail("is damaged");
}

}  // namespace wellspring::scan
