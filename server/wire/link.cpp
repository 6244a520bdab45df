// SPDX-License-Identifier: Apache-2.0
#include "wire/link.h"

#include <utility>

namespace wellspring::wire {
namespace {

template <class Read>
Heard hear(std::string text, const Read& read) {
  Heard heard;
  std::visit([&](auto&& said) { heard.said = std::forward<decltype(said)>(said); },
             read(text, &heard.values));
  heard.text = std::move(text);
  return heard;
}

}  // namespace

Heard hear_visitor(std::string text) { return hear(std::move(text), read_browser_message); }
Heard hear_camera(std::string text) { return hear(std::move(text), read_observation); }

std::vector<Heard> Link::take_heard() {
  std::lock_guard lock(mutex_);
  std::vector<Heard> heard(std::make_move_iterator(in_.begin()),
                           std::make_move_iterator(in_.end()));
  in_.clear();
  bytes_in_ = 0;
  return heard;
}

std::optional<Heard> Link::first_heard() const {
  std::lock_guard lock(mutex_);
  if (in_.empty()) return {};
  return in_.front();
}

void Link::drop_first_heard() {
  std::lock_guard lock(mutex_);
  if (in_.empty()) return;
  bytes_in_ -= in_.front().text.size();
  in_.pop_front();
}

void Link::put_back(Heard heard) {
  std::lock_guard lock(mutex_);
  bytes_in_ += heard.text.size();
  in_.push_front(std::move(heard));
}

void Link::send_text(std::string text) {
  Out out;
  out.text = std::move(text);
  send(std::move(out));
}

bool Link::send_sound(std::shared_ptr<const Packet> packet) {
  if (!packet) return true;
  {
    std::lock_guard lock(mutex_);
    if (closed_ || close_requested_) return true;
    if (sound_out_ + packet->size() > max_sound_out) {
      sounds_dropped_++;
      drop_unsent_sound();
      return false;
    }
    sound_out_ += packet->size();
    Out out;
    out.binary = true;
    out.packet = std::move(packet);
    out_.push_back(std::move(out));
  }
  wake();
  return true;
}

void Link::drop_sound() {
  std::lock_guard lock(mutex_);
  drop_unsent_sound();
}

void Link::drop_unsent_sound() {
  sounds_dropped_ += std::erase_if(out_, [](const Out& out) { return out.binary; });
  sound_out_ = 0;
}

void Link::send(Out out) {
  {
    std::lock_guard lock(mutex_);
    if (closed_ || close_requested_) return;
    if (texts_out_ >= max_texts_out) {
      close_requested_ = true;
      close_reason_ = "too slow";
    } else {
      texts_out_++;
      out_.push_back(std::move(out));
    }
  }
  wake();
}

void Link::send_picture(std::shared_ptr<const Packet> packet) {
  if (!packet) return;
  {
    std::lock_guard lock(mutex_);
    if (closed_ || close_requested_) return;
    picture_.put(std::move(packet));
  }
  wake();
}

void Link::close(std::string reason) {
  {
    std::lock_guard lock(mutex_);
    if (closed_ || close_requested_) return;
    close_requested_ = true;
    close_reason_ = std::move(reason);
  }
  wake();
}

bool Link::take_out(Out& out) {
  std::lock_guard lock(mutex_);
  if (!out_.empty()) {
    out = std::move(out_.front());
    out_.pop_front();
    if (out.binary) sound_out_ -= out.packet->size();
    else texts_out_--;
    return true;
  }
  if (auto picture = picture_.take()) {
    out = Out{};
    out.binary = out.picture = true;
    out.packet = std::move(*picture);
    return true;
  }
  return false;
}

size_t Link::push_text_in(std::string text) {
  Heard heard =
      kind == LinkKind::eye ? hear_camera(std::move(text)) : hear_visitor(std::move(text));
  const size_t values = heard.values;
  std::lock_guard lock(mutex_);
  bytes_in_ += heard.text.size();
  in_.push_back(std::move(heard));
  while (in_.size() > max_texts_in || (bytes_in_ > max_bytes_in && in_.size() > 1)) {
    bytes_in_ -= in_.front().text.size();
    in_.pop_front();
    texts_dropped_++;
  }
  return values;
}

void Link::push_delivery(const Delivery& delivery) {
  std::lock_guard lock(mutex_);
  if (deliveries_.size() >= max_deliveries) deliveries_.erase(deliveries_.begin());
  deliveries_.push_back(delivery);
}

std::vector<Delivery> Link::take_deliveries() {
  std::lock_guard lock(mutex_);
  return std::exchange(deliveries_, {});
}

void Link::set_wake(std::function<void()> wake) {
  std::lock_guard lock(mutex_);
  wake_ = std::move(wake);
}

void Link::mark_closed() {
  std::lock_guard lock(mutex_);
  closed_ = true;
  wake_ = nullptr;
  out_.clear();
  texts_out_ = sound_out_ = 0;
  picture_.take();
}

bool Link::close_requested(std::string& reason) const {
  std::lock_guard lock(mutex_);
  if (close_requested_) reason = close_reason_;
  return close_requested_;
}

// Calls outside the lock, so that the callee may call back into the link.
void Link::wake() {
  std::function<void()> wake;
  {
    std::lock_guard lock(mutex_);
    wake = wake_;
  }
  if (wake) wake();
}

}  // namespace wellspring::wire
