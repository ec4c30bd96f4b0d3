#pragma once
// What hwsim knows by name: for `list`, `show` and completion.
#include <optional>
#include <string>
#include <vector>

#include "lab/base/table.h"
#include "lab/catalog/config_folder.h"
#include "lab/catalog/error_codes.h"

namespace hwsim::lab {

/// One thing that is no GPU: a technique or generator with its parameters, a counter, a published table.
struct CatalogEntry {
  std::string title{};  ///< a line; empty where the table says all
  Table table{};
};

/// Reads files when it is asked, and keeps nothing.
class Catalog {
 public:
  explicit Catalog(ConfigFolder folder = ConfigFolder()) : folder_(std::move(folder)) {}
  const ConfigFolder& folder() const { return folder_; }

  // One row a thing, its name first. Throw InputError where a file cannot be read.
  Table gpus() const;
  Table scenes() const;  ///< generators
  Table techniques() const;
  Table counters() const;
  Table overlays() const;
  Table published_tables() const;
  Table papers() const;   ///< those that `reproduce` takes
  Table codes() const;    ///< those of messages
  Table sources() const;  ///< documents that values of GPU files name by a key, "[B3D-F]"

  /// Those that the texts name.
  Table sources_in(const std::vector<std::string>& texts) const;

  std::vector<ErrorCode> error_codes() const { return lab::error_codes(); }

  /// None when no technique, scene, counter or published table has this name.
  std::optional<CatalogEntry> entry(const std::string& name) const;

  /// Everything that `entry` finds.
  std::vector<std::string> entry_names() const;

 private:
  ConfigFolder folder_;
};

/// A CSV file as a table. Throws InputError.
Table read_table(const std::string& path);

/// First column of a table of the catalog.
std::vector<std::string> names_of(const Table& table);

}  // namespace hwsim::lab
