// SPDX-License-Identifier: Apache-2.0
#include "workers/jobs/job_message.h"

#include <algorithm>
#include <utility>

#include "base/bytes.h"

namespace wellspring::workers {
namespace {

constexpr size_t most_name_bytes = 200, most_bytes = 1000 * 1000;
constexpr float longest_seconds = 1e8f;
constexpr uint32_t magic = 0x314a5357;  // "WSJ1"
enum class Kind : uint8_t { order = 1, task, event };

ByteWriter begin(Kind kind) {
  ByteWriter out;
  out.put(magic), out.put(kind);
  return out;
}

// Calls read(in) for what follows the beginning of a message of that kind.
template <class Read>
bool read_kind(std::string_view bytes, const MessageKey& key, Kind kind, const Read& read) {
  if (bytes.size() > most_bytes) return false;
  const std::optional<std::string_view> open = unseal(bytes, key);
  if (!open) return false;
  ByteReader in(*open);
  uint32_t found_magic = 0;
  Kind found{};
  in.take(found_magic), in.take(found);
  in.need(found_magic == magic && found == kind);
  read(in);
  return in.ended();
}

void take_job(ByteReader& in, std::string& job) {
  in.take_text(job, most_name_bytes);
  in.need(is_job_name(job));
}

}  // namespace

std::string write_job(const JobOrder& order, const MessageKey& key) {
  ByteWriter out = begin(Kind::order);
  for (const std::string* text : {&order.job, &order.version, &order.instructions})
    out.put_text(*text);
  out.put(order.inputs), out.put(order.shards);
  out.put(uint32_t(order.words.size()));
  for (const std::string& word : order.words) out.put_text(word);
  return seal(std::move(out).bytes(), key);
}

bool read_job(std::string_view bytes, const MessageKey& key, JobOrder& order) {
  order = {};
  return read_kind(bytes, key, Kind::order, [&](ByteReader& in) {
    take_job(in, order.job);
    in.take_text(order.version, most_name_bytes), in.take_text(order.instructions, most_name_bytes);
    in.take(order.inputs), in.take(order.shards);
    in.need(order.shards >= 1 && order.shards <= uint32_t(most_shards));
    order.words.resize(in.take_count(most_job_words, sizeof(uint32_t)));
    for (std::string& word : order.words) in.take_text(word, most_word_bytes);
    in.need(!order.words.empty());
  });
}

std::string write_job(const ShardTask& task, const MessageKey& key) {
  ByteWriter out = begin(Kind::task);
  out.put_text(task.job), out.put(task.shard), out.put(task.failures);
  return seal(std::move(out).bytes(), key);
}

bool read_job(std::string_view bytes, const MessageKey& key, ShardTask& task) {
  task = {};
  return read_kind(bytes, key, Kind::task, [&](ByteReader& in) {
    take_job(in, task.job);
    in.take(task.shard), in.take(task.failures);
    in.need(task.shard < uint32_t(most_shards));
  });
}

std::string write_job(const JobEvent& event, const MessageKey& key) {
  ByteWriter out = begin(Kind::event);
  out.put_text(event.job), out.put(event.shard), out.put(event.news);
  out.put(event.place), out.put(event.delivery), out.put(event.share);
  out.put_text(event.worker);
  out.put_text(std::string_view(event.reason).substr(0, most_reason_bytes));
  out.put(event.seconds), out.put(uint32_t(event.files.size()));
  for (const ShardFile& file : event.files)
    out.put_text(file.name), out.put(file.digest), out.put(file.size);
  return seal(std::move(out).bytes(), key);
}

bool read_job(std::string_view bytes, const MessageKey& key, JobEvent& event) {
  event = {};
  return read_kind(bytes, key, Kind::event, [&](ByteReader& in) {
    take_job(in, event.job);
    in.take(event.shard), in.take(event.news);
    in.take(event.place), in.take(event.delivery), in.take(event.share);
    in.take_text(event.worker, most_name_bytes), in.take_text(event.reason, most_reason_bytes);
    in.take(event.seconds);
    in.need(event.shard < uint32_t(most_shards) && int(event.news) < job_news && event.share >= 0 &&
            event.share <= 1 && event.seconds >= 0 && event.seconds <= longest_seconds);
    event.files.resize(in.take_count(most_shard_files, 2 * sizeof(uint32_t)));
    for (ShardFile& file : event.files) {
      in.take_text(file.name, most_name_bytes), in.take(file.digest), in.take(file.size);
      in.need(is_file_name(file.name));
      if (!in.good()) return;
    }
  });
}

}  // namespace wellspring::workers
