#include "lab/results/run_directory.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <ctime>

#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/results/folder_exchange.h"
#include "pipeline/base/file_descriptor.h"
#include "pipeline/base/file_io.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_to_write(const fs::path& path, const std::error_code& error) {
  throw InputError(problem("U010", "cannot write `" + path.string() + "`: " + error.message()),
                   pipeline::write_failure_status(error.value()));
}

fs::path default_place(const std::string& id_source) {
  const auto now = std::chrono::system_clock::now();
  const auto ticks = std::to_string(now.time_since_epoch().count());
  const std::string id = hash_hex(id_source + ticks + std::to_string(getpid())).substr(0, 6);
  return fs::path("runs") /
         fmt::format("{:%Y%m%d-%H%M%S}-{}", fmt::localtime(std::chrono::system_clock::to_time_t(now)), id);
}

/// --force deletes: only folders that hwsim wrote, or empty ones.
bool may_be_replaced(const fs::path& place) {
  return fs::is_directory(place) && (fs::is_empty(place) || is_of_hwsim(place));
}

void check_free(const fs::path& place, bool force) {
  std::error_code error;
  if (fs::symlink_status(place, error).type() == fs::file_type::not_found) return;
  if (!force)
    fail("U013", "`" + place.string() + "` exists and is not overwritten", "",
         "another --out, or --force to replace it");
  if (!may_be_replaced(place))
    fail("U013", "`" + place.string() + "` is not a folder of results, --force does not replace it", "",
         "another --out, or remove it yourself");
}

}  // namespace

RunDirectory::RunDirectory(const OutPlace& place, const std::string& id_source)
    : replace_(place.force), named_by_us_(place.directory.empty()) {
  final_ = named_by_us_ ? default_place(id_source) : fs::path(place.directory);
  if (!final_.has_filename()) final_ = final_.parent_path();  // "results/"
  clear_abandoned(final_.parent_path());
  check_free(final_, place.force);
  partial_ = partial_name(final_);
  std::error_code error;
  if (final_.has_parent_path()) made_parent_ = fs::create_directories(final_.parent_path(), error);
  if (!error) fs::create_directory(partial_, error);
  if (error) fail_to_write(final_, error);
  lock_ = std::make_unique<const pipeline::FileDescriptor>(
      ::open(partial_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock_->is_open()) lock_->lock();  // file systems without locks: the next run leaves the folder alone
  // In one call: a kill between a mark's own temporary name and its renaming would leave a folder without it.
  const pipeline::FileDescriptor mark(
      ::open(path(kUnfinishedMark).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
  if (!mark.is_open()) fail_to_write(final_, {errno, std::generic_category()});
}

RunDirectory::~RunDirectory() {
  std::error_code ignored;  // nothing more can be done for a folder that cannot be removed
  if (committed_) return;
  remove_results(partial_);
  if (made_parent_) fs::remove(final_.parent_path(), ignored);  // only when empty
}

void RunDirectory::commit() {
  check_free(final_, replace_);  // somebody may have been faster
  std::error_code error;
  const bool replaces = replace_ && fs::exists(final_, error);
  if (!error) fs::remove(partial_ / kUnfinishedMark, error);
  if (error) fail_to_write(final_, error);
  if (replaces)
    error = exchange_folders(partial_, final_);
  else
    fs::rename(partial_, final_, error);
  if (error) fail_to_write(final_, error);
  committed_ = true;
  if (replaces) remove_results(partial_);  // the old ones; where it fails, the next run tries again
  if (named_by_us_) point_latest_here();
}

void RunDirectory::point_latest_here() const {
  const fs::path link = final_.parent_path() / "latest";
  const fs::path fresh = final_.parent_path() / fmt::format(".latest-{}", getpid());
  std::error_code error;
  fs::create_directory_symlink(final_.filename(), fresh, error);
  if (!error) fs::rename(fresh, link, error);
  if (error) fs::remove(fresh, error);  // a file system without links: the run itself is complete
}

}  // namespace hwsim::lab
