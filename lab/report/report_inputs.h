#pragma once
// What stands in the folders and files that a report is made of: the requests of their points, and what a
// study found.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lab/base/files.h"
#include "lab/report/report.h"
#include "lab/request/request.h"

namespace hwsim::lab {

struct ReportInput {
  std::vector<Request> requests{};  ///< a point each
  std::vector<Ranking> rankings{};
  std::optional<Comparison> comparison{};
  std::optional<ReportedSweep> sweep{};
  std::shared_ptr<const TemporaryFolder> files{};  ///< that requests of a sweep name
};

/// Throws InputError U020 for what no command of hwsim wrote, and what reading it throws.
ReportInput read_report_input(const std::string& path);

}  // namespace hwsim::lab
