// SPDX-License-Identifier: Apache-2.0
#include "scan/format/e57_section.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace wellspring::scan {
namespace {
constexpr size_t section_header = 32, data_header = 6;
// A scan whose numbers are all the same has no bytes; its number of points must be bounded, too.
constexpr uint64_t most_without_bytes = uint64_t(1) << 20;
}  // namespace

E57Section::E57Section(E57Pages& pages, const E57Scan& scan, const std::vector<bool>& is_wanted)
    : pages_(&pages), scan_(&scan), pending_(scan.streams.size()), left_(scan.points) {
  const uint64_t begin = pages.to_logical(scan.section);
  const std::string where = fmt::format("byte {}", scan.section);
  char header[section_header];
  pages.read(begin, header, sizeof header);
  if (header[0] != 1)
    pages.file().fail(where,
                      fmt::format("is no section of points: its kind is {}", uint8_t(header[0])));
  const uint64_t length = number_at<uint64_t>(header + 8);
  if (length > pages.size() - begin)
    pages.file().fail(where, fmt::format("promises {} bytes of points", length));
  end_ = begin + length;
  if (scan.points == 0) return;
  next_ = pages.to_logical(number_at<uint64_t>(header + 16));
  uint64_t bits = 0;
  for (size_t i = 0; i < pending_.size(); i++) {
    pending_[i].is_wanted = is_wanted[i];
    if (is_wanted[i]) bits += uint64_t(scan.streams[i].bits);
  }
  if (bits == 0 ? scan.points > most_without_bytes : scan.points > length * 8 / bits)
    pages.file().fail(where, fmt::format("promises {} points in {} bytes", scan.points, length));
}

uint64_t E57Section::available(size_t i) const {
  const int bits = scan_->streams[i].bits;
  if (bits == 0) return left_;
  return (pending_[i].bytes.size() * 8 - pending_[i].bit) / uint64_t(bits);
}

void E57Section::read_packet() {
  const uint64_t physical = next_ / E57Pages::content * E57Pages::page + next_ % E57Pages::content;
  const std::string where = fmt::format("byte {}", physical);
  if (next_ >= end_ || end_ - next_ < 4)
    pages_->file().fail(
        where, fmt::format("is cut off: {} points of '{}' are missing", left_, scan_->name));
  char head[data_header] = {};
  pages_->read(next_, head, 4);
  const size_t length = size_t(number_at<uint16_t>(head + 2)) + 1;
  if (length > end_ - next_) pages_->file().fail(where, "a packet reaches beyond its section");
  const int kind = head[0];
  if (kind != 0 && kind != 1 && kind != 2)
    pages_->file().fail(where, fmt::format("has a packet of kind {}", kind));
  if (kind == 1) {
    packet_.resize(length);
    pages_->read(next_, packet_.data(), length);
    const size_t count = length < data_header ? 0 : number_at<uint16_t>(packet_.data() + 4);
    size_t at = data_header + 2 * count;
    if (count != pending_.size() || at > length)
      pages_->file().fail(where,
                          fmt::format("has {} numbers a point, not {}", count, pending_.size()));
    for (size_t i = 0; i < count; i++) {
      const size_t bytes = number_at<uint16_t>(packet_.data() + data_header + 2 * i);
      if (bytes > length - at) pages_->file().fail(where, "a stream reaches beyond its packet");
      Pending& pending = pending_[i];
      if (pending.is_wanted) {
        pending.bytes.erase(0, pending.bit / 8);
        pending.bit %= 8;
        pending.bytes.append(packet_, at, bytes);
      }
      at += bytes;
    }
  }
  next_ += length;
}

void E57Section::decode(size_t i, size_t count, double* to) {
  const E57Stream& stream = scan_->streams[i];
  Pending& pending = pending_[i];
  if (stream.bits == 0) {
    std::fill(to, to + count, double(stream.low) * stream.scale + stream.offset);
    return;
  }
  if (stream.kind != E57Stream::Kind::integer) {
    const char* from = pending.bytes.data() + pending.bit / 8;
    const size_t size = size_t(stream.bits / 8);
    for (size_t k = 0; k < count; k++, from += size)
      to[k] = size == 4 ? double(number_at<float>(from)) : number_at<double>(from);
    pending.bit += count * uint64_t(stream.bits);
    return;
  }
  // Numbers follow one another without gaps, the lowest bit first; up to 9 bytes hold one.
  const uint64_t mask = stream.bits == 64 ? ~uint64_t(0) : (uint64_t(1) << stream.bits) - 1;
  for (size_t k = 0; k < count; k++, pending.bit += uint64_t(stream.bits)) {
    const size_t first = size_t(pending.bit / 8), shift = size_t(pending.bit % 8);
    const size_t bytes = (shift + size_t(stream.bits) + 7) / 8;
    uint64_t word = 0;
    const size_t whole = std::min<size_t>(8, pending.bytes.size() - first);
    std::memcpy(&word, pending.bytes.data() + first, whole);
    word >>= shift;
    if (bytes == 9) word |= uint64_t(uint8_t(pending.bytes[first + 8])) << (64 - shift);
    // Differences wrap as unsigned numbers do.
    const int64_t value = int64_t(uint64_t(stream.low) + (word & mask));
    to[k] = double(value) * stream.scale + stream.offset;
  }
}

size_t E57Section::read(size_t most, std::vector<std::vector<double>>& values) {
  const auto ready = [&] {
    uint64_t count = std::min<uint64_t>(most, left_);
    for (size_t i = 0; i < pending_.size(); i++)
      if (pending_[i].is_wanted) count = std::min(count, available(i));
    return size_t(count);
  };
  if (left_ == 0) return 0;
  while (ready() == 0) read_packet();
  const size_t count = ready();
  values.resize(pending_.size());
  for (size_t i = 0; i < pending_.size(); i++) {
    values[i].resize(pending_[i].is_wanted ? count : 0);
    if (pending_[i].is_wanted) decode(i, count, values[i].data());
  }
  left_ -= count;
  return count;
}

}  // namespace wellspring::scan
