#pragma once
// The folder of a run: complete, or not there.
#include <filesystem>
#include <memory>
#include <string>

namespace hwsim::pipeline {
class FileDescriptor;
}

namespace hwsim::lab {

/// Where results go.
struct OutPlace {
  std::string directory;  ///< empty: runs/<date>-<time>-<id>
  bool force = false;     ///< an earlier run's folder is replaced
};

/// A folder that appears only when all that belongs in it is there: written beside its place as
/// ".<name>.partial-<pid>" and put in its place by commit(), in one step also where earlier results are
/// replaced. Removed when it is not committed, on Ctrl-C too; what a killed run left is removed by the next.
class RunDirectory {
 public:
  /// Throws InputError U013 when the place is taken (unless place.force and it holds results of hwsim) and
  /// U010 when it cannot be written.
  RunDirectory(const OutPlace& place, const std::string& id_source);
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  const std::filesystem::path& partial() const { return partial_; }
  const std::filesystem::path& final_place() const { return final_; }
  std::string path(const std::string& name) const { return (partial_ / name).string(); }
  void commit();

 private:
  void point_latest_here() const;

  std::filesystem::path final_, partial_;
  std::unique_ptr<const pipeline::FileDescriptor> lock_;  ///< says that a process works on `partial_`
  bool replace_ = false, named_by_us_ = false, made_parent_ = false, committed_ = false;
};

}  // namespace hwsim::lab
