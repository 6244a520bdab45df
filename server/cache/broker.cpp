// SPDX-License-Identifier: Apache-2.0
#include "cache/broker.h"

#include <algorithm>
#include <oneapi/tbb/task_arena.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "cache/point_cache.h"

namespace wellspring::cache {

Broker::Broker(const BrokerSettings& settings) : settings_(settings) {
  settings_.piece = std::max(settings_.piece, 1);
}

void Broker::ask(const View& view, const TraceJob& order, std::span<const Request> requests) {
  stats_.asked += requests.size();
  stats_.dropped += uint64_t(waiting_);
  pieces_.clear();
  waiting_ = 0;
  if (requests.empty()) return;
  asks_++;
  size_t size = size_t(settings_.piece), n = (requests.size() + size - 1) / size,
         step = golden_step(n);
  for (size_t i = 0, at = 0; i < n; i++, at = (at + step) % n) {
    std::span<const Request> part =
        requests.subspan(at * size, std::min(size, requests.size() - at * size));
    if (waiting_ + int(part.size()) > settings_.most_waiting) {
      stats_.dropped += part.size();
      continue;
    }
    waiting_ += int(part.size());
    pieces_.push_back({++pieces_made_, asks_, era_, view, order, {part.begin(), part.end()}});
  }
}

std::optional<Piece> Broker::take() {
  if (pieces_.empty()) return std::nullopt;
  Piece piece = std::move(pieces_.front());
  pieces_.pop_front();
  int count = int(piece.requests.size());
  waiting_ -= count;
  being_traced_ += count;
  traced_.push_back({piece.number, count});
  while (being_traced_ > settings_.most_traced && traced_.size() > 1) {
    being_traced_ -= traced_.front().requests;
    stats_.lost += uint64_t(traced_.front().requests);
    traced_.pop_front();
  }
  return piece;
}

bool Broker::answer(Answer answer) {
  auto found = std::find_if(traced_.begin(), traced_.end(), [&](const Traced& traced) {
    return traced.number == answer.piece.number;
  });
  int count = int(answer.piece.requests.size());
  bool right = found != traced_.end() && answer.piece.era == era_ && count == found->requests &&
               answer.samples.size() == answer.piece.requests.size();
  if (!right) {
    stats_.refused += answer.samples.size();
    return false;
  }
  being_traced_ -= count;
  traced_.erase(found);
  stats_.answered += uint64_t(count);
  uncollected_ += count;
  answers_.push_back(std::move(answer));
  while (uncollected_ > settings_.most_answered && answers_.size() > 1) {
    int oldest = int(answers_.front().samples.size());
    uncollected_ -= oldest;
    stats_.lost += uint64_t(oldest);
    answers_.pop_front();
  }
  return true;
}

std::vector<Answer> Broker::collect() {
  std::vector<Answer> all(std::make_move_iterator(answers_.begin()),
                          std::make_move_iterator(answers_.end()));
  answers_.clear();
  uncollected_ = 0;
  std::sort(all.begin(), all.end(),
            [](const Answer& a, const Answer& b) { return a.piece.number < b.piece.number; });
  return all;
}

void Broker::forget() {
  era_++;
  stats_.dropped += uint64_t(waiting_);
  stats_.lost += uint64_t(being_traced_) + uint64_t(uncollected_);
  pieces_.clear();
  traced_.clear();
  answers_.clear();
  waiting_ = being_traced_ = uncollected_ = 0;
}

size_t Broker::memory_bytes() const {
  size_t sum = traced_.size() * sizeof(Traced);
  for (const Piece& piece : pieces_) sum += sizeof piece + bytes_of(piece.requests);
  for (const Answer& answer : answers_)
    sum += sizeof answer + bytes_of(answer.piece.requests, answer.samples);
  return sum;
}

void follow_meshes(const World& world, std::span<Sample> samples) {
  for (Sample& sample : samples)
    if (sample.flags & sample_moving)
      find_on_mesh(world, sample.instance, sample.triangle, sample.barycentric, sample.position,
                   sample.normal);
}

int land(std::span<const Answer> answers, const World& world, uint64_t pose, RenderCache& cache) {
  std::vector<Request> requests;
  std::vector<Sample> samples;
  int landed = 0;
  for (size_t i = 0; i < answers.size();) {
    const Piece& first = answers[i].piece;
    requests.clear();
    samples.clear();
    for (; i < answers.size() && answers[i].piece.asked == first.asked; i++) {
      const Answer& answer = answers[i];
      size_t before = samples.size();
      requests.insert(requests.end(), answer.piece.requests.begin(), answer.piece.requests.end());
      samples.insert(samples.end(), answer.samples.begin(), answer.samples.end());
      if (answer.pose != pose) follow_meshes(world, std::span(samples).subspan(before));
    }
    cache.remember(first.view, requests, samples);
    landed += int(samples.size());
  }
  return landed;
}

namespace {

void trace_piece(const Piece& piece, const World& world, const Lights& lights,
                 std::vector<Sample>& samples) {
  const Technique& technique = *piece.order.technique;
  samples.resize(piece.requests.size());
  if (technique.trace_many) {
    technique.trace_many(world, lights, piece.order.transport, piece.requests, samples);
    return;
  }
  for (size_t i = 0; i < samples.size(); i++)
    samples[i] = technique.trace(world, lights, piece.order.transport, piece.requests[i]);
}

}  // namespace

size_t trace_waiting(std::span<Broker* const> brokers, const World& world, const Lights& lights,
                     uint64_t pose, double until, std::mutex& guard) {
  size_t turn = 0, answered = 0;
  auto take = [&](Broker*& from) {
    std::lock_guard lock(guard);
    for (size_t i = 0; i < brokers.size(); i++) {
      from = brokers[turn++ % brokers.size()];
      if (std::optional<Piece> piece = from->take()) return piece;
    }
    return std::optional<Piece>();
  };
  parallel_for(oneapi::tbb::this_task_arena::max_concurrency(), [&](int) {
    while (seconds_now() < until) {
      help_priority();
      Broker* from = nullptr;
      std::optional<Piece> piece = take(from);
      if (!piece) return;
      Answer answer{std::move(*piece), pose, {}};
      trace_piece(answer.piece, world, lights, answer.samples);
      std::lock_guard lock(guard);
      size_t count = answer.samples.size();
      answered += from->answer(std::move(answer)) ? count : 0;
    }
  });
  return answered;
}

}  // namespace wellspring::cache
