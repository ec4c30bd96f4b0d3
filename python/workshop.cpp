#include "python/workshop.h"

#include <chrono>
#include <thread>
#include <utility>

namespace hwsim::python {
namespace {

constexpr std::chrono::milliseconds kPatience{50};  // how late a Ctrl-C may be heard

struct Stopped : std::exception {};

/// Raises what the handler of a signal raised: KeyboardInterrupt.
void check_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

lab::LabOptions heard_by(lab::LabOptions options, lab::Observer& observer) {
  options.observer = &observer;
  return options;
}

}  // namespace

void Mailbox::put(std::string level, std::string text) {
  const std::lock_guard lock(mutex_);
  letters_.lines.push_back({std::move(level), std::move(text)});
}

void Mailbox::report(const Diagnostic& diagnostic) {
  put(diagnostic.severity == Severity::note ? "info" : "warning", render(diagnostic, false));
}

void Mailbox::progress(double done_ratio, const std::string& what) {
  const std::lock_guard lock(mutex_);
  if (stopped_) throw Stopped();
  letters_.has_progress = true;
  letters_.done_ratio = done_ratio;
  letters_.what = what;
}

void Mailbox::begin() {
  const std::lock_guard lock(mutex_);
  over_ = stopped_ = false;
}

void Mailbox::end() {
  const std::lock_guard lock(mutex_);
  over_ = true;
  changed_.notify_all();
}

void Mailbox::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
}

bool Mailbox::wait() {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, [this] { return over_; });
}

Mailbox::Letters Mailbox::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(letters_, {});
}

Workshop::Workshop(lab::LabOptions options, py::object listener)
    : listener_(std::move(listener)), lab_(heard_by(std::move(options), mailbox_)) {}

/// One question at a time: a lab is not for several threads.
void Workshop::lock() {
  for (;;) {
    {
      const py::gil_scoped_release released;
      if (busy_.try_lock_for(kPatience)) return;
    }
    check_signals();
  }
}

void Workshop::deliver(const Mailbox::Letters& letters) {
  for (const Mailbox::Line& line : letters.lines) listener_.attr("log")(line.level, line.text);
  if (letters.has_progress) listener_.attr("progress")(letters.done_ratio, letters.what);
}

void Workshop::work(const std::function<void()>& job) {
  lock();
  const std::lock_guard held(busy_, std::adopt_lock);
  std::exception_ptr failure;
  mailbox_.begin();
  std::thread thread([&] {
    try {
      job();
    } catch (...) {
      failure = std::current_exception();
    }
    mailbox_.end();
  });
  try {
    for (bool over = false; !over;) {
      {
        const py::gil_scoped_release released;
        over = mailbox_.wait();
      }
      deliver(mailbox_.take());
      check_signals();
    }
  } catch (...) {
    mailbox_.stop();
    {
      const py::gil_scoped_release released;
      thread.join();
    }
    listener_.attr("ended")();
    throw;
  }
  thread.join();
  listener_.attr("ended")();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace hwsim::python
