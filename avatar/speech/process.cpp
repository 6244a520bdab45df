// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/process.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "avatar/speech/answer.h"
#include "avatar/speech/protocol.h"
#include "base/child.h"
#include "base/clock.h"
#include "base/log.h"

namespace wellspring::avatar {

namespace protocol = speech_protocol;

namespace {

enum class Transfer { done, late, broken };

// Waits until `socket` can do `events`, at most until `deadline`.
Transfer wait_for(int socket, short events, double deadline) {
  for (;;) {
    double left = deadline - seconds_now();
    if (left <= 0) return Transfer::late;
    pollfd entry{socket, events, 0};
    int ready = poll(&entry, 1, int(left * 1e3) + 1);
    if (ready > 0) return Transfer::done;
    if (ready < 0 && errno != EINTR) return Transfer::broken;
  }
}

Transfer receive(int socket, char* to, size_t size, double deadline) {
  while (size > 0) {
    Transfer ready = wait_for(socket, POLLIN, deadline);
    if (ready != Transfer::done) return ready;
    ssize_t got = recv(socket, to, size, MSG_DONTWAIT);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (got <= 0) return Transfer::broken;
    to += got;
    size -= size_t(got);
  }
  return Transfer::done;
}

Transfer transmit(int socket, const std::string& bytes, double deadline) {
  for (size_t at = 0; at < bytes.size();) {
    Transfer ready = wait_for(socket, POLLOUT, deadline);
    if (ready != Transfer::done) return ready;
    ssize_t put = send(socket, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (put < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (put <= 0) return Transfer::broken;
    at += size_t(put);
  }
  return Transfer::done;
}

Transfer receive_frame(int socket, double deadline, std::string& json, std::vector<int16_t>& pcm) {
  unsigned char bytes[protocol::header_bytes];
  Transfer state = receive(socket, reinterpret_cast<char*>(bytes), sizeof bytes, deadline);
  if (state != Transfer::done) return state;
  protocol::Header header = protocol::read_header(bytes);
  if (header.json > protocol::max_answer_json || header.sound > protocol::max_sound_bytes ||
      header.sound % 2 != 0)
    return Transfer::broken;
  json.resize(header.json);
  state = receive(socket, json.data(), json.size(), deadline);
  if (state != Transfer::done) return state;
  pcm.resize(header.sound / 2);
  return receive(socket, reinterpret_cast<char*>(pcm.data()), header.sound, deadline);
}

}  // namespace

std::string program_path(const VoiceProgram& program) {
  if (!program.path.empty()) return program.path;
  if (const char* path = std::getenv("WELLSPRING_VOICE")) return path;
  char own[PATH_MAX];
  ssize_t length = readlink("/proc/self/exe", own, sizeof own);
  std::string path(own, length > 0 ? size_t(length) : 0);
  return path.substr(0, path.rfind('/') + 1) + "wellspring_voice";
}

struct SpeechProcess::Impl {
  VoiceProgram program;
  std::optional<Child> child;
  int socket = -1;
  int64_t next_id = 1;
  int vain_starts = 0;     // number since the last good answer
  double rest_until = 0;   // time before which the program is not started again
  std::string last_error;  // last error that was logged
  std::vector<std::string> languages;

  void stop() {
    if (socket >= 0) close(socket);
    socket = -1;
    child.reset();
  }

  // Logs an error of the program when it is a new one, and counts the start as vain.
  std::string give_up(const std::string& error) {
    stop();
    if (++vain_starts >= 3) rest_until = seconds_now() + program.rest_seconds;
    if (error != last_error) log::error("speech: {}", error);
    return last_error = error;
  }

  std::string spawn_program() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      return "no socket for the voice program";
    socket = ends[0];
    std::string error;
    try {
      child.emplace(ChildSettings{.words = {program.path},
                                  .files = {{ends[1], STDIN_FILENO}, {ends[1], STDOUT_FILENO}},
                                  .apart = true});
    } catch (const std::exception& problem) {
      error = std::string("the voice program ") + problem.what();
    }
    close(ends[1]);
    return error;
  }

  std::string start() {
    if (child) return {};
    if (seconds_now() < rest_until) return last_error;
    std::string error = spawn_program();
    if (!error.empty()) {
      rest_until = seconds_now() + program.rest_seconds;
      return give_up(error);
    }
    std::string hello;
    std::vector<int16_t> none;
    Transfer state = receive_frame(socket, seconds_now() + program.start_seconds, hello, none);
    if (state != Transfer::done)
      return give_up("the voice program " + program.path +
                     (state == Transfer::late ? " says nothing" : " ends without a word"));
    auto json = nlohmann::json::parse(hello, nullptr, false);
    if (json.is_object() && json.contains("error") && json["error"].is_string())
      return give_up(json["error"].get<std::string>());
    if (!json.is_object() || !json.contains("languages") || !json["languages"].is_array())
      return give_up("the voice program " + program.path + " speaks another protocol");
    languages.clear();
    for (const auto& tag : json["languages"])
      if (tag.is_string()) languages.push_back(tag.get<std::string>());
    return {};
  }

  Transfer ask(const SpeechRequest& request, std::string& answer, std::vector<int16_t>& pcm) {
    nlohmann::json asked{{"id", next_id++},
                         {"text", request.text},
                         {"lang", request.lang},
                         {"words_per_minute", request.words_per_minute},
                         {"pitch", request.pitch}};
    if (!request.variant.empty()) asked["variant"] = request.variant;
    if (!request.styles.empty()) {
      asked["text"] = make_ssml(request.text, request.styles).text;
      asked["ssml"] = true;
    }
    std::string text = asked.dump();
    double deadline = seconds_now() + program.answer_seconds;
    std::string frame = protocol::write_header(uint32_t(text.size()), 0) + text;
    Transfer state = transmit(socket, frame, deadline);
    return state == Transfer::done ? receive_frame(socket, deadline, answer, pcm) : state;
  }
};

SpeechProcess::SpeechProcess(VoiceProgram program) : impl_(std::make_unique<Impl>()) {
  impl_->program = std::move(program);
  impl_->program.path = program_path(impl_->program);
}

SpeechProcess::~SpeechProcess() { impl_->stop(); }

int SpeechProcess::process_id() const { return impl_->child ? int(impl_->child->id()) : 0; }
const std::vector<std::string>& SpeechProcess::languages() const { return impl_->languages; }

std::shared_ptr<const Speech> SpeechProcess::speak(const SpeechRequest& request,
                                                   std::string& error) {
  error = check_speech_request(request);
  if (!error.empty()) return nullptr;
  for (int attempt = 0; attempt < 2; attempt++) {
    error = impl_->start();
    if (!error.empty()) return nullptr;
    std::string answer;
    std::vector<int16_t> pcm;
    Transfer state = impl_->ask(request, answer, pcm);
    if (state == Transfer::done) {
      impl_->vain_starts = 0;
      impl_->last_error.clear();
      return read_speech_answer(request, answer, std::move(pcm), error);
    }
    bool late = state == Transfer::late;
    error =
        impl_->give_up(late ? "the voice program hung and was ended" : "the voice program died");
    if (late) return nullptr;
  }
  return nullptr;
}

}  // namespace wellspring::avatar
