#include "lab/report/report_inputs.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "hwsim/base/file_name.h"
#include "lab/base/files.h"
#include "lab/base/messages.h"
#include "lab/request/run_file.h"
#include "lab/studies/sweep_rows.h"
#include "lab/studies/sweep_store.h"

namespace hwsim::lab {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kSweepPoints = 12;   ///< points of a sweep whose traces are taken
constexpr std::size_t kSweepRows = 2'000;  ///< rows of a sweep that are shown

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

[[noreturn]] void no_input(const std::string& path) {
  fail("U020", "`" + path + "` is nothing that a report can be made of", "",
       "a folder of `hwsim run` or `hwsim rank`, a run.toml, the database of a sweep, or the JSON of "
       "`hwsim compare --json` or `hwsim rank --json`");
}

ReportInput read_json(const std::string& path) try {
  const Json json = Json::parse(read_file(path));
  ReportInput input;
  if (json.contains("baseline"))
    input.comparison = comparison_from_json(json);
  else if (json.contains("techniques") || json.contains("rankings"))
    input.rankings = rankings_from_json(json);
  else
    no_input(path);
  std::erase_if(input.rankings, [](const Ranking& ranking) { return ranking.techniques.empty(); });
  return input;
} catch (const Json::exception& error) {
  fail("U020", "`" + path + "` is no answer of `hwsim compare` or `hwsim rank`: " + error.what());
}

/// The first point of each technique and GPU: others differ in numbers that the page can move.
ReportInput read_sweep(const std::string& path) {
  ReportInput input;
  const RowSource rows = sweep_rows(path);
  ReportedSweep& sweep = input.sweep.emplace(ReportedSweep{{rows.columns, {}}, findings_of(rows)});
  rows.each([&](const std::vector<TableCell>& row) {
    if (sweep.rows.rows.size() < kSweepRows) sweep.rows.rows.push_back(row);
  });
  Database database = open_sweep(path, SweepAccess::look);
  Database::Statement select(
      database, "SELECT technique, gpu, run_file, gpu_file FROM point WHERE state = 'done' ORDER BY number");
  std::set<std::pair<std::string, std::string>> seen;
  input.files = std::make_shared<const TemporaryFolder>();
  while (select.step() && input.requests.size() < kSweepPoints) {
    if (!seen.emplace(select.text(0), select.text(1)).second) continue;
    const fs::path place = input.files->path() / std::to_string(input.requests.size());
    fs::create_directory(place);
    write_file((place / "run.toml").string(), select.text(2));
    write_file((place / "gpu.toml").string(), select.text(3));
    input.requests.push_back(read_run_file((place / "run.toml").string()));
  }
  return input;
}

[[noreturn]] void damaged_manifest(const fs::path& manifest, const std::string& what) {
  fail("U020", "`" + manifest.string() + "` is damaged: " + what, "",
       "the folder as `hwsim run` wrote it, or without its manifest.json");
}

/// The techniques of a manifest's points.
std::vector<std::string> asked_techniques(const fs::path& manifest) {
  const Json json = Json::parse(read_file(manifest.string()), nullptr, false);
  if (!json.is_object()) damaged_manifest(manifest, "it is no JSON object");
  const Json points = json.value("points", Json::array());
  if (!points.is_array()) damaged_manifest(manifest, "`points` is no list");
  std::vector<std::string> asked;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto technique = points[i].find("technique");  // an end, too, where it is no object
    if (technique == points[i].end() || !technique->is_string())
      damaged_manifest(manifest, "`points[" + std::to_string(i) + "].technique` is no text");
    asked.push_back(technique->get<std::string>());
  }
  return asked;
}

/// Techniques in the order in which they were asked for, where a manifest says it.
void order_as_asked(std::vector<Request>& requests, const fs::path& manifest) {
  if (!is_there(manifest)) return;
  const std::vector<std::string> asked = asked_techniques(manifest);
  std::ranges::stable_sort(requests, std::less{}, [&](const Request& request) {
    return std::ranges::find(asked, request.techniques.front()) - asked.begin();
  });
}

/// The files of one run, of several side by side, or of several in each view of a ranking.
std::vector<fs::path> run_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (is_there(folder / "run.toml")) files.push_back(folder / "run.toml");
  std::error_code error;
  fs::recursive_directory_iterator entries(folder, error);
  constexpr int kDeepest = 1;  // folders of a view hold folders of points
  for (; !error && entries != fs::end(entries); entries.increment(error)) {
    if (is_there(entries->path() / "run.toml")) files.push_back(entries->path() / "run.toml");
    if (entries.depth() >= kDeepest) entries.disable_recursion_pending();
  }
  std::ranges::sort(files);
  return files;
}

ReportInput read_folder(const fs::path& folder) {
  ReportInput input;
  for (const char* file : {"ranking.json", "rankings.json"})
    if (is_there(folder / file)) input.rankings = read_json((folder / file).string()).rankings;
  const std::vector<fs::path> files = run_files(folder);
  for (const fs::path& file : files) input.requests.push_back(read_run_file(file.string()));
  order_as_asked(input.requests, folder / "manifest.json");
  if (files.empty()) no_input(folder.string());
  return input;
}

}  // namespace

ReportInput read_report_input(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return read_folder(path);
  if (!is_there(path)) fail("U011", "there is no `" + path + "`");
  if (has_extension(path, ".json")) return read_json(path);
  if (has_extension(path, ".toml")) return {.requests = {read_run_file(path)}};
  return read_sweep(path);
}

}  // namespace hwsim::lab
