// SPDX-License-Identifier: Apache-2.0
// Gets the pictures of a collection's records from the museums that have them, and keeps the last
// ones: visitors' browsers ask this server alone, so nobody else learns what they look at.
#pragma once
#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "collection/records.h"
#include "show/exhibit/exhibit.h"
#include "wire/http.h"

namespace wellspring::show {

// Returns the address of a record's picture, if its host is one of `hosts`; else an empty text.
std::string allowed_picture(const Record& record, const std::vector<std::string>& hosts);
// Returns the same of one of the exhibit's records, by its Exhibit::allowed_hosts. `record` counts
// from 0 and may be any number.
std::string collection_picture(const Exhibit& exhibit, size_t record);
// Reads the number in "/collection/pictures/12"; nothing if the text is another.
std::optional<size_t> read_picture_path(std::string_view tail);

class PictureDesk {
 public:
  PictureDesk() = default;
  ~PictureDesk();
  PictureDesk(const PictureDesk&) = delete;
  PictureDesk& operator=(const PictureDesk&) = delete;

  // Answers when the picture is there: 404 if its museum has none, 502 if that does not answer or
  // sends what is no picture, 503 when too many wait. `address` is as of collection_picture();
  // `hosts` may be asked.
  void ask(const std::string& address, const std::vector<std::string>& hosts,
           const std::shared_ptr<wire::HttpAsker>& asker);

 private:
  struct Ticket {
    std::string address;
    std::vector<std::string> hosts;
    std::shared_ptr<wire::HttpAsker> asker;
  };
  struct Kept {
    std::string address, type, bytes;
  };
  void live();
  std::optional<wire::HttpReply> find(const std::string& address);

  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  std::list<Ticket> waiting_;
  std::list<Kept> kept_;  // the last one that was asked for first
  size_t kept_bytes_ = 0;
  bool end_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace wellspring::show
