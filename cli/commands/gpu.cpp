#include <fmt/format.h>

#include <filesystem>

#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "hwsim/base/file_name.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/catalog/data_sheet.h"
#include "lab/catalog/gpu_view.h"
#include "lab/catalog/plausible.h"

namespace hwsim::cli {
namespace {

namespace fs = std::filesystem;

std::optional<double> size_of(const std::string& flag, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::optional<double> kib = size_in_kib(text);
  if (!kib) fail_usage("U003", "`" + text + "` is no size for " + flag, "", flag + " 512K, 36M or 1G");
  return kib;
}

/// Names become files and folders of results.
void require_name(const std::string& id) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (id.empty() || id.front() == '.' || id.front() == '-' || !std::ranges::all_of(id, allowed))
    fail_usage("U003", "`" + id + "` cannot name a GPU", "", "letters, digits, `_`, `-` and `.`");
}

}  // namespace

ExitStatus gpu_new(const GpuNewArguments& options, Context& context) {
  DataSheet sheet = options.sheet;
  require_name(sheet.id);
  sheet.l2_kib = size_of("--l2", options.l2);
  sheet.llc_kib = size_of("--llc", options.llc);
  const Lab lab(lab_options(options.common, context.log));
  SheetGpu made = gpu_of_sheet(load_gpu_from_options(lab.catalog().folder(), options.like, {}, {}), sheet);
  if (has_extension(options.like, ".toml")) made.like = fs::absolute(options.like).string();
  const std::string path = options.out.empty() ? sheet.id + ".toml" : options.out;
  std::error_code error;
  place_of_file(path);
  if (!options.force && fs::exists(fs::symlink_status(path, error)))
    fail("U013", "`" + path + "` exists and is not overwritten", "",
         "another --out, or --force to replace it");
  write_file(path, to_toml(made));
  for (const Diagnostic& warning : implausible_numbers(made.gpu)) context.log.report(warning);
  print(
      {.table = sheet_table(made),
       .footing = fmt::format("\n{} extends {}; next: hwsim run sponza_hall -g {}\n", path, made.like, path)},
      options.common);
  return ExitStatus::done;
}

}  // namespace hwsim::cli
