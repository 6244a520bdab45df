// SPDX-License-Identifier: Apache-2.0
#include "show/watch/rehearsal.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "base/clock.h"
#include "base/log.h"
#include "base/worker.h"
#include "show/state/show.h"

namespace wellspring::show {

namespace fs = std::filesystem;

FolderWatch::FolderWatch(std::string folder, double still)
    : folder_(std::move(folder)), still_(still), known_(look(folder_)), last_(known_) {}

FolderWatch::Files FolderWatch::look(const std::string& folder) {
  Files files;
  std::error_code error;  // a file that vanishes meanwhile is not there
  fs::recursive_directory_iterator at(folder, error), end;
  while (!error && at != end) {
    const std::string name = at->path().filename().string();
    const bool hidden = name.starts_with('.'), folder_itself = at->is_directory(error);
    if (hidden && folder_itself) at.disable_recursion_pending();
    if (!hidden && !folder_itself && !name.ends_with('~')) {
      const auto time = at->last_write_time(error);
      const auto size = at->file_size(error);
      if (!error) files[at->path().string()] = {time, size};
    }
    error.clear();
    at.increment(error);
  }
  return files;
}

bool FolderWatch::changed(double now) {
  Files files = look(folder_);
  if (files != last_) {
    last_ = std::move(files);
    moved_at_ = now;
  }
  if (last_ == known_ || now - moved_at_ < still_) return false;
  known_ = last_;
  return true;
}

bool FolderWatch::changed() {
  last_ = look(folder_);
  return std::exchange(known_, last_) != last_;
}

namespace {

constexpr std::chrono::milliseconds pause(250);  // time between looks at the files

void shorten(Problem& problem, const std::string& folder) {
  const std::string start = folder + "/";
  if (problem.file.starts_with(start)) problem.file.erase(0, start.size());
}

}  // namespace

struct Rehearsal::Impl {
  const std::string folder;
  const std::function<std::unique_ptr<Show>()> make;
  FolderWatch files;
  Latest<Outcome> outcome;
  std::mutex mutex;
  std::condition_variable changed;
  const bool watch;
  std::atomic<bool> at_work = false;
  std::stop_source end;
  bool asked = false, anyway = false;
  std::thread thread;

  Impl(std::string folder_, std::function<std::unique_ptr<Show>()> make_, bool watch)
      : folder(std::move(folder_)), make(std::move(make_)), files(folder), watch(watch) {
    thread = std::thread([this] { live(); });
  }
  ~Impl() {
    cancel();
    thread.join();
  }

  void cancel() {
    {
      std::lock_guard lock(mutex);
      end.request_stop();
    }
    changed.notify_all();
  }

  void live() {
    std::unique_lock lock(mutex);
    for (;;) {
      const auto wanted = [this] { return end.stop_requested() || asked; };
      if (watch) changed.wait_for(lock, pause, wanted);
      else changed.wait(lock, wanted);
      if (end.stop_requested()) return;
      const bool now = std::exchange(asked, false), in_any_case = std::exchange(anyway, false);
      lock.unlock();
      const bool is_new = now ? files.changed() : files.changed(seconds_now());
      if (is_new || in_any_case) outcome.put(rehearse());
      lock.lock();
    }
  }

  Outcome rehearse() {
    log::info("{} has changed", folder);
    at_work = true;
    Outcome found;
    try {
      const CancelScope scope(end.get_token());
      found.show = make();
    } catch (const Cancelled&) {
      log::info("{} is not read anew: the server ends", folder);
    } catch (const ExhibitError& error) {
      found.problems = error.problems;
    } catch (const std::exception& error) {
      found.problems.push_back({"", "", error.what()});
    }
    for (Problem& problem : found.problems) {
      log::warn("{}", to_string(problem));
      shorten(problem, folder);
    }
    at_work = false;
    return found;
  }
};

Rehearsal::Rehearsal(std::string folder, std::function<std::unique_ptr<Show>()> make, bool watch)
    : impl_(std::make_unique<Impl>(std::move(folder), std::move(make), watch)) {}
Rehearsal::~Rehearsal() = default;

void Rehearsal::cancel() { impl_->cancel(); }

void Rehearsal::look(bool anyway) {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->asked = true;
    impl_->anyway |= anyway;
  }
  impl_->changed.notify_all();
}

bool Rehearsal::at_work() const { return impl_->at_work; }

std::optional<Rehearsal::Outcome> Rehearsal::take() { return impl_->outcome.take(); }

using nlohmann::json;

std::string write_problems(const std::vector<Problem>& problems) {
  json message = {{"type", "problems"}, {"list", json::array()}};
  for (const Problem& problem : problems)
    message["list"].push_back(
        {{"file", problem.file}, {"where", problem.where}, {"what", problem.what}});
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

void set_problems(ExhibitStage& stage, ShowVisits& visits, std::vector<Problem> problems) {
  const std::string message = problems.empty() && stage.problems_message.empty()
                                  ? std::string()  // nothing was ever wrong
                                  : write_problems(problems);
  stage.problems = std::move(problems);
  if (message == stage.problems_message) return;
  stage.problems_message = message;
  for (Visitor& visitor : visits.visitors)
    if (visitor.welcomed) visitor.link->send_text(message);
}

}  // namespace wellspring::show
