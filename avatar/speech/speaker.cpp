// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/speaker.h"

#include <condition_variable>
#include <deque>
#include <list>
#include <map>
#include <mutex>
#include <thread>

#include "avatar/speech/speech_json.h"

namespace wellspring::avatar {

namespace {

size_t bytes_of(const Speech& speech) {
  return sizeof(Speech) + speech.text.size() + speech.pcm.size() * sizeof(int16_t) +
         speech.words.size() * sizeof(SpeechWord) + speech.phonemes.size() * sizeof(SpeechPhoneme) +
         speech.visemes.keys.size() * sizeof(VisemeKey);
}

std::shared_future<SpeechAnswer> ready_answer(SpeechAnswer answer) {
  std::promise<SpeechAnswer> promise;
  promise.set_value(std::move(answer));
  return promise.get_future().share();
}

}  // namespace

struct Speaker::Impl {
  struct Job {
    SpeechRequest request;
    std::promise<SpeechAnswer> promise;
    std::shared_future<SpeechAnswer> future;
    bool urgent = false;
  };
  struct Kept {
    std::string key;
    std::shared_ptr<const Speech> speech;
    size_t bytes = 0;
  };

  SpeakerOptions options;
  mutable std::mutex mutex;
  std::condition_variable wake;
  bool ending = false;
  std::map<std::string, Job> jobs;           // jobs that wait or are under way, by key
  std::deque<std::string> urgent, prepared;  // keys of the jobs that wait
  std::list<Kept> kept;                      // most recently used first
  std::map<std::string, std::list<Kept>::iterator> kept_by_key;
  Counts counts;
  std::thread thread;

  std::shared_ptr<const Speech> recall(const std::string& key) {
    auto found = kept_by_key.find(key);
    if (found == kept_by_key.end()) return nullptr;
    kept.splice(kept.begin(), kept, found->second);
    return found->second->speech;
  }

  void keep(const std::string& key, std::shared_ptr<const Speech> speech) {
    size_t bytes = bytes_of(*speech);
    if (bytes > options.memory_bytes || kept_by_key.contains(key)) return;
    kept.push_front({key, std::move(speech), bytes});
    kept_by_key[key] = kept.begin();
    counts.kept_bytes += bytes;
    while (counts.kept_bytes > options.memory_bytes) {
      counts.kept_bytes -= kept.back().bytes;
      kept_by_key.erase(kept.back().key);
      kept.pop_back();
    }
  }

  // Adds the job of a request, or makes it urgent; null when too many wait. The lock is held.
  Job* add(const SpeechRequest& request, const std::string& key, bool at_once) {
    auto found = jobs.find(key);
    if (found == jobs.end()) {
      if (jobs.size() >= options.most_waiting) return nullptr;
      Job job{request, {}, {}, false};
      job.future = job.promise.get_future().share();
      found = jobs.emplace(key, std::move(job)).first;
      if (!at_once) prepared.push_back(key);
    }
    if (at_once && !found->second.urgent) {
      found->second.urgent = true;
      urgent.push_back(key);
    }
    wake.notify_one();
    return &found->second;
  }

  // Gives the next key to say, passing over those said meanwhile. False: the end.
  bool next(std::unique_lock<std::mutex>& lock, std::string& key) {
    for (;;) {
      wake.wait(lock, [&] { return ending || !urgent.empty() || !prepared.empty(); });
      if (ending) return false;
      auto& queue = urgent.empty() ? prepared : urgent;
      key = std::move(queue.front());
      queue.pop_front();
      if (jobs.contains(key)) return true;
    }
  }

  void work() {
    SpeechProcess process(options.voice);
    SpeechFolder folder(options.folder, options.folder_bytes, program_path(options.voice));
    std::unique_lock lock(mutex);
    for (std::string key; next(lock, key);) {
      SpeechRequest request = jobs.at(key).request;
      lock.unlock();
      SpeechAnswer answer;
      answer.speech = folder.load(request);
      bool from_folder = answer.speech != nullptr;
      if (!from_folder) {
        answer.speech = process.speak(request, answer.error);
        if (answer.speech) folder.save(request, *answer.speech);
      }
      lock.lock();
      counts.starts += process.process_id() != 0 && process.process_id() != counts.process_id;
      counts.process_id = process.process_id();
      counts.spoken += answer.speech && !from_folder;
      counts.from_folder += from_folder;
      counts.failed += !answer.speech;
      if (answer.speech) keep(key, answer.speech);
      auto job = jobs.extract(key);
      job.mapped().promise.set_value(std::move(answer));
    }
    for (auto& [key, job] : jobs) job.promise.set_value({nullptr, "the speaker has ended"});
    jobs.clear();
  }
};

Speaker::Speaker(SpeakerOptions options) : impl_(std::make_unique<Impl>()) {
  impl_->options = std::move(options);
  impl_->thread = std::thread([impl = impl_.get()] { impl->work(); });
}

Speaker::~Speaker() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->ending = true;
  }
  impl_->wake.notify_one();
  impl_->thread.join();
}

std::shared_future<SpeechAnswer> Speaker::speak(const SpeechRequest& request) {
  std::string error = check_speech_request(request);
  if (!error.empty()) return ready_answer({nullptr, error});
  std::string key = speech_key(request);
  std::lock_guard lock(impl_->mutex);
  if (auto speech = impl_->recall(key)) {
    impl_->counts.from_memory++;
    return ready_answer({speech, {}});
  }
  if (Impl::Job* job = impl_->add(request, key, true)) return job->future;
  return ready_answer({nullptr, "too many texts wait to be spoken"});
}

void Speaker::prepare(const std::vector<SpeechRequest>& requests) {
  for (const SpeechRequest& request : requests) {
    if (!check_speech_request(request).empty()) continue;  // speak() reports the fault
    std::string key = speech_key(request);
    std::lock_guard lock(impl_->mutex);
    if (!impl_->recall(key)) impl_->add(request, key, false);
  }
}

std::shared_ptr<const Speech> Speaker::find(const SpeechRequest& request) const {
  std::lock_guard lock(impl_->mutex);
  return impl_->recall(speech_key(request));
}

Speaker::Counts Speaker::counts() const {
  std::lock_guard lock(impl_->mutex);
  Counts counts = impl_->counts;
  counts.waiting = impl_->jobs.size();
  counts.kept = impl_->kept.size();
  return counts;
}

}  // namespace wellspring::avatar
