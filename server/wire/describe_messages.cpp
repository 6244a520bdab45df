// SPDX-License-Identifier: Apache-2.0
// What a browser may say, out of the lists of the messages' fields, in words.
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "wire/json.h"

namespace wellspring::wire {

using nlohmann::json;

namespace {

// Notes what each field that a message lists means.
struct MessageDescriber {
  json out = json::object();

  void text(const char* name, const std::string&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void token(const char* name, const std::string&, const char* about) { out[name] = about; }
  void word(const char* name, std::initializer_list<const char*>, const std::string&,
            const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void choice(const char* name, std::initializer_list<const char*>, const auto&, const char* about,
              Need = Need::optional) {
    out[name] = about;
  }
  void number(const char* name, double, double, const auto&, const char* about,
              Need = Need::optional) {
    out[name] = about;
  }
  void number_or_null(const char* name, double, double, const auto&, const char* about) {
    out[name] = about;
  }
  void integer(const char* name, int, int, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void u32(const char* name, uint32_t, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void boolean(const char* name, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void switch_or_number(const char* name, double, double, const auto&, const char* about,
                        Need = Need::optional) {
    out[name] = about;
  }
  void place(const char* name, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void spot(const char* name, double, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void vector(const char* name, double, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void speed(const char* name, double, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
};

template <class Message>
void describe(json& all) {
  const Message message;
  MessageDescriber describer;
  Message::list(message, describer);
  all[Message::type] = std::move(describer.out);
}

template <class... Messages>
void describe_all(const std::variant<Messages...>&, json& all) {
  (describe<Messages>(all), ...);
}

}  // namespace

json describe_browser_messages() {
  json all = json::object();
  describe_all(BrowserMessage{}, all);
  return all;
}

}  // namespace wellspring::wire
