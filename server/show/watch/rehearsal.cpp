// SPDX-License-Identifier: Apache-2.0
#include "show/watch/rehearsal.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/clock.h"
#include "base/latest.h"
#include "base/log.h"
#include "show/state/show.h"
#include "show/watch/folder_watch.h"

namespace wellspring {

namespace {

constexpr std::chrono::milliseconds pause(250);  // between looks at the files

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
  bool end = false;
  std::thread thread;

  Impl(std::string folder_, std::function<std::unique_ptr<Show>()> make_)
      : folder(std::move(folder_)), make(std::move(make_)), files(folder) {
    thread = std::thread([this] { live(); });
  }
  ~Impl() {
    {
      std::lock_guard lock(mutex);
      end = true;
    }
    changed.notify_all();
    thread.join();
  }

  void live() {
    std::unique_lock lock(mutex);
    while (!changed.wait_for(lock, pause, [this] { return end; })) {
      lock.unlock();
      if (files.changed(seconds_now())) outcome.put(rehearse());
      lock.lock();
    }
  }

  Outcome rehearse() {
    log::info("{} has changed", folder);
    Outcome found;
    try {
      found.show = make();
    } catch (const ExhibitError& error) {
      found.problems = error.problems;
    } catch (const std::exception& error) {
      found.problems.push_back({"", "", error.what()});
    }
    for (Problem& problem : found.problems) {
      log::warn("{}", to_string(problem));
      shorten(problem, folder);
    }
    return found;
  }
};

Rehearsal::Rehearsal(std::string folder, std::function<std::unique_ptr<Show>()> make)
    : impl_(std::make_unique<Impl>(std::move(folder), std::move(make))) {}
Rehearsal::~Rehearsal() = default;

std::optional<Rehearsal::Outcome> Rehearsal::take() { return impl_->outcome.take(); }

}  // namespace wellspring
