#pragma once
// The tables of a report as they stand in its page without a script.
#include <vector>

#include "lab/base/table.h"
#include "lab/report/report.h"

namespace hwsim::lab {

Table point_table(const Report& report);            ///< a row a point
Table pass_table(const ReportedPoint& point);       ///< a row a pass: time, limiter, use of each unit
Table byte_table(const ReportedPoint& point);       ///< a row a pass: DRAM bytes by stream
Table flow_table(const ReportedPoint& point);       ///< a row a stage: in, killed, out
Table influence_table(const ReportedPoint& point);  ///< a row a number of the GPU that matters
Table memory_table(const ReportedPoint& point);     ///< a row an image or buffer

}  // namespace hwsim::lab
