// SPDX-License-Identifier: Apache-2.0
#include "workers/jobs/line.h"

#include <algorithm>
#include <condition_variable>
#include <filesystem>
#include <fmt/core.h>
#include <fstream>
#include <mutex>
#include <set>
#include <sodium.h>
#include <zstd.h>

#include "base/log.h"
#include "workers/connect.h"
#include "workers/jobs/job_message.h"

namespace wellspring::workers {
namespace {

constexpr const char *queue_stream = "WELLSPRING_JOBS_QUEUE", *news_stream = "WELLSPRING_JOBS",
                     *file_stream = "WELLSPRING_JOBS_FILES", *takers = "takers";
constexpr std::chrono::milliseconds life_every{1500}, try_every{500};
constexpr int64_t second_ns = 1'000'000'000, forgotten_after = 6 * second_ns;
constexpr int64_t answer_ms = 5000, take_ms = 1000;
constexpr size_t part_bytes = 256 * 1024;
constexpr uint64_t most_file_bytes = uint64_t(1) << 40;

struct DropMessage {
  void operator()(natsMsg* message) const { natsMsg_Destroy(message); }
};
using Message = std::unique_ptr<natsMsg, DropMessage>;

std::string queue_subject(const ShardTask& task) {
  return fmt::format("wellspring.jobs.queue.{}.{}", task.job, task.shard);
}
std::string hex(const FileDigest& digest) {
  std::string text;
  for (const uint8_t byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}
std::string part_subject(const FileDigest& digest, uint64_t part) {
  return fmt::format("wellspring.jobs.files.{}.{}", hex(digest), part);
}

std::string_view text_of(natsMsg* message) {
  return {natsMsg_GetData(message), size_t(natsMsg_GetDataLength(message))};
}

// Says whether it may go better when the server is there again.
bool is_for_want_of_server(natsStatus status, int code) {
  return code == 0 && (status == NATS_TIMEOUT || status == NATS_CONNECTION_CLOSED ||
                       status == NATS_CONNECTION_DISCONNECTED || status == NATS_NO_SERVER ||
                       status == NATS_NO_RESPONDERS || status == NATS_IO_ERROR);
}

// Calls visit(bytes) for parts of a file.
template <class Visit>
void for_each_part(const std::string& path, const Visit& visit) {
  std::ifstream in(path, std::ios::binary);
  std::string part(part_bytes, 0);
  while (in) {
    in.read(part.data(), std::streamsize(part.size()));
    if (in.gcount() > 0) visit(std::string_view(part).substr(0, size_t(in.gcount())));
  }
  if (!in.eof()) throw LineError(path + ": cannot be read");
}

class Digest {
 public:
  Digest() { crypto_generichash_init(&state_, nullptr, 0, sizeof(FileDigest)); }
  void add(std::string_view bytes) {
    crypto_generichash_update(&state_, reinterpret_cast<const uint8_t*>(bytes.data()),
                              bytes.size());
  }
  FileDigest end() {
    FileDigest digest;
    crypto_generichash_final(&state_, digest.data(), digest.size());
    return digest;
  }

 private:
  crypto_generichash_state state_;
};

}  // namespace

struct JobLine::Handles {
  ConnectOptions options;
  natsConnection* connection = nullptr;
  jsCtx* stream = nullptr;
  natsSubscription* takes = nullptr;
  ~Handles() {
    natsSubscription_Destroy(takes);
    jsCtx_Destroy(stream);
    natsConnection_Destroy(connection);
  }
};

// Calls until it goes well. `call` gives a natsStatus, and a jsErrCode.
void JobLine::need(const std::string& what, const std::function<int(int*)>& call) {
  for (bool told = false;;) {
    int code = 0;
    const auto status = natsStatus(call(&code));
    if (status == NATS_OK) return;
    if (is_for_want_of_server(status, code) && settings_.goes_on()) {
      if (!std::exchange(told, true))
        log::warn("{}: {}; it is tried again and again", what, natsStatus_GetText(status));
      std::this_thread::sleep_for(try_every);
      continue;
    }
    natsStatus last = NATS_OK;
    const char* said = code != 0 ? nats_GetLastError(&last) : nullptr;
    std::string why = said ? said : natsStatus_GetText(status);
    if (why.starts_with('(')) why.erase(0, why.find(": ") + 2);  // a line of the library's source
    if (why.find("maximum bytes") != std::string::npos)
      why += ": the store is full (--store), remove old jobs";
    if (status == NATS_NO_RESPONDERS || code == JSNotEnabledErr)
      why = "NATS runs without JetStream: start nats-server with -js";
    throw LineError(what + ": " + why);
  }
}

JobLine::JobLine(LineSettings settings)
    : settings_(std::move(settings)), nats_(std::make_unique<Handles>()) {
  nats_->options = make_options(settings_.channel);
  natsOptions_SetRetryOnFailedConnect(nats_->options.get(), false, nullptr, nullptr);
  natsOptions_DisableNoResponders(nats_->options.get(), false);
  natsOptions_SetDisconnectedCB(nats_->options.get(), nullptr, nullptr);  // need() tells it
  need(settings_.channel.url + ": no NATS server answers",
       [&](int*) { return natsConnection_Connect(&nats_->connection, nats_->options.get()); });
  jsOptions options;
  jsOptions_Init(&options);
  options.Wait = answer_ms;
  need("JetStream",
       [&](int*) { return natsConnection_JetStream(&nats_->stream, nats_->connection, &options); });
  prepare();
}

JobLine::~JobLine() = default;

void JobLine::prepare() {
  const auto make = [&](const char* name, const char* subjects, auto&& set) {
    jsStreamConfig config;
    jsStreamConfig_Init(&config);
    config.Name = name, config.Subjects = &subjects, config.SubjectsLen = 1;
    config.Storage = js_FileStorage;
    set(config);
    need(fmt::format("the stream {} cannot be made", name), [&](int* code) {
      jsErrCode error{};
      const natsStatus status = js_AddStream(nullptr, nats_->stream, &config, nullptr, &error);
      *code = error;
      return error == JSStreamNameExistErr ? NATS_OK : status;  // set otherwise by an operator
    });
  };
  make(queue_stream, "wellspring.jobs.queue.>",
       [](jsStreamConfig& config) { config.Retention = js_WorkQueuePolicy; });
  make(news_stream, "wellspring.jobs.news.>",
       [](jsStreamConfig& config) { config.MaxMsgsPerSubject = 1; });
  make(file_stream, "wellspring.jobs.files.>", [&](jsStreamConfig& config) {
    config.MaxMsgsPerSubject = 1, config.Discard = js_DiscardNew;
    config.MaxBytes = int64_t(settings_.store_gib * (1 << 30));
  });
  jsConsumerConfig config;
  jsConsumerConfig_Init(&config);
  config.Durable = takers, config.AckPolicy = js_AckExplicit, config.AckWait = forgotten_after;
  config.MaxDeliver = -1, config.MaxAckPending = most_shards;
  need("the queue cannot be made", [&](int* code) {
    jsErrCode error{};
    const natsStatus status =
        js_AddConsumer(nullptr, nats_->stream, queue_stream, &config, nullptr, &error);
    *code = error;
    return status;
  });
}

uint64_t JobLine::add(const ShardTask& task, const std::string& once) {
  const std::string subject = queue_subject(task), bytes = write_job(task, settings_.key);
  jsPubOptions options;
  jsPubOptions_Init(&options);
  options.MsgId = once.c_str();
  uint64_t place = 0;
  need("a shard cannot be queued", [&](int* code) {
    jsErrCode error{};
    jsPubAck* answer = nullptr;
    const natsStatus status = js_Publish(&answer, nats_->stream, subject.c_str(), bytes.data(),
                                         int(bytes.size()), &options, &error);
    *code = error;
    if (status == NATS_OK) place = answer->Sequence;
    jsPubAck_Destroy(answer);
    return status;
  });
  return place;
}

static void publish(jsCtx* stream, const std::string& subject, std::string_view bytes, int* code,
                    natsStatus& status) {
  jsErrCode error{};
  status = js_Publish(nullptr, stream, subject.c_str(), bytes.data(), int(bytes.size()), nullptr,
                      &error);
  *code = error;
}

void JobLine::tell(const JobOrder& order) {
  const std::string bytes = write_job(order, settings_.key);
  need("a job cannot be told", [&](int* code) {
    natsStatus status;
    publish(nats_->stream, fmt::format("wellspring.jobs.news.{}.order", order.job), bytes, code,
            status);
    return status;
  });
}

void JobLine::tell(const JobEvent& event) {
  const std::string bytes = write_job(event, settings_.key);
  const std::string subject =
      fmt::format("wellspring.jobs.news.{}.{}.{}", event.job, event.shard, to_word(event.news));
  need("news of a shard cannot be told", [&](int* code) {
    natsStatus status;
    publish(nats_->stream, subject, bytes, code, status);
    return status;
  });
}

namespace {

// Returns the subjects of a stream that match, with the number of messages in all.
std::set<std::string> subjects_of(natsStatus& status, jsCtx* stream, const char* name,
                                  const std::string& filter, int* code) {
  jsOptions options;
  jsOptions_Init(&options);
  options.Wait = answer_ms;
  options.Stream.Info.SubjectsFilter = filter.c_str();
  jsStreamInfo* info = nullptr;
  jsErrCode error{};
  status = js_GetStreamInfo(&info, stream, name, &options, &error);
  *code = error;
  std::set<std::string> found;
  if (status == NATS_OK && info->State.Subjects)
    for (int i = 0; i < info->State.Subjects->Count; i++)
      found.insert(info->State.Subjects->List[i].Subject);
  jsStreamInfo_Destroy(info);
  return found;
}

}  // namespace

std::vector<JobState> JobLine::read(const std::string& job) {
  const std::string filter = "wellspring.jobs.news." + (job.empty() ? ">" : job + ".>");
  std::vector<JobOrder> orders;
  std::vector<JobEvent> events;
  const auto keep = [&](std::string_view bytes) {
    JobOrder order;
    JobEvent event;
    if (read_job(bytes, settings_.key, order)) orders.push_back(std::move(order));
    else if (read_job(bytes, settings_.key, event)) events.push_back(std::move(event));
    else log::warn("what is told of a job is none, or sealed by another secret");
  };
  need("jobs cannot be read", [&](int* code) {
    orders.clear(), events.clear();
    natsStatus status;
    if (subjects_of(status, nats_->stream, news_stream, filter, code).empty()) return status;
    jsSubOptions options;
    jsSubOptions_Init(&options);
    options.Stream = news_stream, options.Ordered = true;
    natsSubscription* all = nullptr;
    jsErrCode error{};
    status = js_SubscribeSync(&all, nats_->stream, filter.c_str(), nullptr, &options, &error);
    *code = error;
    for (bool more = true; status == NATS_OK && more;) {
      natsMsg* message = nullptr;
      status = natsSubscription_NextMsg(&message, all, answer_ms);
      if (status != NATS_OK) break;
      const Message owned(message);
      jsMsgMetaData* data = nullptr;
      status = natsMsg_GetMetaData(&data, message);
      more = status == NATS_OK && data->NumPending > 0;
      jsMsgMetaData_Destroy(data);
      keep(text_of(message));
    }
    natsSubscription_Destroy(all);
    return status;
  });
  std::vector<JobState> states;
  std::ranges::sort(orders, {}, &JobOrder::job);
  for (JobOrder& order : orders) states.emplace_back(std::move(order));
  for (const JobEvent& event : events)
    for (JobState& state : states) state.take(event);
  return states;
}

void JobLine::remove(const JobState& job, const std::vector<JobState>& others) {
  const auto purge = [&](const char* name, const std::string& subject) {
    jsOptions options;
    jsOptions_Init(&options);
    options.Wait = answer_ms;
    options.Stream.Purge.Subject = subject.c_str();
    need("a job cannot be removed", [&](int* code) {
      jsErrCode error{};
      const natsStatus status = js_PurgeStream(nats_->stream, name, &options, &error);
      *code = error;
      return status;
    });
  };
  purge(queue_stream, fmt::format("wellspring.jobs.queue.{}.>", job.order.job));
  purge(news_stream, fmt::format("wellspring.jobs.news.{}.>", job.order.job));
  std::set<FileDigest> kept;
  for (const JobState& other : others)
    for (const JobEvent& shard : other.shards)
      for (const ShardFile& file : shard.files)
        if (other.order.job != job.order.job) kept.insert(file.digest);
  for (const JobEvent& shard : job.shards)
    for (const ShardFile& file : shard.files)
      if (kept.insert(file.digest).second)
        purge(file_stream, fmt::format("wellspring.jobs.files.{}.>", hex(file.digest)));
}

JobLine::Taken::Taken(void* message, ShardTask of, uint64_t place_, uint64_t delivery_)
    : task(std::move(of)), place(place_), delivery(delivery_), message_(message) {
  life_ = std::jthread([this](const std::stop_token& end) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any wake;
    while (!wake.wait_for(lock, end, life_every, [&] { return end.stop_requested(); }))
      natsMsg_InProgress(static_cast<natsMsg*>(message_), nullptr);
  });
}

JobLine::Taken::~Taken() {
  life_.request_stop();
  if (life_.joinable()) life_.join();
  natsMsg_Destroy(static_cast<natsMsg*>(message_));
}

void JobLine::Taken::end() {
  life_.request_stop();
  life_.join();
  natsMsg_Ack(static_cast<natsMsg*>(message_), nullptr);
}

std::unique_ptr<JobLine::Taken> JobLine::take() {
  jsErrCode error{};
  if (!nats_->takes) {
    jsSubOptions options;
    jsSubOptions_Init(&options);
    options.Stream = queue_stream, options.Consumer = takers;
    need("the queue cannot be asked", [&](int* code) {
      const natsStatus status =
          js_PullSubscribe(&nats_->takes, nats_->stream, "wellspring.jobs.queue.>", takers, nullptr,
                           &options, &error);
      *code = error;
      return status;
    });
  }
  natsMsgList list{};
  const natsStatus status = natsSubscription_Fetch(&list, nats_->takes, 1, take_ms, &error);
  if (status != NATS_OK || list.Count == 0) {
    natsMsgList_Destroy(&list);
    if (status != NATS_TIMEOUT) std::this_thread::sleep_for(try_every);
    return nullptr;
  }
  natsMsg* message = std::exchange(list.Msgs[0], nullptr);
  natsMsgList_Destroy(&list);
  jsMsgMetaData* data = nullptr;
  if (natsMsg_GetMetaData(&data, message) != NATS_OK) return natsMsg_Destroy(message), nullptr;
  const uint64_t place = data->Sequence.Stream, delivery = data->NumDelivered;
  jsMsgMetaData_Destroy(data);
  ShardTask task;
  const bool good = read_job(text_of(message), settings_.key, task);
  auto taken = std::make_unique<Taken>(message, std::move(task), place, delivery);
  if (good) return taken;
  log::warn("what waits in the queue is no shard, or sealed by another secret; it is dropped");
  taken->end();
  return nullptr;
}

ShardFile JobLine::put_file(const std::string& path, const std::string& name) {
  ShardFile file{name, {}, 0};
  Digest digest;
  for_each_part(path, [&](std::string_view part) { digest.add(part), file.size += part.size(); });
  file.digest = digest.end();
  std::set<std::string> there;
  need(name + " cannot be stored", [&](int* code) {
    natsStatus status;
    there = subjects_of(status, nats_->stream, file_stream,
                        fmt::format("wellspring.jobs.files.{}.*", hex(file.digest)), code);
    return status;
  });
  uint64_t number = 0;
  std::string packed(ZSTD_compressBound(part_bytes), 0);
  for_each_part(path, [&](std::string_view part) {
    const std::string subject = part_subject(file.digest, number++);
    if (there.contains(subject)) return;
    const size_t size = ZSTD_compress(packed.data(), packed.size(), part.data(), part.size(), 1);
    need(name + " cannot be stored", [&](int* code) {
      natsStatus status;
      publish(nats_->stream, subject, std::string_view(packed).substr(0, size), code, status);
      return status;
    });
  });
  return file;
}

void JobLine::get_file(const ShardFile& file, const std::string& path) {
  if (file.size > most_file_bytes) throw LineError(file.name + " is too large");
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  const std::string half = path + ".part";
  std::ofstream out(half, std::ios::binary | std::ios::trunc);
  Digest digest;
  std::string part(part_bytes, 0);
  uint64_t at = 0;
  for (uint64_t number = 0; at < file.size; number++) {
    const std::string subject = part_subject(file.digest, number);
    natsMsg* message = nullptr;
    need(file.name + " cannot be fetched", [&](int* code) {
      jsErrCode error{};
      const natsStatus status =
          js_GetLastMsg(&message, nats_->stream, file_stream, subject.c_str(), nullptr, &error);
      *code = error;
      return status;
    });
    const Message owned(message);
    const std::string_view packed = text_of(message);
    const size_t size = ZSTD_decompress(part.data(), part.size(), packed.data(), packed.size());
    if (ZSTD_isError(size) || size == 0) throw LineError(file.name + " is stored damaged");
    digest.add({part.data(), size});
    out.write(part.data(), std::streamsize(size));
    at += size;
  }
  out.close();
  if (!out) throw LineError(half + ": cannot be written: is the disk full?");
  if (at != file.size || digest.end() != file.digest)
    throw LineError(file.name + " is stored damaged");
  std::filesystem::rename(half, path);
}

}  // namespace wellspring::workers
