// SPDX-License-Identifier: Apache-2.0
// Says which part of divided work a program does, by the words i/N of its command line
// (docs/jobs.md).
#pragma once
#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/layers.h"

namespace wellspring {

inline constexpr int most_shards = 4096;

struct Shard {
  int index = 0, count = 1;  // index from 0
  bool is_whole() const { return count == 1; }
  // Says whether a piece belongs to it if every N-th does.
  bool has(size_t piece) const { return piece % size_t(count) == size_t(index); }
  // Returns the first piece of its stretch and the one after its last: shards differ by one piece.
  std::pair<size_t, size_t> stretch(size_t pieces) const {
    const auto begin = [&](int i) { return pieces * size_t(i) / size_t(count); };
    return {begin(index), begin(index + 1)};
  }
};

// Reads "i/N". i counts from 1, or from 0, as array jobs of batch systems do: 0 and N are the same
// shard. Returns nothing if the text is something else.
inline std::optional<Shard> parse_shard(std::string_view text) {
  const char *begin = text.data(), *end = begin + text.size();
  int shard = 0, shards = 0;
  const auto first = std::from_chars(begin, end, shard);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '/') return {};
  const auto second = std::from_chars(first.ptr + 1, end, shards);
  if (second.ec != std::errc() || second.ptr != end) return {};
  if (shards < 1 || shards > most_shards || shard < 0 || shard > shards) return {};
  return Shard{(shard + shards - 1) % shards, shards};
}

inline std::string to_text(const Shard& shard) {
  return std::to_string(shard.index + 1) + "/" + std::to_string(shard.count);
}

}  // namespace wellspring
