#include "lab/store/cache_entries.h"

#include "lab/store/reference_image.h"
#include "lab/store/trace_store.h"

namespace hwsim::lab {
namespace {

constexpr const char* kUnread = "of another version, or damaged";

std::string frame_entry(const CachedFile& file, const Cache& cache) {
  const bool is_image = file.path.extension() == ".image";
  std::filesystem::path trace = file.path;
  trace.replace_extension(".trace");
  const std::optional<std::string> title = frame_title(trace.string(), cache);
  return std::string(is_image ? "images" : "work") + (title ? " of " + *title : std::string(", ") + kUnread);
}

/// "sponza_hall-2f3ff73fab922de4" is the generator with a hash.
std::string scene_entry(const CachedFile& file) {
  const std::string name = file.path.stem().string();
  if (file.path.extension() == ".summary") return "what the loader found in a scene file";
  return "scene made by " + name.substr(0, name.rfind('-'));
}

}  // namespace

std::string entry_title(const CachedFile& file, const Cache& cache) {
  if (file.folder == "traces") return frame_entry(file, cache);
  if (file.folder == "scenes") return scene_entry(file);
  if (file.folder == "durations") return "how long the same work took";
  const std::optional<std::string> title = reference_title(file.path.string(), cache);
  return std::string("ray-traced reference, ") + (title ? *title : kUnread);
}

}  // namespace hwsim::lab
