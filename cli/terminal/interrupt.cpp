#include "cli/terminal/interrupt.h"

#include <unistd.h>

#include <csignal>

#include "lab/results/folder_exchange.h"

namespace hwsim::cli {

namespace fs = std::filesystem;

namespace {

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

sigset_t awaited_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR2}) sigaddset(&set, signal);
  if (!is_ignored(SIGHUP)) sigaddset(&set, SIGHUP);
  return set;
}

}  // namespace

InterruptGuard::InterruptGuard(std::string message) : message_("\n" + std::move(message) + "\n") {
  const sigset_t set = awaited_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  thread_ = std::thread([this] { wait(); });
}

InterruptGuard::~InterruptGuard() {
  pthread_kill(thread_.native_handle(), SIGUSR2);  // ends wait()
  thread_.join();
}

void InterruptGuard::wait() {
  const sigset_t set = awaited_signals();
  int signal = 0;
  sigwait(&set, &signal);
  if (signal == SIGUSR2) return;
  const std::lock_guard lock(mutex_);
  if (!folder_.empty()) lab::remove_unfinished(folder_);
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, message_.data(), message_.size());
  ::_exit(128 + signal);
}

void InterruptGuard::remove_on_interrupt(const fs::path& folder) {
  const std::lock_guard lock(mutex_);
  folder_ = folder;
}

void InterruptGuard::keep() { remove_on_interrupt({}); }

}  // namespace hwsim::cli
