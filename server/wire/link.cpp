// SPDX-License-Identifier: Apache-2.0
#include "wire/link.h"

namespace wellspring {

std::vector<std::string> Link::take_texts() {
  std::lock_guard lock(mutex_);
  std::vector<std::string> texts(std::make_move_iterator(in_.begin()),
                                 std::make_move_iterator(in_.end()));
  in_.clear();
  bytes_in_ = 0;
  return texts;
}

void Link::send_text(std::string text) {
  Out out;
  out.text = std::move(text);
  send(std::move(out));
}

void Link::send_sound(std::shared_ptr<const Packet> packet) {
  if (!packet) return;
  Out out;
  out.binary = true;
  out.packet = std::move(packet);
  send(std::move(out));
}

void Link::send(Out out) {
  {
    std::lock_guard lock(mutex_);
    if (closed_ || close_requested_) return;
    if (out_.size() >= max_texts_out) {
      close_requested_ = true;
      close_reason_ = "too slow";
    } else {
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

void Link::push_text_in(std::string text) {
  std::lock_guard lock(mutex_);
  bytes_in_ += text.size();
  in_.push_back(std::move(text));
  while (in_.size() > max_texts_in || (bytes_in_ > max_bytes_in && in_.size() > 1)) {
    bytes_in_ -= in_.front().size();
    in_.pop_front();
    texts_dropped_++;
  }
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
  picture_.take();
}

bool Link::close_requested(std::string& reason) const {
  std::lock_guard lock(mutex_);
  if (close_requested_) reason = close_reason_;
  return close_requested_;
}

// Outside the lock, so that the callee may call back into the link.
void Link::wake() {
  std::function<void()> wake;
  {
    std::lock_guard lock(mutex_);
    wake = wake_;
  }
  if (wake) wake();
}

}  // namespace wellspring
