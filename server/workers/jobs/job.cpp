// SPDX-License-Identifier: Apache-2.0
#include "workers/jobs/job.h"

#include <algorithm>
#include <utility>

namespace wellspring::workers {
namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
}

auto rank(const JobEvent& event) {
  return std::tuple(event.news == JobNews::done, event.place, event.delivery, event.news,
                    event.share);
}

}  // namespace

const char* to_word(JobNews news) {
  constexpr const char* words[job_news] = {"waits", "works", "refused", "failed", "dead", "done"};
  return words[size_t(news)];
}

bool is_later(const JobEvent& a, const JobEvent& b) { return rank(a) > rank(b); }

JobState::JobState(JobOrder from) : order(std::move(from)) {
  shards.resize(order.shards);
  for (uint32_t i = 0; i < order.shards; i++) shards[i].job = order.job, shards[i].shard = i;
}

void JobState::take(const JobEvent& event) {
  if (event.job != order.job || event.shard >= shards.size()) return;
  if (is_later(event, shards[event.shard])) shards[event.shard] = event;
}

size_t JobState::count(JobNews news) const {
  return size_t(std::ranges::count(shards, news, &JobEvent::news));
}

double JobState::share() const {
  double sum = 0;
  for (const JobEvent& shard : shards)
    sum += shard.news == JobNews::done ? 1 : shard.news == JobNews::works ? double(shard.share) : 0;
  return sum / double(std::max<size_t>(shards.size(), 1));
}

bool is_job_name(std::string_view name) {
  return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, is_plain);
}

bool is_file_name(std::string_view name) {
  return !name.empty() && name.size() <= 200 && name[0] != '.' &&
         std::ranges::all_of(name, [](char c) { return is_plain(c) || c == '.' || c == '_'; });
}

}  // namespace wellspring::workers
