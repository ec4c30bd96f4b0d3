#pragma once
// The folder of a run while the run goes on: each point's files are written when it comes, and the folder
// appears when all is there.
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "lab/point/run_sink.h"
#include "lab/results/picture_writer.h"
#include "lab/results/run_directory.h"
#include "lab/results/run_files.h"

namespace hwsim::lab {

class RunRecord : public RunSink {
 public:
  enum class Layout {
    automatic,       ///< a single point's files stand in the folder itself
    folder_a_point,  ///< every point has its folder
  };
  /// What the record is of. `plan` must outlive it.
  struct Subject {
    const RunPlan& plan;
    std::string id_source;               ///< from which a folder that is not named gets its id
    std::vector<std::string> arguments;  ///< the command line's, where there is one
    Layout layout = Layout::automatic;
    int jobs = 1;  ///< threads: with more than one, pictures are written beside what comes next
  };

  /// Throws InputError as RunDirectory does.
  RunRecord(const OutPlace& place, Subject subject);

  /// Folders of the points that come are called by their view, too.
  void enter(const std::string& view) { view_ = view + "-"; }

  void begin(const RunContext& run) override;
  /// Throws InputError where files cannot be written: pictures of this point or an earlier one, or commit()
  /// does.
  void point(const PointResult& point, const RunContext& run) override;

  /// A place in the folder for one more file.
  std::string path(const std::string& name) const { return directory_.path(name); }
  const std::filesystem::path& partial() const { return directory_.partial(); }

  /// manifest.json as of now; `state` is done or failed.
  nlohmann::ordered_json manifest(const std::string& state) const;
  double wall_s() const;

  /// Waits for the pictures, writes the manifest and the log, and puts the folder in its place, which is
  /// returned.
  std::string commit(const std::string& log);

 private:
  Subject subject_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  RunDirectory directory_;
  PictureWriter pictures_;
  std::string view_;
  std::optional<SceneSummary> scene_;
  std::uint64_t fragments_ = 0;
  double emulation_s_ = 0.0;
  std::uint64_t reused_passes_ = 0;
};

}  // namespace hwsim::lab
