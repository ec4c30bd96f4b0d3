#pragma once
// What hwsim knows by name: for `list`, `show` and completion.
#include <string>
#include <vector>

#include "lab/base/table.h"

namespace hwsim::lab {

Table gpu_catalog();
Table scene_catalog();
Table technique_catalog();
Table counter_catalog_table();
Table table_catalog();  ///< the published tables, configs/published

/// First column of a catalog.
std::vector<std::string> names_of(const Table& catalog);

/// A CSV file as a table. Throws InputError.
Table read_table(const std::string& path);

/// The path of a published table.
std::string published_table_path(const std::string& name);

}  // namespace hwsim::lab
