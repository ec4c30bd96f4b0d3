#pragma once
// What a report shows, gathered: points are asked for again, and come from the cache where nothing changed.
#include <string>
#include <vector>

#include "lab/point/session.h"
#include "lab/report/report.h"
#include "lab/studies/variation.h"

namespace hwsim::lab {

/// Most points that a report holds: each brings its trace and pictures.
inline constexpr std::size_t kReportPointsMax = 32;

/// Folders of runs and rankings, run.toml files, databases of sweeps, and JSON of `compare` and `rank`.
/// Throws InputError U020 for anything else, U023 when there are no points at all, or more than
/// kReportPointsMax.
Report gather_report(const std::vector<std::string>& inputs, Session& session);

/// The points of a request, and its variations as hardware to which they can be moved.
Report gather_report(const Request& request, const std::vector<Variation>& variations,
                     const std::optional<Comparison>& comparison, Session& session);

/// A paper's tables, laid out as the paper has them. It holds no points.
Report gather_report(const Reproduction& reproduction, Session& session);

}  // namespace hwsim::lab
