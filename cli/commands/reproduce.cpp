#include <fmt/format.h>

#include <algorithm>

#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/commands/report_file.h"
#include "cli/terminal/answer.h"
#include "lab/studies/published_runs.h"

namespace hwsim::cli {
namespace {

bool is_claim(const ReproducedRow& row) { return row.cell.use == cost_models::RowUse::claim; }

std::string figures_text(const Reproduction& reproduction) {
  if (std::ranges::all_of(reproduction.rows, is_claim))
    return fmt::format(
        "this paper printed no times and no counts: {} claims in words, which --format csv lists\n",
        reproduction.rows.size());
  if (!reproduction.figures) return "no fitted row could be run\n";
  const cost_models::Figures& f = *reproduction.figures;
  return fmt::format(
      "{} fitted times: MAPE {:.1f} %, median {:.1f} %, Kendall {:.2f}, {:.0f} % inside their intervals\n",
      f.cells, f.mape_pct, f.median_ape_pct, f.kendall, f.coverage90_pct);
}

bool is_text(const FormatRequest& request) {
  return request.format == OutputFormat::table || request.format == OutputFormat::md;
}

/// People read fewer columns than programs: each kind of format gets its own table.
void print_both(const Reproduction& reproduction, const CommonArguments& options) {
  CommonArguments text = options, data = options;
  std::erase_if(text.formats, [](const FormatRequest& f) { return !is_text(f); });
  std::erase_if(data.formats, is_text);
  if (options.formats.empty() || !text.formats.empty())
    print({.table = short_reproduction_table(reproduction), .footing = "\n" + figures_text(reproduction)},
          text);
  if (!data.formats.empty()) print({.table = reproduction_table(reproduction)}, data);
}

}  // namespace

ExitStatus reproduce(const ReproduceArguments& options, Context& context) {
  check_report_place(options.report, options.common.force);
  Lab lab(lab_options(options.common, context.log));
  if (options.dry_run) {
    print({.table = plan_table(published_cells({options.paper}, lab.catalog().folder()))}, options.common);
    return ExitStatus::done;
  }
  const Reproduction reproduction = lab.reproduce(options.paper);
  print_both(reproduction, options.common);
  write_report(lab, options.report, context, [&] { return lab.report_of_paper(reproduction); });
  return ExitStatus::done;
}

}  // namespace hwsim::cli
