// SPDX-License-Identifier: Apache-2.0
// Stands between a cache, which asks, and whoever traces (Walter 1999, section 2: display and
// renderer run apart). Requests go out in pieces that say all a worker has to know; answers come
// back whenever they are ready, in any order, or never. A sample says at which place it ended, on
// which object and, on a moving mesh, on which triangle; with the view that asked and the pose of
// the world that was traced it finds its place frames later. A broker has neither threads nor a
// clock: whoever shares it with other threads guards it.
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

// Says what to trace, and how.
struct TraceJob {
  const Technique* technique = nullptr;  // one without passes over a picture
  TransportSettings transport;
};

struct Piece {
  uint64_t number = 0;  // number among this broker's pieces; grows
  uint64_t asked = 0;   // number of the ask(); its pieces share it
  uint64_t era = 0;     // number of forget() calls before
  View view;            // view that asked
  TraceJob order;
  std::vector<Request> requests;
};

struct Answer {
  Piece piece;                  // piece as it was taken
  uint64_t pose = 0;            // pose of the traced world, as the application counts its commits
  std::vector<Sample> samples;  // one sample a request
};

// Bounds are numbers of requests, so that memory is bounded: those that wait, are being traced, or
// are answered and not collected. Beyond `most_traced` the oldest pieces count as lost: their
// worker is gone.
struct BrokerSettings {
  int piece = 64;
  int most_waiting = 16384, most_traced = 16384, most_answered = 16384;
};

// Counts requests since the beginning.
struct BrokerStats {
  uint64_t asked = 0;
  uint64_t dropped = 0;   // never taken: newer ones took their place, or there were too many
  uint64_t answered = 0;  // answered in time
  uint64_t refused = 0;   // answers refused: doubled, of a forgotten era, given up, incomplete
  uint64_t lost = 0;      // given up, or never collected
};

class Broker {
 public:
  explicit Broker(const BrokerSettings& settings = {});

  // The cache's side. ask() replaces the requests that nobody has taken yet: the newest view
  // counts, and its requests include what is still wanted of the older ones. Pieces go out in an
  // order that spreads them over the picture, so that the requests that are not reached are missing
  // everywhere alike.
  void ask(const View& view, const TraceJob& order, std::span<const Request> requests);
  // Returns all answers since the last call, in the order that they were asked for.
  std::vector<Answer> collect();
  // Drops all pieces and refuses answers to them from now on, since the requests have lost their
  // meaning (another exhibit, another light). A new view alone is no reason.
  void forget();

  // The worker's side.
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

// Puts samples on moving meshes where their triangles are in `world`.
void follow_meshes(const World& world, std::span<Sample> samples);

// Enters answers into the cache, to be called between move_points() and project(). Samples on
// moving meshes are put where their triangles are in `world`, whose pose is `pose`. Returns how
// many samples were entered.
int land(std::span<const Answer> answers, const World& world, uint64_t pose, RenderCache& cache);

// Traces on all cores, as long as the caller has time. Others may take pieces of the same brokers
// meanwhile only if they share the guard.

// Traces waiting requests, a piece of each broker in turn, until none is left or it is later than
// `until` (as seconds_now(); a piece that was begun is finished). Returns how many samples were
// answered.
size_t trace_waiting(std::span<Broker* const> brokers, const World& world, const Lights& lights,
                     uint64_t pose, double until, std::mutex& guard);

}  // namespace wellspring::cache
