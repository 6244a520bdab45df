// SPDX-License-Identifier: Apache-2.0
#include "show/http/picture_desk.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/load_error.h"
#include "base/log.h"
#include "show/exhibit/exhibit_collection.h"
#include "show/exhibit/exhibit_files.h"
#include "show/http/refusal.h"
#include "store/remote/http_get.h"

namespace wellspring::show {

namespace {

constexpr size_t most_waiting_pictures = 256, most_picture_bytes = size_t(4) << 20,
                 most_kept_bytes = size_t(48) << 20;
constexpr size_t most_at_once = 4;  // pictures that are on their way
constexpr size_t longest_head = 64;

HttpReply picture_reply(const std::string& type, const std::string& bytes) {
  HttpReply reply;
  reply.content_type = type;
  reply.body = bytes;
  reply.headers["Cache-Control"] = "public, max-age=86400";
  return reply;
}

}  // namespace

std::string allowed_picture(const Record& record, const std::vector<std::string>& hosts) {
  const auto address = store::read_http_address(record.picture);
  return address && store::is_allowed(*address, hosts) ? record.picture : "";
}

std::string collection_picture(const Exhibit& exhibit, size_t record) {
  if (!exhibit.collection) return "";
  const std::vector<Record>& all = exhibit.collection->collection.records.all;
  return record < all.size() ? allowed_picture(all[record], exhibit.allowed_hosts) : "";
}

std::optional<size_t> read_picture_path(std::string_view tail) {
  constexpr std::string_view before = "/collection/pictures/";
  if (!tail.starts_with(before)) return {};
  tail.remove_prefix(before.size());
  size_t number = 0;
  const auto [end, error] = std::from_chars(tail.data(), tail.data() + tail.size(), number);
  if (error != std::errc() || end != tail.data() + tail.size()) return {};
  return number;
}

PictureDesk::~PictureDesk() {
  {
    std::lock_guard lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  for (std::thread& one : threads_) one.join();
  for (const Ticket& ticket : waiting_)
    ticket.asker->answer(refuse(503, "stopping", "the server stops"));
}

void PictureDesk::ask(const std::string& address, const std::vector<std::string>& hosts,
                      const std::shared_ptr<HttpAsker>& asker) {
  std::optional<HttpReply> reply;
  {
    std::lock_guard lock(mutex_);
    reply = find(address);
    if (!reply && waiting_.size() < most_waiting_pictures) {
      waiting_.push_back({address, hosts, asker});
      if (threads_.size() < most_at_once) threads_.emplace_back([this] { live(); });
      changed_.notify_one();
      return;
    }
  }
  if (!reply) {
    reply = refuse(503, "busy", "many ask for pictures; please come back in a moment");
    reply->headers["Retry-After"] = "2";
  }
  asker->answer(std::move(*reply));
}

std::optional<HttpReply> PictureDesk::find(const std::string& address) {
  for (auto one = kept_.begin(); one != kept_.end(); ++one) {
    if (one->address != address) continue;
    kept_.splice(kept_.begin(), kept_, one);
    return picture_reply(one->type, one->bytes);
  }
  return {};
}

void PictureDesk::live() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return end_ || !waiting_.empty(); });
    if (end_) return;
    const Ticket ticket = std::move(waiting_.front());
    waiting_.pop_front();
    if (ticket.asker->gone()) continue;
    std::optional<HttpReply> reply = find(ticket.address);
    if (reply) {
      lock.unlock();
      ticket.asker->answer(std::move(*reply));
      lock.lock();
      continue;
    }
    lock.unlock();
    Kept made{ticket.address, {}, {}};
    try {
      const auto bytes = store::http_get(ticket.address, {.hosts = ticket.hosts,
                                                          .most_bytes = most_picture_bytes,
                                                          .accept = "image/jpeg, image/png"});
      if (bytes) made.bytes.assign(bytes->begin(), bytes->end());
      made.type = media_type(Medium::image, std::string_view(made.bytes).substr(0, longest_head));
      if (!bytes) reply = refuse(404, "no_picture", "its museum has no such picture");
      else if (made.type.empty())
        reply = refuse(502, "no_picture", "its museum sends neither JPEG nor PNG");
      else reply = picture_reply(made.type, made.bytes);
    } catch (const LoadError& problem) {
      log::warn("{}", problem.what());
      reply = refuse(502, "no_picture", "its museum does not give the picture");
    }
    ticket.asker->answer(std::move(*reply));
    lock.lock();
    if (made.type.empty()) continue;
    kept_bytes_ += made.bytes.size();
    kept_.push_front(std::move(made));
    while (kept_bytes_ > most_kept_bytes) {
      kept_bytes_ -= kept_.back().bytes.size();
      kept_.pop_back();
    }
  }
}

}  // namespace wellspring::show
