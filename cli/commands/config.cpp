#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "lab/base/messages.h"
#include "lab/catalog/data_sheet.h"
#include "lab/catalog/gpu_view.h"
#include "lab/catalog/plausible.h"
#include "lab/request/run_file.h"
#include "lab/results/run_files.h"

namespace hwsim::cli {
namespace {

/// Every file is looked at before the first mistake is reported. A file of kind "run" is one too.
ExitStatus check(const ConfigArguments& options, const ConfigFolder& folder, Log& log) {
  std::vector<Diagnostic> problems;
  Table table{{{"file", "file"}, {"id", "id"}, {"state", "state"}}, {}};
  for (const std::string& name : options.names) try {
      if (name.ends_with("run.toml")) {
        load_gpu_from_options(folder, read_run_file(name).gpus.front(), {}, {});
        table.rows.push_back({name, "run", "ok"});
      } else {
        const GpuConfig gpu = load_gpu_from_options(folder, name, {}, {});
        for (const Diagnostic& warning : kept_rates(gpu)) log.report(warning);
        for (const Diagnostic& warning : implausible_numbers(gpu)) log.report(warning);
        table.rows.push_back({name, gpu.id, "ok"});
      }
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  print({.table = table}, options.common);
  if (!problems.empty()) throw InputError(problems);
  return ExitStatus::done;
}

std::string schema_of(const std::vector<std::string>& names) {
  if (names.empty() || names.front() == "gpu") return gpu_schema_json();
  if (names.front() == "run") return run_schema_json();
  if (names.front() == "manifest") return manifest_schema_json();
  fail_usage("U003", "no schema of `" + names.front() + "`, only of gpu, run and manifest");
}

}  // namespace

ExitStatus config(const ConfigArguments& options, Context& context) {
  using Action = ConfigArguments::Action;
  const Lab lab(lab_options(options.common, context.log));
  const ConfigFolder& folder = lab.catalog().folder();
  const auto load = [&](size_t i) {
    return load_gpu_from_options(folder, options.names[i], options.overlays, options.sets);
  };
  switch (options.action) {
    case Action::check:
      return check(options, folder, context.log);
    case Action::show:
      if (options.common.formats.empty())
        write_output(show(load(0), options.origin));
      else
        print({.table = key_table(load(0), options.origin)}, options.common);
      break;
    case Action::schema:
      write_output(schema_of(options.names));
      break;
    case Action::diff: {
      const Table table = difference_table(load(0), load(1));
      print({.table = table}, options.common);
      if (table.rows.empty()) context.log.say("no differences");
    }
  }
  return ExitStatus::done;
}

}  // namespace hwsim::cli
