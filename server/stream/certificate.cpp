// SPDX-License-Identifier: Apache-2.0
#include "stream/certificate.h"

#include <boost/asio/ssl/context.hpp>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <stdexcept>

#include "base/log.h"

namespace wellspring::stream {

// Ciphers for TLS 1.2; all ciphers of 1.3 are sound.
static constexpr const char* ciphers = "ECDHE+AESGCM:ECDHE+CHACHA20";

static std::string last_error() {
  const unsigned long code = ERR_get_error();
  char text[256] = "unknown error";
  if (code != 0) ERR_error_string_n(code, text, sizeof(text));
  ERR_clear_error();
  return text;
}

// Chooses HTTP/1.1: clients that offer protocols must offer ours; those that offer none speak it
// anyway.
static int choose_protocol(SSL*, const unsigned char** out, unsigned char* out_size,
                           const unsigned char* in, unsigned in_size, void*) {
  static constexpr unsigned char ours[] = "\x08http/1.1";
  const int found = SSL_select_next_proto(const_cast<unsigned char**>(out), out_size, ours,
                                          sizeof(ours) - 1, in, in_size);
  return found == OPENSSL_NPN_NEGOTIATED ? SSL_TLSEXT_ERR_OK : SSL_TLSEXT_ERR_ALERT_FATAL;
}

static std::shared_ptr<boost::asio::ssl::context> load_context(const std::string& chain,
                                                               const std::string& key) {
  auto context = std::make_shared<boost::asio::ssl::context>(boost::asio::ssl::context::tls_server);
  SSL_CTX* own = context->native_handle();
  ERR_clear_error();
  SSL_CTX_set_min_proto_version(own, TLS1_2_VERSION);
  SSL_CTX_set_options(own, SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION |
                               SSL_OP_CIPHER_SERVER_PREFERENCE | SSL_OP_PRIORITIZE_CHACHA);
  SSL_CTX_set_mode(own, SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_alpn_select_cb(own, choose_protocol, nullptr);
  // A key with a pass phrase is refused: nobody is there to enter it.
  SSL_CTX_set_default_passwd_cb(own, [](char*, int, int, void*) { return -1; });
  if (SSL_CTX_set_cipher_list(own, ciphers) != 1) throw std::runtime_error(last_error());
  if (SSL_CTX_use_certificate_chain_file(own, chain.c_str()) != 1)
    throw std::runtime_error(chain + ": no certificate in PEM: " + last_error());
  if (SSL_CTX_use_PrivateKey_file(own, key.c_str(), SSL_FILETYPE_PEM) != 1)
    throw std::runtime_error(key + ": no key in PEM that belongs to " + chain + ": " +
                             last_error());
  if (SSL_CTX_check_private_key(own) != 1)
    throw std::runtime_error(key + ": not the key of " + chain + ": " + last_error());
  return context;
}

Certificate::Certificate(std::string chain, std::string key)
    : chain_(std::move(chain)), key_(std::move(key)) {
  used_ = seen_ = stamp();
  context_ = load_context(chain_, key_);
}

std::shared_ptr<Certificate::Context> Certificate::context() const {
  std::lock_guard lock(mutex_);
  return context_;
}

Certificate::Stamp Certificate::stamp() const {
  std::error_code ignored;
  return {std::filesystem::last_write_time(chain_, ignored),
          std::filesystem::last_write_time(key_, ignored),
          std::filesystem::file_size(chain_, ignored), std::filesystem::file_size(key_, ignored)};
}

bool Certificate::look_again() {
  const Stamp now = stamp();
  const bool settled = now == seen_;
  seen_ = now;
  return now != used_ && settled && read_again();
}

bool Certificate::read_again() {
  used_ = seen_ = stamp();
  try {
    auto context = load_context(chain_, key_);
    std::lock_guard lock(mutex_);
    context_ = std::move(context);
  } catch (const std::exception& error) {
    log::error("the certificate is not read anew, the old one stays: {}", error.what());
    return false;
  }
  log::info("certificate {} read anew", chain_);
  return true;
}

}  // namespace wellspring::stream
