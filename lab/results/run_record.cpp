#include "lab/results/run_record.h"

#include "lab/base/files.h"
#include "lab/base/json_text.h"

namespace hwsim::lab {

RunRecord::RunRecord(const OutPlace& place, Subject subject)
    : subject_(std::move(subject)), directory_(place, subject_.id_source), pictures_(subject_.jobs) {}

void RunRecord::begin(const RunContext& run) { scene_ = run.scene; }

void RunRecord::point(const PointResult& point, const RunContext& run) {
  const bool alone = run.plan.techniques.size() * run.plan.gpus.size() == 1;
  const bool in_front = alone && subject_.layout == Layout::automatic;
  const std::string folder =
      in_front ? directory_.partial().string() : directory_.path(view_ + point_folder(point));
  write_point_files(folder, point, run.plan, run.scene.name);
  if (run.plan.images) pictures_.write(folder, point, run.reference);
  if (point.from_cache) return;
  fragments_ += shader_invocations(point.emulation->trace);
  emulation_s_ += point.emulation->wall_s;
  reused_passes_ += point.emulation->reused_passes;
}

double RunRecord::wall_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

nlohmann::ordered_json RunRecord::manifest(const std::string& state) const {
  return lab::manifest({.arguments = subject_.arguments,
                        .plan = &subject_.plan,
                        .scene = scene_ ? &*scene_ : nullptr,
                        .wall_s = wall_s(),
                        .fragments = fragments_,
                        .emulation_s = emulation_s_,
                        .reused_passes = reused_passes_,
                        .state = state});
}

std::string RunRecord::commit(const std::string& log) {
  pictures_.finish();
  write_file(directory_.path("manifest.json"), json_text(manifest("done")));
  write_file(directory_.path("log.txt"), log);
  directory_.commit();
  return directory_.final_place().string();
}

}  // namespace hwsim::lab
