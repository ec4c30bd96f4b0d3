#pragma once
// The points of a sweep, each made when it is asked for: a plan of a million points takes a few bytes for
// each.
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lab/point/session.h"
#include "lab/studies/axes.h"
#include "lab/studies/sweep_store.h"

namespace hwsim::lab {

/// A point with all that it takes to run it; valid as long as the session.
struct PlannedPoint {
  std::string id{};  ///< hash of the resolved configuration, the scene's content and the model's version
  std::int64_t number = 0;  ///< from 1
  std::vector<Assignment> settings{};
  std::shared_ptr<const RunPlan> plan;
  const algos::TechniqueChoice* technique = nullptr;  ///< the plan's
  GpuConfig gpu{};
  SceneView* scene = nullptr;  ///< the session's
};

class SweepPlan {
 public:
  SweepPlan() = default;
  /// Each list of settings gives each technique on each GPU a point. Throws InputError with the problems of
  /// all points, each once and at most about twenty. The session must outlive the plan.
  SweepPlan(Request request, PointSettings settings, Session& session);

  std::size_t size() const { return work_.size(); }
  PlannedPoint operator[](std::size_t index) const;
  /// Points of one number share an emulation.
  std::uint32_t work(std::size_t index) const { return work_[index]; }

  /// What the database keeps of the point.
  SweepPoint row(std::size_t index) const;

  /// What is emulated for the points: how many frames there are, that of a point, the scene of a frame.
  std::size_t works() const { return scene_of_work_.size(); }
  std::uint32_t work_of(std::size_t index) const { return work_[index]; }
  std::uint32_t scene_of(std::uint32_t work) const { return scene_of_work_[work]; }

  /// All points, those of a scene and of an emulation one after another.
  std::vector<std::uint32_t> order() const;

 private:
  /// What points share whose settings differ in numbers of GPUs alone.
  struct Group {
    std::shared_ptr<const RunPlan> plan;
    SceneView* scene = nullptr;
    std::vector<std::string> gpus, overlay_files;
    std::vector<std::string> run_files;  ///< by technique
    std::vector<std::string> works;      ///< what is emulated, by technique and GPU
  };
  const Group& group_of(const std::vector<Assignment>& settings) const;
  Group make_group(const std::vector<Assignment>& settings) const;
  GpuConfig gpu_of(const Group& group, std::size_t gpu, const std::vector<Assignment>& settings) const;
  std::string work_of(const Group& group, std::size_t technique, std::size_t gpu, const GpuConfig& config,
                      const std::vector<Assignment>& settings) const;
  void check(const std::vector<Assignment>& settings);
  std::size_t techniques() const { return request_.techniques.size(); }
  std::size_t gpus() const { return gpus_; }

  Request request_{};
  PointSettings settings_{};
  Session* session_ = nullptr;
  std::size_t gpus_ = 1;                           ///< for each list of settings
  mutable std::map<std::string, Group> groups_{};  ///< by their settings; not all that were ever used
  std::map<std::string, std::uint32_t> works_{};   ///< numbers of what is emulated
  std::map<std::string, std::uint32_t> scenes_{};  ///< numbers of the scenes that are loaded for it
  std::vector<std::uint32_t> scene_of_work_{};
  std::vector<std::uint32_t> work_{};  ///< by point
};

/// The points as they are planned, nothing run.
RowSource planned_rows(const SweepPlan& plan);

}  // namespace hwsim::lab
