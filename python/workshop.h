#pragma once
// A lab at work for Python: in a thread of its own, without the interpreter's lock, while the thread that
// asked delivers progress and notes and looks for Ctrl-C.
#include <pybind11/pybind11.h>

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lab/lab.h"

namespace hwsim::python {

namespace py = pybind11;

/// What a lab says, kept until the thread that may call Python asks for it.
class Mailbox : public lab::Observer {
 public:
  struct Line {
    std::string level;  ///< "debug", "info", "warning"
    std::string text;
  };
  struct Letters {
    std::vector<Line> lines;
    bool has_progress = false;
    double done_ratio = 0.0;
    std::string what;
  };

  void say(const std::string& line) override { put("info", line); }
  void detail(const std::string& line) override { put("debug", line); }
  void report(const Diagnostic& diagnostic) override;
  /// Throws where the work is to end.
  void progress(double done_ratio, const std::string& what) override;

  void begin();
  void end();   ///< the work is over
  void stop();  ///< the next progress ends the work

  /// Waits until the work is over, or a twentieth of a second. Returns whether it is over.
  bool wait();
  Letters take();

 private:
  void put(std::string level, std::string text);

  std::mutex mutex_;
  std::condition_variable changed_;
  Letters letters_;
  bool over_ = true, stopped_ = false;
};

/// A lab with its mailbox. Questions of several threads are answered one after another.
class Workshop {
 public:
  /// `listener` has log(level, text), progress(done_ratio, what) and ended().
  Workshop(lab::LabOptions options, py::object listener);

  /// The answer of `question`, whose exceptions come out here; KeyboardInterrupt and what the listener raises
  /// come out when the work has ended. Called with the interpreter's lock.
  template <class Question>
  auto ask(Question question) {
    std::optional<decltype(question(lab_))> answer;
    work([&] { answer.emplace(question(lab_)); });
    return std::move(*answer);
  }

  const lab::Catalog& catalog() const { return lab_.catalog(); }

 private:
  void lock();
  void work(const std::function<void()>& job);
  void deliver(const Mailbox::Letters& letters);

  Mailbox mailbox_;
  py::object listener_;
  lab::Lab lab_;
  std::timed_mutex busy_;
};

}  // namespace hwsim::python
