// SPDX-License-Identifier: Apache-2.0
// Defines what a server and its workers send one another: orders to trace requests, answers with
// samples or with the reason why there are none, calls and who answers them. All numbers are
// little-endian, floats go with all their bits. Whoever reads takes nothing for granted: lengths,
// counts and ranges are checked before a value exists. With a shared secret each message ends with
// a seal (HMAC-SHA-512/256, by libsodium), so that nobody else on the line gives orders or answers.
//
// Times are durations, never clocks: an order is worth answering so long after it has arrived.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "light/sample.h"
#include "light/transport_settings.h"
#include "workers/package/package.h"
#include "workers/report.h"
#include "workers/sealed.h"

namespace wellspring::workers {

inline constexpr size_t most_requests = 4096;              // number in an order
inline constexpr size_t most_state_bytes = 192 * 1024;     // size in an order
inline constexpr size_t most_message_bytes = 1000 * 1000;  // NATS takes 1 MiB
inline constexpr uint32_t longest_worth_ms = 60'000;       // TraceOrder::worth_ms

// Holds what has to be equal for both sides to find the same bits.
struct Sameness {
  std::string version;       // version of the program
  std::string instructions;  // instruction_set()
  uint64_t scene = 0;        // number of what stands and what can move
  uint64_t light = 0;  // number of the illumination maps on which walks end; 0: there are none
  bool operator==(const Sameness&) const = default;
};
// Returns the instructions that this program was compiled for and that its libraries choose here.
std::string instruction_set();

struct TraceOrder {
  uint64_t server = 0;    // number of the server's run, random
  uint64_t number = 0;    // number among that server's orders
  uint32_t worth_ms = 0;  // milliseconds after arrival for which an answer is worth having
  std::string exhibit;    // id
  Sameness same;
  // Other instructions, whose samples are others of the same light, will not do.
  bool exact = false;
  std::string technique;
  bool plain = false;  // diffuse light is traced, not told in multiples of the maps (Lights::maps)
  // Fields that techniques with passes over a picture read are not sent: these stay at home.
  TransportSettings transport;
  std::string state;              // state of the world (show/workers/world_state.h)
  std::vector<Request> requests;  // `pixel` and `resample` stay at home
};

struct TraceAnswer {
  uint64_t server = 0, number = 0;  // as in the order
  std::string worker;               // name
  Refusal refusal = Refusal::none;
  float waited = 0, traced = 0;  // seconds here before tracing began, and of tracing
  std::vector<Sample> samples;   // one for each request, unless refused
};

// Asks who is there, and tells the line's delay.
struct RollCall {
  uint64_t server = 0, number = 0;
};
struct CallAnswer {
  uint64_t server = 0, number = 0;
  std::string worker, version, instructions;
  uint32_t cores = 0;
};

std::string write_message(const TraceOrder& order, const MessageKey& key);
std::string write_message(const TraceAnswer& answer, const MessageKey& key);
std::string write_message(const RollCall& call, const MessageKey& key);
std::string write_message(const CallAnswer& answer, const MessageKey& key);
std::string write_message(const FileQuestion& question, const MessageKey& key);
std::string write_message(const FilePart& part, const MessageKey& key);

// Return false if the bytes are no such message: cut off, too long, out of range, or not sealed by
// the key. Samples are finite and in range by themselves; whether they fit their world, whoever
// asked knows (SampleBounds).
bool read_message(std::string_view bytes, const MessageKey& key, TraceOrder& order);
bool read_message(std::string_view bytes, const MessageKey& key, TraceAnswer& answer);
bool read_message(std::string_view bytes, const MessageKey& key, RollCall& call);
bool read_message(std::string_view bytes, const MessageKey& key, CallAnswer& answer);
bool read_message(std::string_view bytes, const MessageKey& key, FileQuestion& question);
bool read_message(std::string_view bytes, const MessageKey& key, FilePart& part);

// Returns whether the text can be a worker's name: 1 to 32 letters, digits, '-' and '_'.
bool is_worker_name(std::string_view name);
std::string default_worker_name();  // consists of this machine's name and the process's number

// Holds how large numbers in samples of a world may be.
struct SampleBounds {
  uint32_t objects = 0;
  std::vector<uint32_t> triangles;  // number of triangles of each instance
};
// Returns whether the samples can be answers to requests in such a world.
bool are_within(const std::vector<Sample>& samples, const SampleBounds& bounds);

}  // namespace wellspring::workers
