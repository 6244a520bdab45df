// SPDX-License-Identifier: Apache-2.0
// One connected peer as both sides see it: `stream` owns the socket, the show owns the visit, and
// this is all they share. Pictures: one slot, newest wins. Text and sound: short bounded queues;
// sound that a slow peer does not take is thrown away as a whole, since half a sentence is worse
// than none. No call blocks. Every call may come from any thread. After close() or mark_closed()
// sending does nothing; texts that had arrived by then can still be taken.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/worker.h"
#include "wire/json.h"
#include "wire/packet.h"

namespace wellspring::wire {

// Something was written to a peer and has arrived there: the answer to a ping behind it came.

struct Delivery {
  size_t bytes = 0;
  double began = 0, ended = 0;  // writing it, and the answer; seconds of one clock
  bool alone = false;           // nothing was under way when writing it began
  bool picture = false;
};

// A text of a peer and what it says. It is read where it comes in, on the thread of its socket, so
// that who carries it out has no more to do with it.

struct Heard {
  std::string text;  // as it came
  std::variant<WireError, BrowserMessage, Observation> said;
  size_t values = 0;  // of JSON that were read for it
};

Heard hear_visitor(std::string text);
Heard hear_camera(std::string text);

// Returns what it says, where it is such a thing; else null.
template <class Message>
const Message* said_as(const Heard& heard) {
  const BrowserMessage* message = std::get_if<BrowserMessage>(&heard.said);
  return message ? std::get_if<Message>(message) : nullptr;
}

enum class LinkKind : uint8_t { visit, eye };  // /api/v1/visit, /api/v1/eye

class Link {
 public:
  static constexpr size_t max_texts_in = 256;  // more unread: the oldest are dropped and counted
  static constexpr size_t max_bytes_in = 1 << 20;  // likewise
  static constexpr size_t max_deliveries = 64;
  static constexpr size_t max_texts_out =
      128;  // more unsent: the link is closed (a reader this slow is gone)

  static constexpr size_t max_sound_out =
      192 * 1024;  // bytes unsent, four seconds of speech: all of it is dropped

  Link(uint64_t id, LinkKind kind, std::string peer) : id(id), kind(kind), peer(std::move(peer)) {}
  const uint64_t id;
  const LinkKind kind;
  const std::string peer;  // address, for the log
  // Set before the show gets the link, and never changed after.
  bool local = false;   // HttpQuestion::local
  std::string address;  // with whom it shares seats; empty: with nobody, as it is trusted
  std::string kiosk;    // an eye whose token is for the kiosk of that name alone; empty: any

  // ---- called by the show ----
  std::vector<Heard> take_heard();           // all that arrived since the last call, in order
  std::optional<Heard> first_heard() const;  // of those, left there; empty: there is none
  void drop_first_heard();
  void put_back(Heard heard);                        // as the first of those
  void send_text(std::string text);                  // small JSON
  void send_picture(std::shared_ptr<const Packet>);  // replaces an unsent one
  // Kept in order with texts. False: the peer is too slow, all unsent sound is gone with this one.
  bool send_sound(std::shared_ptr<const Packet>);
  void drop_sound();  // whatever has not been sent yet
  bool picture_pending() const {
    return picture_.full();
  }                                         // the last picture has not been taken yet
  std::vector<Delivery> take_deliveries();  // since the last call, in order
  void close(std::string reason);           // asks the socket to close
  bool closed() const { return closed_; }

  // ---- called by stream ----
  struct Out {  // next thing to write: text, or binary
    bool binary = false;
    bool picture = false;
    std::string text;
    std::shared_ptr<const Packet> packet;
  };
  bool take_out(Out& out);  // texts and sounds before pictures; false: nothing to send
  // A message arrived: it is read at once, by who calls. How many values it had.
  size_t push_text_in(std::string);
  void push_delivery(const Delivery& delivery);
  void set_wake(
      std::function<void()> wake);  // called (from any thread) after something became sendable
  void mark_closed();               // the socket is gone; the show will notice
  bool close_requested(std::string& reason) const;
  uint64_t pictures_dropped() const { return picture_.dropped(); }
  uint64_t sounds_dropped() const { return sounds_dropped_; }  // packets, by slowness or drop_sound
  uint64_t texts_dropped() const { return texts_dropped_; }    // arrived, never read by the show
  std::atomic<uint64_t> bytes_sent{0}, pictures_sent{0};

 private:
  void send(Out out);
  void drop_unsent_sound();  // with the lock held
  void wake();
  mutable std::mutex mutex_;
  std::deque<Heard> in_;
  size_t bytes_in_ = 0;
  std::vector<Delivery> deliveries_;  // a few: the oldest are dropped
  std::deque<Out> out_;
  size_t texts_out_ = 0, sound_out_ = 0;  // of out_: texts, and bytes of sound
  Latest<std::shared_ptr<const Packet>> picture_;
  std::function<void()> wake_;
  std::string close_reason_;
  bool close_requested_ = false;
  std::atomic<bool> closed_{false};
  std::atomic<uint64_t> texts_dropped_{0}, sounds_dropped_{0};
};

}  // namespace wellspring::wire
