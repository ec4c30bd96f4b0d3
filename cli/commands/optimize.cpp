#include <fmt/format.h>

#include "cli/arguments/requests.h"
#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "lab/base/messages.h"
#include "lab/base/text.h"
#include "lab/studies/axes.h"

namespace hwsim::cli {
namespace {

std::string titled(const std::string& title, const Table& table) {
  return table.rows.empty() ? "" : "\n" + title + "\n\n" + to_text(table);
}

std::string as_words(const std::vector<Assignment>& sets) {
  std::string text;
  for (const Assignment& set : sets)
    if (set.group() == "gpu" || set.path == "timing.calibrated")
      text += " --set " + shell_word(set.path + "=" + set.value);
  return text;
}

/// The words that make the best GPU again: the one that was given, and what is laid over it.
std::string as_settings(const Optimization& found, const Request& request) {
  if (found.settings.empty()) return "";
  std::string text = "\nThis GPU: -g " + shell_word(request.gpus.front());
  for (const std::string& overlay : request.overlays) text += " --overlay " + shell_word(overlay);
  return text + as_words(request.sets) + as_words(found.settings) + "\n";
}

}  // namespace

ExitStatus optimize(const OptimizeArguments& options, Context& context) {
  if (options.goal.time_ms && options.goal.area)
    fail_usage("U003", "--time-ms and --area exclude each other", "", "the one that is a limit");
  const PointSettings frames(parse_axes(options.vary), options.zip ? Combine::zip : Combine::grid);
  Lab lab(lab_options(options, context.log));
  const Request request = request_of(options);
  const Optimization found = lab.optimize(request, frames, options.prices, options.goal);
  const nlohmann::ordered_json json = to_json(found);
  const bool front_is_answer = !found.best;
  print({.table = front_is_answer ? optimized_front(found) : optimized_keys(found),
         .heading = answer_of(found) + "\n\n",
         .footing = front_is_answer ? ""
                                    : titled("Frames", optimized_frames(found)) +
                                          titled("Nobody is smaller and faster", optimized_front(found)) +
                                          as_settings(found, request),
         .json = &json},
        options.common);
  context.log.say(fmt::format("{} frames timed", found.replays));
  return found.met ? ExitStatus::done : ExitStatus::check_not_met;
}

}  // namespace hwsim::cli
