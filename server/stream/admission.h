// SPDX-License-Identifier: Apache-2.0
// Limits how much of the server one address may have, and decides who is let in when places are
// short. Keeps counts alone: no sockets, time is an argument (seconds of a clock that does not run
// backwards). Every call may come from any thread.
//
// - Strangers share all places but a reserve, which is for trusted addresses: health checks and
//   kiosks get in whatever strangers do. Trusted addresses have no limits of their own.
// - A connection waits from its start until its request is whole, from one request to the next, and
//   as a WebSocket until its first message. If places are short, in all or for one address, the
//   stranger's connection that has waited longest makes place for the newcomer.
// - A proxy's connections are not counted by address: the requests that it forwards are.
// - A flood from many addresses is bounded in all: requests of strangers beyond the bound are
//   refused, and WebSockets that say more than a page does are closed, until the flood ebbs; no new
//   one opens meanwhile.
#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <unordered_map>

#include "base/clock.h"
#include "stream/address.h"

namespace wellspring::stream {

// Holds limits; the defaults let forty visitors in who come at once from one address, as a school
// class does: each browser opens up to six connections, asks for about thirty files, and sends up
// to 120 messages a second.
struct Limits {
  int connections = 4096;            // in all; beyond: 503
  int reserve = 64;                  // part of them for trusted addresses; at most a quarter
  int connections_an_address = 512;  // beyond a limit by address: 429
  double new_connections_a_second = 50, new_connections_at_once = 600;
  int websockets_an_address = 128;
  double requests_a_second = 100, requests_at_once = 3000;  // HTTP
  double frames_a_second = 8000, frames_at_once = 16000;    // sum of an address's WebSockets
  // These sum all WebSockets, too; a value of JSON that was read counts as value_bytes, so these
  // bound reading, too.
  double bytes_a_second = 2.5e6, bytes_at_once = 5e6;
  // The rest bounds all strangers together: three hundred first loads at once, two hundred who
  // walk. More than two hundred walkers are no flood, as each of them says no more than a page.
  double all_requests_a_second = 1000, all_requests_at_once = 10000;
  double all_frames_a_second = 20000, all_frames_at_once = 40000;
  double all_bytes_a_second = 8e6, all_bytes_at_once = 16e6;
};

inline constexpr double value_bytes = 16;  // bytes that take about as long to read as one value

// Counts what a WebSocket has received.
struct WireInput {
  double frames = 0, bytes = 0;
};

enum class Standing : uint8_t { stranger, proxy, trusted };

class Admission {
 public:
  explicit Admission(const Limits& limits);

  enum class Answer : uint8_t { welcome, full, too_many };
  struct Entry {
    Answer answer = Answer::welcome;
    std::optional<uint64_t> drop;  // the connection that makes place; the caller ends it
    bool reserved = false;         // the connection has a place of the reserve
  };
  // Notes a connection that begins, and waits. `id`: never used before. A connection that is not
  // welcome is not kept.
  Entry enter(uint64_t id, const Address& from, Standing standing, double now);
  void leave(uint64_t id);  // also called for a connection that is not kept
  void begin_waiting(uint64_t id);
  void end_waiting(uint64_t id);

  // Says whether an amount was taken, or is too much for this address, or for all together.
  enum class Taken : uint8_t { yes, too_many, too_many_in_all };
  Taken take_request(const Address& from, double now);
  // `modest`: the WebSocket says no more than a page does, so it is not closed for others' sake.
  Taken take_input(const Address& from, const WireInput& input, bool modest, double now);
  Taken open_websocket(const Address& from, double now);
  void close_websocket(const Address& from);

  size_t connections() const;
  size_t addresses() const;  // number of remembered addresses

 private:
  struct Place {
    Address part;
    Standing standing = Standing::stranger;
    uint64_t waits = 0;  // number in the queue; 0: it does not wait
  };
  struct Guest {  // counts of one address
    int connections = 0, websockets = 0;
    std::set<uint64_t> waiting;  // numbers in the queue
    RateBound new_connections, requests, frames, bytes;
  };
  Guest& guest(const Address& part);
  std::optional<uint64_t> take_oldest(const std::set<uint64_t>& numbers);
  std::optional<uint64_t> take_oldest();
  void stop_waiting(Place& place);

  const Limits limits_;
  const size_t reserve_;
  mutable std::mutex mutex_;
  std::unordered_map<uint64_t, Place> places_;
  // Waiting strangers' connections, oldest first: number to id.
  std::map<uint64_t, uint64_t> queue_;
  std::map<Address, Guest> guests_;
  RateBound all_requests_, all_frames_, all_bytes_;
  uint64_t next_number_ = 1;
};

}  // namespace wellspring::stream
