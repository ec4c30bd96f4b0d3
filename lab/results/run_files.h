#pragma once
// The files of a run directory (docs/results.md).
#include <string>

#include "lab/results/results.h"
#include "lab/results/run_directory.h"

namespace hwsim::lab {

/// Everything that belongs to one point but its pictures (picture_writer.h): result.json, tables, trace, and
/// a run.toml with its gpu.toml.
void write_point_files(const std::string& folder, const PointResult& point, const RunPlan& plan,
                       const std::string& scene_name);

struct ManifestInput {
  std::vector<std::string> arguments;  ///< words of the command line, where there is one
  const RunPlan* plan = nullptr;
  const SceneSummary* scene = nullptr;  ///< none: not loaded yet
  double wall_s = 0.0;
  std::uint64_t fragments = 0;  ///< shaded by emulations of this run
  double emulation_s = 0.0;
  std::uint64_t reused_passes = 0;  ///< that points share and were emulated once
  std::string state;                ///< done, failed
};
nlohmann::ordered_json manifest(const ManifestInput& input);

/// JSON Schema (draft 2020-12) of a manifest.json: of the request's values all, of the rest what every
/// manifest has.
std::string manifest_schema_json();

/// "msaa4x@gtx980": a point's folder in a run of several, without characters that file systems or shells
/// mind.
std::string point_folder(const PointResult& point);

}  // namespace hwsim::lab
