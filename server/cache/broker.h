// SPDX-License-Identifier: Apache-2.0
// Between a cache, which asks, and whoever traces (Walter 1999, section 2: display and renderer run
// apart). Requests go out in pieces that say all a worker has to know; answers come back whenever
// they are ready, in any order, or never. A sample says where it landed, on which object and, of
// what moves, on which triangle; with the view that asked and the pose of the world that was traced
// it finds its place frames later. A value without threads or clock: whoever shares it with
// other threads guards it.
#pragma once
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "cache/cache.h"
#include "light/sample/lights.h"
#include "light/technique/technique.h"

namespace wellspring::cache {

// What to trace, and how.
struct TraceJob {
  const Technique* technique = nullptr;  // without passes over a picture
  TransportSettings transport;
};

struct Piece {
  uint64_t number = 0;  // of this broker's pieces; grows
  uint64_t asked = 0;   // pieces of one ask() share it
  uint64_t era = 0;     // see forget()
  View view;            // that asked
  TraceJob order;
  std::vector<Request> requests;
};

struct Answer {
  Piece piece;        // as it was taken
  uint64_t pose = 0;  // of the world that was traced, as the application counts its commits
  std::vector<Sample> samples;  // one a request
};

// Bounds are of requests, so that memory is bounded: what waits, is being traced, or is answered
// and not collected. Beyond `most_traced` the oldest pieces count as lost: their worker is gone.
struct BrokerSettings {
  int piece = 64;
  int most_waiting = 16384, most_traced = 16384, most_answered = 16384;
};

// Requests, since the beginning.
struct BrokerStats {
  uint64_t asked = 0;
  uint64_t dropped = 0;   // never taken: newer ones took their place, or they were too many
  uint64_t answered = 0;  // in time
  uint64_t refused = 0;   // answers: doubled, of a forgotten era, given up, incomplete
  uint64_t lost = 0;      // given up, or collected by nobody
};

class Broker {
 public:
  explicit Broker(const BrokerSettings& settings = {});

  // The cache's side. ask() replaces what nobody has taken yet: the newest view counts, and what is
  // still wanted is in it again. Pieces go out in an order that spreads them over the picture, so
  // that whatever is not reached is missed everywhere alike.
  void ask(const View& view, const TraceJob& order, std::span<const Request> requests);
  // Everything answered since the last call, in the order it was asked for.
  std::vector<Answer> collect();
  // What was asked so far has no meaning any more (another exhibit, another light): pieces are
  // dropped, and answers to them will be refused. A new view alone is no reason.
  void forget();

  // A worker's side.
  std::optional<Piece> take();
  bool answer(Answer answer);  // false: refused

  int waiting() const { return waiting_; }  // requests
  size_t memory_bytes() const;
  const BrokerStats& stats() const { return stats_; }

 private:
  struct Traced {
    uint64_t number = 0;
    int requests = 0;
  };
  BrokerSettings settings_;
  BrokerStats stats_;
  std::deque<Piece> pieces_;
  std::deque<Traced> traced_;
  std::deque<Answer> answers_;
  int waiting_ = 0, being_traced_ = 0, uncollected_ = 0;
  uint64_t pieces_made_ = 0, asks_ = 0, era_ = 0;
};

// Puts samples of what moves where their triangles are in `world`.
void follow_meshes(const World& world, std::span<Sample> samples);

// Enters answers into the cache, to be called between move_points() and project(). Samples of what
// moves are put where their triangles are in `world`, whose pose is `pose`. Returns how many
// samples.
int land(std::span<const Answer> answers, const World& world, uint64_t pose, RenderCache& cache);

// The worker that is always there: all cores, for as long as the caller has time. Others may take
// pieces of the same brokers meanwhile only if they share its guard.

// Traces what waits, a piece of each broker in turn, until nothing does or it is later than `until`
// (as seconds_now(); a piece that was begun is finished). Returns how many samples were answered.
size_t trace_waiting(std::span<Broker* const> brokers, const World& world, const Lights& lights,
                     uint64_t pose, double until, std::mutex& guard);

}  // namespace wellspring::cache
