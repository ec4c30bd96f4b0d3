#include "cli/terminal/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hwsim/base/printable.h"

namespace hwsim::cli {
namespace {

constexpr double kRedrawS = 0.1;
constexpr int kBarColumns = 30;

int terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 0.9995) return fmt::format("{:.0f} ms", seconds * 1e3);
  if (seconds < 10.0) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long>(std::lround(seconds));
  return whole < 60 ? fmt::format("{} s", whole) : fmt::format("{} min {} s", whole / 60, whole % 60);
}

Progress::Progress(const CommonArguments& options, const Terminal& terminal)
    : silent_(options.verbosity < 0 || options.progress == When::never), bar_(terminal.bar) {}

Progress::~Progress() { finish(); }

void Progress::update(double done_ratio, const std::string& name) {
  const std::string what = printable_line(name);
  const std::lock_guard lock(mutex_);
  if (silent_) return;
  done_ratio = std::clamp(done_ratio, 0.0, 1.0);
  if (bar_) return draw_bar(done_ratio, what);
  const int tenths = static_cast<int>(done_ratio * 10.0 + 1e-9);
  if (tenths <= printed_tenths_) return;
  printed_tenths_ = tenths;
  std::fputs(fmt::format("{:3d} %  {}\n", tenths * 10, what).c_str(), stderr);
}

void Progress::draw_bar(double done_ratio, const std::string& what) {
  const auto now = Clock::now();
  if (drawn_ && std::chrono::duration<double>(now - last_draw_).count() < kRedrawS) return;
  last_draw_ = now;
  drawn_ = true;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const std::string left =
      done_ratio > 0.01 ? duration_text(elapsed_s * (1.0 - done_ratio) / done_ratio) + " left" : "";
  const int filled = static_cast<int>(done_ratio * kBarColumns);
  std::string line = fmt::format("[{:=<{}}{: <{}}] {:3.0f} %  {}  {}", "", filled, "", kBarColumns - filled,
                                 done_ratio * 100.0, left, what);
  line.resize(
      std::min(line.size(), static_cast<size_t>(terminal_columns() - 1)));  // a wrapped line can't be redrawn
  std::fputs(("\r\033[K" + line).c_str(), stderr);
  std::fflush(stderr);
}

void Progress::finish() {
  const std::lock_guard lock(mutex_);
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

}  // namespace hwsim::cli
