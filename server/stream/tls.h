// SPDX-License-Identifier: Apache-2.0
// The server's certificate and key, as two files in PEM, read anew when they change.
#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

namespace boost::asio::ssl {
class context;
}

namespace wellspring::stream {

// TLS 1.2 and 1.3 with forward secrecy and authenticated encryption only; HTTP/1.1 by ALPN.
class Certificate {
 public:
  using Context = boost::asio::ssl::context;

  // `chain`: the server's certificate first, then those that sign it. Throws std::runtime_error
  // that names the file and what is wrong with it.
  Certificate(std::string chain, std::string key);

  // For connections that begin now; those that are under way keep theirs. Any thread.
  std::shared_ptr<Context> context() const;

  // Reads the files where they are others than at the last look and have been left alone since
  // then: whoever renews them writes one after the other. What cannot be used is logged once, and
  // the certificate stays. True: there is a new one. To be called every few seconds.
  bool look_again();
  // The same at once, whether they have changed or not: somebody says that they are complete.
  bool read_again();

 private:
  struct Stamp {  // of both files, links followed
    std::filesystem::file_time_type chain_time, key_time;
    uintmax_t chain_size = 0, key_size = 0;
    bool operator==(const Stamp&) const = default;
  };
  Stamp stamp() const;

  const std::string chain_, key_;
  Stamp used_, seen_;  // of what was read last, of the last look
  mutable std::mutex mutex_;
  std::shared_ptr<Context> context_;
};

}  // namespace wellspring::stream
