// SPDX-License-Identifier: Apache-2.0
// Connects two threads to one peer: `stream` owns the socket, the show owns the visit, and they
// share only this. Pictures: one slot, newest wins. Text and sound: short bounded queues; sound
// that a slow peer does not take is thrown away as a whole, since half a sentence is worse than
// none. No call blocks. Every call may come from any thread. After close() or mark_closed() sending
// does nothing; texts that had arrived by then can still be taken.
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

// Describes a message that was written to a peer and has arrived there: the answer to a ping behind
// it came.

struct Delivery {
  size_t bytes = 0;
  double began = 0, ended = 0;  // when writing it began, and the answer came; seconds of one clock
  bool alone = false;           // nothing else was under way when writing it began
  bool picture = false;
};

// Holds a text of a peer and the message in it. A text is read when it arrives, on the thread of
// its socket, so that the thread that carries it out need not read it.

struct Heard {
  std::string text;  // as it came
  std::variant<WireError, BrowserMessage, Observation> said;
  size_t values = 0;  // number of JSON values read for it
};

Heard hear_visitor(std::string text);
Heard hear_camera(std::string text);

// Returns the message, if it is one of that type; else null.
template <class Message>
const Message* said_as(const Heard& heard) {
  const BrowserMessage* message = std::get_if<BrowserMessage>(&heard.said);
  return message ? std::get_if<Message>(message) : nullptr;
}

enum class LinkKind : uint8_t { visit, eye };  // /api/v1/visit, /api/v1/eye

class Link {
 public:
  // Unread texts; beyond, the oldest are dropped and counted.
  static constexpr size_t max_texts_in = 256;
  static constexpr size_t max_bytes_in = 1 << 20;  // unread bytes; beyond, likewise
  static constexpr size_t max_deliveries = 64;
  static constexpr size_t max_texts_out = 128;  // unsent texts; beyond, the link is closed

  static constexpr size_t max_sound_out =
      192 * 1024;  // unsent bytes, four seconds of speech; beyond, all are dropped

  Link(uint64_t id, LinkKind kind, std::string peer) : id(id), kind(kind), peer(std::move(peer)) {}
  const uint64_t id;
  const LinkKind kind;
  const std::string peer;  // address, for the log
  // These are set before the show gets the link, and never changed after.
  bool local = false;   // HttpQuestion::local
  std::string address;  // address that shares seats; empty: it is trusted and shares with nobody
  std::string kiosk;    // kiosk for which an eye's token is; empty: any

  // ---- called by the show ----
  std::vector<Heard> take_heard();  // all that arrived since the last call, in order
  // The first of these, which stays; empty: there is none.
  std::optional<Heard> first_heard() const;
  void drop_first_heard();
  void put_back(Heard heard);                        // puts it before all others
  void send_text(std::string text);                  // small JSON
  void send_picture(std::shared_ptr<const Packet>);  // replaces an unsent one
  // Sends sound, in order with texts. False: the peer is too slow, and all unsent sound is dropped,
  // this packet too.
  bool send_sound(std::shared_ptr<const Packet>);
  void drop_sound();  // drops all unsent sound
  bool picture_pending() const {
    return picture_.full();
  }                                         // the last picture has not been taken yet
  std::vector<Delivery> take_deliveries();  // since the last call, in order
  void close(std::string reason);           // asks the socket to close
  bool closed() const { return closed_; }

  // ---- called by stream ----
  struct Out {  // next message to write: text, or binary
    bool binary = false;
    bool picture = false;
    std::string text;
    std::shared_ptr<const Packet> packet;
  };
  bool take_out(Out& out);  // texts and sounds before pictures; false: nothing to send
  // Reads a message that has arrived, at once and on the caller's thread. Returns how many JSON
  // values it had.
  size_t push_text_in(std::string);
  void push_delivery(const Delivery& delivery);
  // Sets what is called (from any thread) after something became sendable.
  void set_wake(std::function<void()> wake);
  void mark_closed();  // the socket is gone; the show will notice
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
  size_t texts_out_ = 0, sound_out_ = 0;  // texts, and bytes of sound, in out_
  Latest<std::shared_ptr<const Packet>> picture_;
  std::function<void()> wake_;
  std::string close_reason_;
  bool close_requested_ = false;
  std::atomic<bool> closed_{false};
  std::atomic<uint64_t> texts_dropped_{0}, sounds_dropped_{0};
};

}  // namespace wellspring::wire
