#include <algorithm>
#include <filesystem>

#include "hwsim/base/file_name.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/studies/comparison.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

LabeledResult read_result(const fs::path& file) try {
  return {file.parent_path().string(), result_from_json(Json::parse(read_file(file.string()))), {}};
} catch (const Json::exception& error) {
  fail("U020", "`" + file.string() + "` is no result of `hwsim run`: " + error.what());
}

}  // namespace

std::vector<LabeledResult> read_results(const std::string& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return {read_result(path)};
  if (fs::exists(fs::path(path) / "result.json", error)) {
    LabeledResult one = read_result(fs::path(path) / "result.json");
    one.label = path;
    return {one};
  }
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, error))
    if (fs::exists(entry.path() / "result.json", error)) files.push_back(entry.path() / "result.json");
  if (files.empty())
    fail("U020", "`" + path + "` holds no result.json", "", "give a folder that `hwsim run` wrote");
  std::sort(files.begin(), files.end());
  std::vector<LabeledResult> results;
  for (const fs::path& file : files) results.push_back(read_result(file));
  return results;
}

bool is_result(const std::string& name) {
  std::error_code error;
  return fs::is_directory(name, error) || has_extension(name, ".json");
}

Comparison compare_results(const std::vector<std::string>& paths,
                           const cost_models::Calibration* calibration) {
  std::vector<LabeledResult> results;
  for (const std::string& path : paths)
    for (LabeledResult& result : read_results(path)) results.push_back(std::move(result));
  if (results.size() < 2)
    fail_usage("U002", "there is nothing to compare `" + paths.front() + "` with", "",
               "give the folders of two runs");
  return compare(results, calibration);
}

}  // namespace hwsim::lab
