#pragma once
// Messages to the user about the user's input: what is wrong, where, what was meant, how to go on.
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace hwsim {

enum class Severity { note, warning, error };

/// A place in an input file. line and column count from 1; 0 means "unknown" (binary files, command line).
struct SourcePlace {
  std::string file;
  int line = 0;
  int column = 0;
  int length = 1;           ///< columns to underline
  std::string line_text{};  ///< the line itself, without its newline; empty when unknown
};

struct Diagnostic {
  Severity severity = Severity::error;
  std::string code;     ///< stable, e.g. "C012"; `hwsim help C012` explains it
  std::string message;  ///< one sentence, lower case, no full stop
  SourcePlace place{};
  std::string hint{};  ///< stands beside the underlining: "did you mean `l2_size_kib`?"
  std::vector<std::string> notes{};
  std::string help{};  ///< how to go on: a command, or what to change
};

/// Exit statuses of the program (docs/results.md#exit-status).
enum class ExitStatus {
  done = 0,
  run_failed = 1,
  usage = 2,
  invalid_input = 3,
  check_not_met = 4,
  some_points_failed = 5
};

/// Bad input. Thrown with all diagnostics found, first cause first; nothing has been written by then.
class InputError : public std::runtime_error {
 public:
  explicit InputError(Diagnostic diagnostic, ExitStatus status = ExitStatus::invalid_input);
  explicit InputError(std::vector<Diagnostic> diagnostics, ExitStatus status = ExitStatus::invalid_input);
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
  ExitStatus status() const { return status_; }

 private:
  std::vector<Diagnostic> diagnostics_;
  ExitStatus status_;
};

/// The message in the shape of docs/architecture.md#errors, ending in a newline.
std::string render(const Diagnostic& diagnostic, bool color);

/// As many messages of one input are shown: the first causes. The others are counted in one more.
inline constexpr std::size_t kProblemsShown = 20;
/// Cuts `problems` to kProblemsShown, the last of which says how many are left out.
void keep_first(std::vector<Diagnostic>& problems);

/// At most `bytes_max` bytes of `text` from `first` on, without parts of UTF-8 characters at the ends.
std::string_view whole_characters(std::string_view text, std::size_t first, std::size_t bytes_max);

/// A name for a message: its beginning and "..." where it is long.
std::string shortened(std::string_view name);

/// The candidate that is `name` but for case and separators, else one that begins with it, else the nearest
/// by letters (a swap counts 1), or "" if more than a third of the longer name's letters differ.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "did you mean `msaa2x` or `msaa4x`?": those that nearest_name chooses from, three at most; "" for none.
std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace hwsim
