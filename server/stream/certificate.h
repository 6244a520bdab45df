// SPDX-License-Identifier: Apache-2.0
// Holds the server's certificate and key, from two files in PEM, read anew when they change.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

namespace boost::asio::ssl {
class context;
}

namespace wellspring::stream {

// Allows TLS 1.2 and 1.3 with forward secrecy and authenticated encryption only; HTTP/1.1 by ALPN.
class Certificate {
 public:
  using Context = boost::asio::ssl::context;

  // `chain`: the server's certificate first, then those that sign it. Throws std::runtime_error
  // that names the file and its fault.
  Certificate(std::string chain, std::string key);

  // Returns the context for connections that begin now; those that are under way keep theirs. Any
  // thread.
  std::shared_ptr<Context> context() const;

  // Reads the files if they are others than those in use and have not changed since the last look:
  // a renewal writes one after the other. Files that cannot be used are logged once, and the
  // certificate stays. True: there is a new one. To be called every few seconds.
  bool look_again();
  // Does the same at once, whether they have changed or not: the caller says that they are
  // complete.
  bool read_again();

 private:
  struct Stamp {  // times and sizes of both files, links followed
    std::filesystem::file_time_type chain_time, key_time;
    uintmax_t chain_size = 0, key_size = 0;
    bool operator==(const Stamp&) const = default;
  };
  Stamp stamp() const;

  const std::string chain_, key_;
  Stamp used_, seen_;  // stamps of the files read last, and at the last look
  mutable std::mutex mutex_;
  std::shared_ptr<Context> context_;
};

}  // namespace wellspring::stream
