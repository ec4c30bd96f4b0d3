#include <functional>
#include <map>

#include "cli/commands/commands.h"
#include "cli/terminal/answer.h"
#include "lab/base/messages.h"
#include "lab/catalog/catalog.h"
#include "lab/catalog/overlays.h"

namespace hwsim::cli {

ExitStatus list(const ListOptions& options, Context& context) {
  static const std::map<std::string, std::function<Table()>> catalogs = {{"gpus", gpu_catalog},
                                                                         {"scenes", scene_catalog},
                                                                         {"techniques", technique_catalog},
                                                                         {"counters", counter_catalog_table},
                                                                         {"overlays", overlay_catalog},
                                                                         {"tables", table_catalog}};
  const auto found = catalogs.find(options.what);
  if (found == catalogs.end()) {
    std::vector<std::string> names;
    for (const auto& [name, catalog] : catalogs) names.push_back(name);
    fail_usage(
        "U003",
        "cannot list `" + options.what + "`, only gpus, scenes, techniques, counters, overlays or tables",
        did_you_mean(options.what, names));
  }
  const Table table = found->second();
  print({.table = table}, options.common);
  if (table.rows.empty()) context.log.say("no " + options.what + " come with this version");
  return ExitStatus::done;
}

}  // namespace hwsim::cli
