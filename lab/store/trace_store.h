#pragma once
// Work traces by what they depend on: in memory, on disk, or emulated now. Everything that times frames asks
// here, so that varying a GPU's numbers never draws again.
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lab/store/scene_view.h"
#include "pipeline/emulate/emulator.h"
#include "pipeline/emulate/pass_memo.h"

namespace hwsim::lab {

using ProgressFunction = std::function<void(double done_ratio, const std::string& what)>;

struct FrameNeeds {
  pipeline::SkipSwitches skip;
  bool image = false;  ///< the image and the heat map too; without, Emulation::color may be empty
};

struct EmulatedFrame {
  std::shared_ptr<const pipeline::Emulation> emulation;  ///< wall_s: what getting it took this time
  bool from_cache = false;  ///< whether it was kept by this process or on the disk
};

/// What a trace in the cache is of: "msaa4x of sponza_hall, 320x180"; none where this version cannot read it.
std::optional<std::string> frame_title(const std::string& path, const Cache& cache);

class TraceStore {
 public:
  struct Options {
    int jobs = 1;
    bool disk = true;                       ///< false: neither reads nor writes cached traces
    std::uint64_t shared_passes_bytes = 0;  ///< images that frames share may take; 0: they share nothing
  };
  /// Both must outlive the store.
  TraceStore(const Options& options, const Cache& cache, Observer& observer)
      : options_(options), cache_(cache), observer_(observer), memo_(options.shared_passes_bytes) {}

  /// Only features and limits of `gpu` matter. Throws InputError where the technique cannot run on it,
  /// InternalError where counters of the work break a law.
  EmulatedFrame frame(SceneView& scene, const algos::TechniqueChoice& technique, const GpuConfig& gpu,
                      const FrameNeeds& needs, const ProgressFunction& progress);

  struct WantedFrame {
    const algos::TechniqueChoice* technique;
    const GpuConfig* gpu;
  };
  /// What frame() will be asked for next, in this order: passes that these frames share are emulated once.
  void expect(SceneView& scene, std::span<const WantedFrame> frames, const FrameNeeds& needs);
  void expect_nothing() { memo_.clear(); }

  /// Why the technique cannot run on the GPU; none where it can, or where its trace is kept.
  std::vector<Diagnostic> problems(SceneView& scene, const algos::TechniqueChoice& technique,
                                   const GpuConfig& gpu, const FrameNeeds& needs) const;

  /// Whether the frame is in memory.
  bool holds(const SceneView& scene, const algos::TechniqueChoice& technique, const GpuConfig& gpu,
             const FrameNeeds& needs) const;

  /// Whether the frame is in memory or on the disk.
  bool is_kept(const SceneView& scene, const algos::TechniqueChoice& technique, const GpuConfig& gpu,
               const FrameNeeds& needs) const;

  /// All that the work of a frame depends on, but the program itself, as text.
  static std::string work_text(const SceneView& scene, const algos::TechniqueChoice& technique,
                               const GpuConfig& gpu, const FrameNeeds& needs);

 private:
  struct Kept {
    std::string key;
    std::shared_ptr<const pipeline::Emulation> emulation;
  };
  std::shared_ptr<const pipeline::Emulation> in_memory(const std::string& key, bool image) const;
  std::shared_ptr<const pipeline::Emulation> on_disk(const std::string& key, const SceneView& scene,
                                                     bool image);
  std::shared_ptr<const pipeline::Emulation> emulate(SceneView& scene,
                                                     const algos::TechniqueChoice& technique,
                                                     const GpuConfig& gpu, const FrameNeeds& needs,
                                                     const ProgressFunction& progress);
  void keep(const std::string& key, std::shared_ptr<const pipeline::Emulation> emulation);

  std::string frame_path(const std::string& key) const;
  std::string image_path(const std::string& key) const;

  Options options_;
  const Cache& cache_;
  Observer& observer_;
  std::vector<Kept> kept_;  ///< the newest last
  pipeline::PassMemo memo_;
};

}  // namespace hwsim::lab
