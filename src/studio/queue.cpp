#include "queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "describe/guard.h"
#include "etendue/language/language.h"
#include "render/denoising.h"

namespace etendue::studio {

Queue::Queue(RenderSettings settings, std::function<void()> changed)
    : settings_(std::move(settings)), changed_(std::move(changed)), thread_([this] { work(); }) {}

Queue::~Queue() {
  {
    const std::lock_guard lock(guard_);
    ending_ = true;
    running_ = false;
    if (at_work_) at_work_->abort();
  }
  waiting_.notify_all();
  thread_.join();
}

Queue::Entry* Queue::find(int number) {
  for (Entry& entry : entries_)
    if (entry.number == number) return &entry;
  return nullptr;
}

void Queue::add(const std::string& file) {
  constexpr size_t most = 10000;
  const std::lock_guard lock(guard_);
  if (entries_.size() >= most) throw Error("the queue is full: it holds 10,000 files");
  entries_.push_back({next_++, file, State::waiting, 0, {}, {}});
  waiting_.notify_all();
}

void Queue::remove(int number) {
  const std::lock_guard lock(guard_);
  if (!find(number)) throw Error(fmt::format("there is no entry {} in the queue", number));
  if (at_work_ && at_work_number_ == number) at_work_->abort();
  std::erase_if(entries_, [&](const Entry& e) { return e.number == number; });
}

void Queue::start() {
  const std::lock_guard lock(guard_);
  running_ = true;
  waiting_.notify_all();
}

void Queue::stop() {
  const std::lock_guard lock(guard_);
  running_ = false;
  if (at_work_) at_work_->abort();
}

Json Queue::json() const {
  const std::lock_guard lock(guard_);
  Json list = Json::array();
  for (const Entry& e : entries_) {
    static constexpr const char* states[] = {"waiting", "rendering", "done", "failed"};
    Json errors = Json::array();
    for (const Error& error : e.errors) errors.push_back({{"message", error.what()}, {"shown", show(error)}});
    list.push_back({{"entry", e.number},
                    {"file", e.file},
                    {"state", states[int(e.state)]},
                    {"fraction", e.fraction},
                    {"outputs", e.outputs},
                    {"errors", std::move(errors)}});
  }
  return {{"event", "queue"}, {"running", running_}, {"entries", std::move(list)}};
}

namespace {

/// Writes all outputs that can be written, even if others fail.
void write_all(const Render& render, const std::string& stem, std::vector<std::string>& written, std::vector<Error>& errors) {
  const Job& job = render.job();
  const Image picture = render.picture();
  for (const Ref<Output>& output : job.outputs) {
    try {
      written.push_back(write_output(job, *output, picture, stem));
    } catch (const Error& error) {
      errors.push_back(error);
    }
  }
  for (std::string& path : write_denoised(job, job.outputs, picture, stem, render.settings().threads, errors))
    written.push_back(std::move(path));
}

}  // namespace

void Queue::render(const std::string& file, int number) {
  std::vector<Error> errors;
  std::vector<std::string> outputs;
  bool given_up = false;
  try {
    const Ref<Job> job = load_job(file);
    job->metadata["file"] = file;
    require_denoisers(job->outputs);  // before hours are spent
    RenderSettings settings = settings_;
    settings.on_progress = [this, number](const Progress& p) {
      {
        const std::lock_guard lock(guard_);
        if (Entry* entry = find(number)) entry->fraction = p.fraction;
      }
      changed_();
    };
    const auto render = std::make_shared<Render>(job, settings);
    {
      const std::lock_guard lock(guard_);
      at_work_ = render;
      given_up = !running_ || !find(number);
    }
    if (!given_up) given_up = render->run() == Ended::aborted;
    if (!given_up) write_all(*render, std::filesystem::path(file).replace_extension().string(), outputs, errors);
  } catch (...) {
    std::ranges::copy(thrown_errors(), std::back_inserter(errors));
  }
  const std::lock_guard lock(guard_);
  at_work_.reset();
  Entry* entry = find(number);
  if (!entry) return;
  entry->state = given_up ? State::waiting : (errors.empty() ? State::done : State::failed);
  entry->fraction = given_up ? 0 : 1;
  entry->outputs = std::move(outputs);
  entry->errors = std::move(errors);
}

void Queue::work() {
  std::unique_lock lock(guard_);
  while (!ending_) {
    Entry* next = nullptr;
    if (running_)
      for (Entry& entry : entries_)
        if (!next && entry.state == State::waiting) next = &entry;
    if (!next) {
      waiting_.wait(lock);
      continue;
    }
    next->state = State::rendering;
    at_work_number_ = next->number;
    const std::string file = next->file;
    lock.unlock();
    changed_();
    render(file, at_work_number_);
    changed_();
    lock.lock();
  }
}

}  // namespace etendue::studio
