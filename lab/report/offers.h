#pragma once
// What a report offers beside its points: other hardware, and what its readers must know.
#include "lab/catalog/config_files.h"
#include "lab/report/report.h"

namespace hwsim::lab {

/// The GPUs of the points, then all others of the configuration, with the intervals of each point on each.
void offer_gpus(Report& report, ConfigFiles& files);

/// Every overlay that comes with hwsim.
void offer_what_ifs(Report& report, const ConfigFolder& folder);

/// What its readers must know of the frames: what is not modeled, extrapolated, or by default.
void note_limits(Report& report);

}  // namespace hwsim::lab
