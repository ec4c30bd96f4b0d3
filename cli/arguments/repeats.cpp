#include "cli/arguments/repeats.h"

#include <fmt/format.h>

#include <set>
#include <type_traits>

#include "algos/techniques.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/studies/axes.h"

namespace hwsim::cli {
namespace {

using Words = std::vector<std::string>;

/// What came again, in all lists of a command.
class Repeats {
 public:
  void drop(Words& words) {
    drop(words, [](const std::string& word) { return word; });
  }
  /// "msaa:samples=4" is "msaa4x" again.
  void drop_techniques(Words& words) {
    drop(words);  // first as they are written, which is quick for thousands
    drop(words, whole_technique);
  }
  void drop_what_ifs(Words& lists) {
    Words words;
    for (const std::string& list : lists)
      for (std::string& what_if : split(list, ',')) words.push_back(std::move(what_if));
    drop(words);
    lists = std::move(words);
  }
  void drop_values(std::string& vary) try {
    Axis axis = parse_axis(vary);
    const std::size_t before = axis.values.size();
    if (axis.range) return;
    drop(axis.values);
    if (axis.values.size() != before) vary = axis.path + "=" + fmt::format("{}", fmt::join(axis.values, ","));
  } catch (const InputError&) {  // told where it is used
  }

  void tell(Observer& log) const {
    constexpr std::size_t kShown = 5;
    if (found_.empty()) return;
    Words shown;
    for (const std::string& word : found_)
      if (shown.size() < kShown) shown.push_back("`" + word + "`");
    Diagnostic note =
        problem("U024", fmt::format("named more than once, and taken once: {}{}", fmt::join(shown, ", "),
                                    found_.size() > kShown ? ", ..." : ""));
    note.severity = Severity::note;
    log.report(note);
  }

 private:
  static std::string whole_technique(const std::string& text) try {
    return algos::technique_text(algos::parse_technique(text), true);
  } catch (const InputError&) {  // told with all other problems
    return text;
  }
  template <class Whole>
  void drop(Words& words, Whole whole) {
    std::set<std::string> known;
    std::erase_if(words, [&](const std::string& word) {
      const bool again = !known.insert(whole(word)).second;
      if (again) found_.insert(word);
      return again;
    });
  }

  std::set<std::string> found_;
};

template <class Options>
void drop_from(Options& options, Repeats& repeats) {
  if constexpr (std::is_base_of_v<RunArguments, Options>) {
    repeats.drop_techniques(options.techniques);
    repeats.drop(options.gpus);
  }
  if constexpr (requires { options.what_ifs; }) repeats.drop_what_ifs(options.what_ifs);
  if constexpr (requires { options.sample; })
    if (options.sample) return;  // a value that is named twice is drawn twice as often
  if constexpr (requires { options.vary; })
    for (std::string& vary : options.vary)
      if (!options.zip) repeats.drop_values(vary);
  if constexpr (std::is_same_v<Options, ReportArguments>) repeats.drop(options.inputs);
  if constexpr (requires { options.papers; }) repeats.drop(options.papers);
}

}  // namespace

void drop_repeats(Command& command, Observer& log) {
  Repeats repeats;
  std::visit([&](auto& options) { drop_from(options, repeats); }, command);
  repeats.tell(log);
}

}  // namespace hwsim::cli
