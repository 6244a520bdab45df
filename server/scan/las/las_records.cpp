// SPDX-License-Identifier: Apache-2.0
#include "scan/las/las_records.h"

#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <oneapi/tbb/info.h>
#include <utility>

#include "base/load_error.h"
#include "base/parallel.h"
#include "scan/las/las_bytes.h"
#include "scan/las/laz_chunks.h"

namespace wellspring::scan {
namespace {

// Chunks are decoded in pieces of so many bytes, so that a chunk that promises many points takes
// little memory.
constexpr size_t most_piece_bytes = size_t(4) << 20;
constexpr uint16_t laszip_record = 22204;

class PlainRecords : public LasRecords {
 public:
  PlainRecords(std::span<const uint8_t> bytes, size_t record_bytes)
      : left_(bytes), record_bytes_(record_bytes) {}
  std::span<const uint8_t> read(size_t most) override {
    const size_t count = std::min(most, left_.size() / record_bytes_);
    const std::span<const uint8_t> read = left_.first(count * record_bytes_);
    left_ = left_.subspan(read.size());
    return read;
  }

 private:
  std::span<const uint8_t> left_;
  size_t record_bytes_;
};

// Decodes the beginnings of as many chunks at once as there are cores, and of each the rest when
// its turn has come.
class PackedRecords : public LasRecords {
 public:
  PackedRecords(std::string file, std::span<const uint8_t> bytes, LazLayout layout,
                std::vector<LazChunk> chunks)
      : file_(std::move(file)),
        bytes_(bytes),
        layout_(std::move(layout)),
        chunks_(std::move(chunks)),
        record_bytes_(layout_.record_bytes()),
        at_once_(size_t(std::max(1, oneapi::tbb::info::default_concurrency()))) {}

  std::span<const uint8_t> read(size_t most) override {
    if (most == 0) return {};
    while (given_ == piece().size()) {
      if (!pieces_.empty() && pieces_[current_].error) throw LoadError(*pieces_[current_].error);
      if (!pieces_.empty() && pieces_[current_].decoder->left() > 0) {
        decode(pieces_[current_]);
      } else if (current_ + 1 < pieces_.size()) {
        pieces_[current_++] = {};
      } else if (next_ == chunks_.size()) {
        return {};
      } else {
        decode_next();
      }
      given_ = 0;
    }
    const size_t size = std::min((piece().size() - given_) / record_bytes_, most) * record_bytes_;
    given_ += size;
    return piece().subspan(given_ - size, size);
  }

 private:
  struct Piece {
    std::unique_ptr<LazChunkDecoder> decoder;
    std::vector<uint8_t> records;
    std::optional<LoadError> error;
  };

  std::span<const uint8_t> piece() const {
    if (pieces_.empty()) return {};
    return pieces_[current_].records;
  }

  // Bodies of parallel loops must not throw.
  void decode(Piece& piece) const {
    try {
      const size_t most = std::max<size_t>(most_piece_bytes / record_bytes_, 1);
      const size_t count = size_t(std::min<uint64_t>(most, piece.decoder->left()));
      piece.records.resize(count * record_bytes_);
      piece.decoder->read(piece.records.data(), count);
    } catch (const LoadError& error) {
      piece.error = error;
      piece.records.clear();
    }
  }

  void decode_next() {
    const size_t count = std::min(at_once_, chunks_.size() - next_);
    pieces_.clear();
    pieces_.resize(count);
    current_ = 0;
    parallel_each(int(count), [&](int i) {
      Piece& piece = pieces_[size_t(i)];
      const size_t index = next_ + size_t(i);
      const LazChunk& chunk = chunks_[index];
      try {
        piece.decoder = std::make_unique<LazChunkDecoder>(
            file_, fmt::format("chunk {} at byte {}", index, chunk.begin), layout_,
            bytes_.subspan(chunk.begin, chunk.end - chunk.begin), chunk.points);
        decode(piece);
      } catch (const LoadError& error) {
        piece.error = error;
      }
    });
    next_ += count;
  }

  std::string file_;
  std::span<const uint8_t> bytes_;
  LazLayout layout_;
  std::vector<LazChunk> chunks_;
  size_t record_bytes_, at_once_;
  size_t next_ = 0;  // chunk that no piece belongs to yet
  std::vector<Piece> pieces_;
  size_t current_ = 0, given_ = 0;  // piece, and the bytes of it that were returned
};

void note_missing(LasHeader& header, uint64_t there) {
  if (there < header.points)
    header.notices.push_back(
        fmt::format("The header promises {} points, of which {} are there.", header.points, there));
}

}  // namespace

struct LasFile::Bytes {
  MappedFile file;
};

LasFile::LasFile(const std::string& file) : bytes_(new Bytes{MappedFile(file)}) {
  const std::span<const uint8_t> bytes = bytes_->file.bytes();
  header_ = load_las_header(file, bytes);
  if (!header_.is_compressed) {
    const uint64_t begin = std::min<uint64_t>(header_.points_begin, bytes.size());
    const uint64_t there = std::min(header_.points, (bytes.size() - begin) / header_.record_bytes);
    note_missing(header_, there);
    records_ = std::make_unique<PlainRecords>(bytes.subspan(begin, there * header_.record_bytes),
                                              header_.record_bytes);
    return;
  }
  const LasRecord* record = header_.find("laszip encoded", laszip_record);
  if (!record) throw LoadError(file, "", "is packed, but has no record of LASzip");
  LazLayout layout = load_laz_layout(file, record->bytes);
  if (layout.record_bytes() != header_.record_bytes)
    throw LoadError(file, "record of LASzip",
                    fmt::format("gives points {} bytes, the header {}", layout.record_bytes(),
                                header_.record_bytes));
  if (layout.is_layered != (header_.format >= 6))
    throw LoadError(file, "record of LASzip", "does not fit the format of points");
  std::vector<LazChunk> chunks =
      load_laz_chunks(file, bytes, header_.points_begin, header_.points, layout);
  uint64_t there = 0;
  for (const LazChunk& chunk : chunks) there += chunk.points;
  note_missing(header_, there);
  records_ = std::make_unique<PackedRecords>(file, bytes, std::move(layout), std::move(chunks));
}

LasFile::~LasFile() = default;

}  // namespace wellspring::scan
