// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

namespace wellspring::log {
namespace {

constexpr const char* pattern = "%Y-%m-%dT%H:%M:%S.%e %n %^%l%$ %v";

// Writes to a file that can be opened anew while other threads write.
class FileSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit FileSink(std::string file) : file_(std::move(file)), fd_(open_file()) {
    if (fd_ < 0) throw std::runtime_error(file_ + ": " + std::strerror(errno));
  }
  ~FileSink() override { close(fd_); }
  bool reopen() {
    std::lock_guard lock(mutex_);
    const int fresh = open_file();
    if (fresh < 0) return false;
    close(fd_);
    fd_ = fresh;
    return true;
  }

 private:
  int open_file() const {
    return open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOCTTY, 0640);
  }
  bool put(std::string_view text) const {
    return ::write(fd_, text.data(), text.size()) == ssize_t(text.size());
  }
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    if (lost_ > 0 && put(std::to_string(lost_) + " lines of this log were lost\n")) lost_ = 0;
    if (lost_ > 0 || !put({line.data(), line.size()})) lost_++;
  }
  void flush_() override {}

  const std::string file_;
  int fd_;
  size_t lost_ = 0;
};

// Writes how urgent a line is for the journal: sd-daemon(3).
class Urgency final : public spdlog::custom_flag_formatter {
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& to) override {
    const char* text = message.level >= spdlog::level::err    ? "<3>"
                       : message.level >= spdlog::level::warn ? "<4>"
                       : message.level >= spdlog::level::info ? "<6>"
                                                              : "<7>";
    to.append(text, text + 3);
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<Urgency>();
  }
};

// Returns whether the descriptor is the journal's: systemd names that stream by device and inode.
bool is_journal(int fd) {
  const char* named = std::getenv("JOURNAL_STREAM");
  struct stat is {};
  return named && fstat(fd, &is) == 0 &&
         named == std::to_string(is.st_dev) + ":" + std::to_string(is.st_ino);
}

}  // namespace

void write(Level level, fmt::string_view format, fmt::format_args arguments) {
  constexpr spdlog::level::level_enum levels[] = {spdlog::level::debug, spdlog::level::info,
                                                  spdlog::level::warn, spdlog::level::err};
  auto shown = levels[size_t(level)];
  if (spdlog::should_log(shown)) spdlog::log(shown, fmt::vformat(format, arguments));
}

void start(const char* program) {
  auto logger = std::make_shared<spdlog::logger>(
      program, std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  if (is_journal(STDERR_FILENO)) {  // the journal adds time and name
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<Urgency>('*').set_pattern("%*%v");
    logger->set_formatter(std::move(formatter));
  } else {
    logger->set_pattern(pattern);
  }
  const char* level = std::getenv("WELLSPRING_LOG");
  logger->set_level(level ? spdlog::level::from_str(level) : spdlog::level::info);
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

std::vector<std::string> levels() { return {"debug", "info", "warn", "error"}; }

void set_level(const std::string& name) {
  spdlog::default_logger_raw()->set_level(spdlog::level::from_str(name));
}

void send_to(const std::string& file) {
  spdlog::logger& before = *spdlog::default_logger_raw();
  auto logger = std::make_shared<spdlog::logger>(before.name(), std::make_shared<FileSink>(file));
  logger->set_pattern(pattern);
  logger->set_level(before.level());
  spdlog::set_default_logger(logger);
}

void reopen() {
  for (const auto& sink : spdlog::default_logger_raw()->sinks())
    if (auto* file = dynamic_cast<FileSink*>(sink.get()); file && !file->reopen())
      warn("the log's file cannot be opened anew: {}", std::strerror(errno));
}

}  // namespace wellspring::log
