// SPDX-License-Identifier: Apache-2.0
#include "cache/trace_waiting.h"

#include <oneapi/tbb/task_arena.h>

#include "base/clock.h"
#include "base/parallel.h"

namespace wellspring::cache {
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
