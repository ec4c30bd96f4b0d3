#pragma once
// Flags that several commands share, each group declared once.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/arguments/arguments.h"
#include "cost_models/table_number.h"

namespace hwsim::cli {

/// Takes numbers of the range alone: CLI11's own range lets `nan` pass.
CLI::Validator number_in(const cost_models::NumberRange& range, const std::string& unit = {});
CLI::Validator whole_in(int low, int high);
/// A flag whose value is such a number. Nothing else reads real numbers of flags.
CLI::Option* add_number(CLI::App& app, const std::string& flag, std::optional<double>& target,
                        std::string description, const CLI::Validator& range);
/// A flag that may be given several times, with one value each time.
CLI::Option* add_repeatable(CLI::App& app, const std::string& flag, std::vector<std::string>& target,
                            std::string description, const std::string& type);
void add_common(CLI::App& app, CommonArguments& common);
void add_sets(CLI::App& app, std::vector<std::string>& sets);
void add_overlays(CLI::App& app, std::vector<std::string>& overlays);
void add_out(CLI::App& app, OutPlace& out);
void add_report_file(CLI::App& app, std::string& file);
void add_view_flags(CLI::App& app, ViewArguments& view);
/// The scene itself, then the flags of its view.
void add_view(CLI::App& app, ViewArguments& view, bool required);
/// Which techniques on which GPUs; `techniques`: those that are taken where none is named.
void add_points(CLI::App& app, RunArguments& run, const std::string& techniques = "none");
void add_reference_shadows(CLI::App& app, ViewArguments& view);
void add_reference_samples(CLI::App& app, RunArguments& run);
void add_no_image(CLI::App& app, RunArguments& run);
/// Prices, the limit, and the front.
void add_optimize_goal(CLI::App& app, OptimizeArguments& optimize);
void add_vary(CLI::App& app, std::vector<std::string>& vary, bool& zip);

}  // namespace hwsim::cli
