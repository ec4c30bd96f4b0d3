// How fast the program starts: processor time of `hwsim --help` beside that of `true`, and of a replay from
// the cache beside that of `--help`. The commands take turns, so that whatever else the machine does meets
// all of them.
//   start_benchmark [--runs=N] [--hwsim=PROGRAM]
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

struct Command {
  std::string name;
  Arguments arguments;
  std::vector<double> ms;  ///< processor time of each run
};

double ms_of(const timeval& t) {
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
}

/// Processor time of one run whose output goes nowhere.
double run(const Arguments& arguments) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, argv.front(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  rusage usage{};
  if (failed != 0 || wait4(child, &status, 0, &usage) != child || status != 0)
    throw std::runtime_error("`" + arguments.front() + "` failed");
  return ms_of(usage.ru_utime) + ms_of(usage.ru_stime);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// The median of the ratios of runs that stood next to each other.
double paired_ratio(const Command& a, const Command& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.ms.size(); ++i) ratios.push_back(a.ms[i] / std::max(b.ms[i], 1e-3));
  return median(ratios);
}

int measure(const std::string& program, int runs) {
  const fs::path folder = fs::temp_directory_path() / ("hwsim-start-" + std::to_string(getpid()));
  fs::create_directories(folder);
  setenv("HWSIM_CACHE", (folder / "cache").c_str(), 1);
  const Arguments replay = {program,  "run",        "sponza_hall", "--resolution", "320x180",        "-t",
                            "msaa8x", "--no-image", "--force",     "--out",        folder / "result"};
  std::vector<Command> commands = {
      {"true", {"true"}, {}}, {"hwsim --help", {program, "--help"}, {}}, {"replay of msaa8x", replay, {}}};
  run(replay);  // emulates
  run(replay);  // loads the scene: a file just written is not trusted yet
  for (int i = 0; i < runs; ++i)
    for (Command& command : commands) command.ms.push_back(run(command.arguments));
  fs::remove_all(folder);
  std::printf("| command | processor ms, median | least | times the line above |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const Command& c = commands[i];
    std::printf("| `%s` | %.1f | %.1f | ", c.name.c_str(), median(c.ms),
                *std::min_element(c.ms.begin(), c.ms.end()));
    i == 0 ? std::printf(" |\n") : std::printf("%.1f |\n", paired_ratio(c, commands[i - 1]));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  std::string program = fs::path(argv[0]).replace_filename("hwsim");
  int runs = 20;
  for (int i = 1; i < argc; ++i) {
    if (std::strncmp(argv[i], "--hwsim=", 8) == 0) {
      program = argv[i] + 8;
    } else if (std::sscanf(argv[i], "--runs=%d", &runs) != 1 || runs < 1) {
      std::fprintf(stderr, "usage: start_benchmark [--runs=N] [--hwsim=PROGRAM]\n");
      return 2;
    }
  }
  return measure(program, runs);
} catch (const std::exception& error) {
  std::fprintf(stderr, "start_benchmark: %s\n", error.what());
  return 1;
}
