#include <map>

#include "cli/commands/commands.h"
#include "cli/commands/lab_options.h"
#include "cli/terminal/answer.h"
#include "lab/base/messages.h"
#include "lab/request/settings_table.h"

namespace hwsim::cli {

ExitStatus list(const ListArguments& options, Context& context) {
  static const std::map<std::string, Table (Catalog::*)() const> catalogs = {
      {"gpus", &Catalog::gpus},
      {"scenes", &Catalog::scenes},
      {"techniques", &Catalog::techniques},
      {"counters", &Catalog::counters},
      {"overlays", &Catalog::overlays},
      {"tables", &Catalog::published_tables},
      {"papers", &Catalog::papers},
      {"codes", &Catalog::codes},
      {"sources", &Catalog::sources}};
  if (options.what == "settings") {
    print({.table = settings_table()}, options.common);
    return ExitStatus::done;
  }
  const auto found = catalogs.find(options.what);
  if (found == catalogs.end()) {
    std::vector<std::string> names = {"settings"};
    for (const auto& [name, catalog] : catalogs) names.push_back(name);
    fail_usage("U003",
               "cannot list `" + options.what +
                   "`, only gpus, scenes, techniques, counters, overlays, tables, papers, "
                   "sources, settings or codes",
               did_you_mean(options.what, names));
  }
  const Lab lab(lab_options(options.common, context.log));
  const Table table = (lab.catalog().*found->second)();
  print({.table = table}, options.common);
  if (table.rows.empty()) context.log.say("no " + options.what + " come with this version");
  return ExitStatus::done;
}

}  // namespace hwsim::cli
