#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <set>
#include <system_error>

#include "cli/arguments/arguments.h"
#include "cli/arguments/repeats.h"
#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/point/simulate.h"
#include "pipeline/base/file_io.h"

namespace hwsim::cli {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // clang 14 does not deduce it from the aggregate

CommonArguments common_of(const Command& command) {
  return std::visit(Overloaded{[](const PrintText&) { return CommonArguments{}; },
                               [](const auto& options) { return options.common; }},
                    command);
}

ExitStatus dispatch(const Command& command, Context& context) {
  return std::visit(Overloaded{[](const PrintText& text) {
                                 write_output(text.text);
                                 return ExitStatus::done;
                               },
                               [&](const RunArguments& o) { return run(o, context); },
                               [&](const CompareArguments& o) { return compare(o, context); },
                               [&](const ExplainArguments& o) { return explain(o, context); },
                               [&](const RankArguments& o) { return rank(o, context); },
                               [&](const SweepArguments& o) { return sweep(o, context); },
                               [&](const OptimizeArguments& o) { return optimize(o, context); },
                               [&](const ReportArguments& o) { return report(o, context); },
                               [&](const ReferenceArguments& o) { return reference(o, context); },
                               [&](const ListArguments& o) { return list(o, context); },
                               [&](const ShowArguments& o) { return show_entry(o, context); },
                               [&](const SceneCheckArguments& o) { return scene_check(o, context); },
                               [&](const ConfigArguments& o) { return config(o, context); },
                               [&](const DoctorArguments& o) { return doctor(o, context); },
                               [&](const HelpArguments& o) { return help(o, context); },
                               [&](const CacheArguments& o) { return cache(o, context); },
                               [&](const FitArguments& o) { return fit(o, context); },
                               [&](const ValidateArguments& o) { return validate(o, context); },
                               [&](const ReproduceArguments& o) { return reproduce(o, context); },
                               [&](const CompletionArguments& o) { return completion(o, context); },
                               [&](const GpuNewArguments& o) { return gpu_new(o, context); }},
                    command);
}

ExitStatus report(const InputError& error, Log& log) {
  for (const Diagnostic& diagnostic : error.diagnostics()) log.report(diagnostic);
  if (error.diagnostics().size() > 1)
    std::fprintf(stderr, "%zu errors, nothing was run\n", error.diagnostics().size());
  return error.status();
}

ExitStatus report_internal(const char* what, Log& log) {
  log.report(problem("X001", "internal error: " + std::string(what), "",
                     "this is a mistake in hwsim, not in your input; please report it with the text above"));
  return ExitStatus::run_failed;
}

ExitStatus report_shortage(const std::string& what, Log& log) {
  log.report(
      problem("X002", what, "", "a smaller scene, a smaller --resolution, fewer --jobs, or a larger limit"));
  return ExitStatus::run_failed;
}

/// Whatever a folder or a disk does is no mistake in hwsim.
Diagnostic file_problem(const std::filesystem::filesystem_error& error) {
  Diagnostic d = problem("U010", "cannot use the file or folder: " + error.code().message(), "",
                         "check that it exists, is what is asked for, may be used and has space");
  d.place.file = error.path1().string();
  return d;
}

/// Files that cannot or must not be written are told before the work, not after it.
void check_places(const CommonArguments& common) {
  std::error_code error;
  std::set<std::string> names;
  for (const FormatRequest& format : common.formats) {
    const std::filesystem::path file = format.file, folder = file.parent_path();
    if (!file.empty() && !folder.empty() && !std::filesystem::is_directory(folder, error))
      fail("U010", "cannot write `" + format.file + "`: there is no folder `" + folder.string() + "`");
    if (!file.empty()) check_answer_place(format.file);
    if (!file.empty() && !names.insert(format.file).second)
      fail_usage("U003", "two answers go to the file `" + format.file + "`", "", "a file for each --format");
    if (!file.empty() && !common.force && std::filesystem::is_regular_file(file, error))
      fail("U013", "`" + format.file + "` exists and is not overwritten", "",
           "another file, or --force to replace it");
  }
}

/// The last resort where an exception leaves a thread: memory that is not there is said, not a crash.
[[noreturn]] void end_badly() {
  const char* text = "error[X001]: internal error: an exception left a thread\n";
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    text = "error[X002]: out of memory\n   = help: a smaller scene, or a smaller --resolution\n";
  } catch (const std::system_error&) {
    text = "error[X002]: the system gives no further thread\n   = help: fewer --jobs, or a larger limit\n";
  } catch (...) {
  }
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
  ::_exit(static_cast<int>(ExitStatus::run_failed));
}

ExitStatus run_program(int argc, char** argv) {
  Context context{{argv, argv + argc}, inspect_terminal({}), Log({}, inspect_terminal({}))};
  try {
    Command command = parse_arguments(argc, argv);
    const CommonArguments common = common_of(command);
    context.terminal = inspect_terminal(common);
    context.log = Log(common, context.terminal);
    check_places(common);
    drop_repeats(command, context.log);
    return dispatch(command, context);
  } catch (const InputError& error) {
    return report(error, context.log);
  } catch (const std::bad_alloc&) {
    return report_shortage("out of memory", context.log);
  } catch (const std::filesystem::filesystem_error& error) {
    return report(InputError(file_problem(error), pipeline::write_failure_status(error.code().value())),
                  context.log);
  } catch (const std::system_error& error) {  // a thread that the system does not give
    return report_shortage(error.what(), context.log);
  } catch (const std::exception& error) {
    return report_internal(error.what(), context.log);
  }
}

/// Each replay and each pass takes and frees the same megabytes, images up to 32 MiB a piece. By default they
/// go back to the system each time, and come again as page faults: half of a sweep's time, a tenth of a
/// ranking's.
void keep_freed_memory() {
  constexpr int kMib = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMib);
  mallopt(M_TRIM_THRESHOLD, 256 * kMib);
}

/// A reader that goes away ends no work, and no file gets the number of a stream that the caller closed:
/// answers would be written into it.
void guard_streams() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond `ulimit -f` is one that cannot be written
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", O_RDONLY) < 0) std::_Exit(1);
}

}  // namespace
}  // namespace hwsim::cli

int main(int argc, char** argv) {
  std::set_terminate(hwsim::cli::end_badly);
  hwsim::cli::guard_streams();
  hwsim::cli::keep_freed_memory();
  return static_cast<int>(hwsim::cli::run_program(argc, argv));
}
