// SPDX-License-Identifier: Apache-2.0
// Knows a server's workers: calls them, gives them what a cache asks for as far as their measured
// pace allows (workers/budget.h), checks what they answer, and forgets what does not come in time
// or from whom nothing good comes. Nothing here waits, and without workers nothing is sent.
//
// Interactive Global Illumination (Wald et al. 2002, sections 5 and 6) keeps its clients busy the
// same way: small tasks on demand, a few ahead for the line's delay.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "base/worker.h"
#include "cache/broker.h"
#include "workers/budget.h"
#include "workers/channel.h"
#include "workers/message.h"
#include "workers/package/shelf.h"
#include "workers/report.h"
#include "workers/settings.h"

namespace wellspring::workers {

// Says what is the same for all requests of an errand.
struct Errand {
  uint64_t asker = 0;  // number of who asks, any
  bool rests = false;  // for a picture at rest: there is more time
  uint64_t pose = 0;   // Answer::pose of what comes
  std::string state;   // TraceOrder::state
  uint64_t light = 0;  // Sameness::light
  bool plain = false;  // TraceOrder::plain
};

// Holds what a worker has answered of an errand, piece by piece.
struct CrewSamples {
  uint64_t asker = 0;
  bool rests = false;
  std::vector<Answer> answers;
};

class Crew {
 public:
  // `scene`: Sameness::scene; `bounds` of its world. Throws std::invalid_argument for settings that
  // are wrong.
  Crew(CrewSettings settings, std::string exhibit, uint64_t scene, SampleBounds bounds);

  // Any thread may call these; none waits for more than another's turn.

  // Calls, takes what was answered and gives up what was not.
  void advance();
  // Returns how many requests would be sent now; `rests` as in Errand.
  int room(bool rests) const;
  // Takes pieces of the broker for workers that have room, at most `most` requests, and sends them.
  // `trace` finds the same samples here, for CrewSettings::verifies. Returns how many requests went
  // out.
  using TraceHere = std::function<std::vector<Sample>(const cache::Piece&)>;
  int send(Broker& broker, const Errand& errand, int most, const TraceHere& trace);
  // Returns all that has come since the last call, but for whom it comes apart.
  std::vector<CrewSamples> take();
  // Returns the number of a new asker who takes what comes for itself, on any thread, and who is
  // asked for while its maps are those that others show.
  uint64_t begin_apart();
  void end_apart(uint64_t asker);
  std::vector<CrewSamples> take_apart(uint64_t asker);
  CrewReport report() const;

 private:
  struct Member {
    WorkerPace pace;
    int cores = 0;
    bool same_bits = true;
    double heard = -1e9;        // when it last answered
    double rests_until = -1e9;  // not asked before
    double rest = 0;            // seconds of its last rest for garbage
    std::string problem;
    uint64_t samples = 0, lost = 0;
    int unanswered = 0;  // orders lost in a row
  };
  struct Order {
    std::string worker;
    Errand errand;
    std::vector<cache::Piece> pieces;
    std::vector<Sample> expected;  // empty: not verified
    double sent = 0, until = 0;
    int requests = 0;
  };
  struct Heard {
    double came = 0;  // seconds
    std::string message, reply_to;
  };
  void hear(std::string_view message, std::string_view reply_to);
  void answer_questions();
  void take_call_answer(const CallAnswer& answer, double now);
  void take_answer(TraceAnswer answer, double now);
  void take_samples(Order order, std::vector<Sample> samples, bool same_bits);
  void verify(const std::vector<Sample>& here, const std::vector<Sample>& there, bool same_bits);
  void rest(Member& member, const std::string& problem, double until);
  void lose(Member& member, const Order& order);
  void give_up(double now);
  bool is_asked(const Member& member, double now) const;
  bool send_order(Broker& broker, const Errand& errand, const std::string& name, Member& member,
                  int most, const TraceHere& trace);

  const CrewSettings settings_;
  const std::string exhibit_;
  const uint64_t scene_;
  const SampleBounds bounds_;
  const MessageKey key_;
  const uint64_t server_;
  const std::string answers_;  // subject
  mutable std::mutex mutex_;
  std::deque<Heard> inbox_;
  size_t inbox_bytes_ = 0;
  std::map<std::string, Member, std::less<>> members_;
  std::map<uint64_t, Order> orders_;  // in flight, by number
  std::vector<CrewSamples> done_;
  std::map<uint64_t, std::vector<CrewSamples>> apart_;  // by asker
  uint64_t light_ = 0;  // maps of the last errand that is not apart; 0: there was none
  CrewTotals totals_;
  struct Asked {
    FileQuestion question;
    std::string reply_to;
  };
  std::deque<Asked> asked_;  // the tick's
  uint64_t numbers_ = 0, calls_ = 0;
  double called_ = -1e9;
  PackageShelf shelf_;  // librarian_'s while it is busy
  Channel channel_;     // its threads write into the others
  Worker librarian_;    // the last member: its thread sends
};

// Subjects of NATS. The second is a worker's own, shared by all that have its name.
inline constexpr const char* call_subject = "wellspring.call";
std::string orders_subject(std::string_view worker);
std::string answers_subject(uint64_t server);

}  // namespace wellspring::workers
