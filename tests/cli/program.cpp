#include "cli/program.h"
#include "support/places.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace hwsim::cli::test {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) { return "'" + text + "'"; }

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

const char* const kTriangleGltf = R"({
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]
})";

Workplace::Workplace() {
  std::string name = (fs::temp_directory_path() / "hwsim-cli-test-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  folder_ = name;
}

Workplace::~Workplace() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

Outcome Workplace::shell(const std::string& command) const {
  const fs::path errors = folder_.string() + ".stderr";
  const std::string program_folder = fs::path(HWSIM_PROGRAM).parent_path().string();
  const std::string line = "cd " + quoted(folder_.string()) + " && export PATH=" + quoted(program_folder) +
                           ":\"$PATH\" HWSIM_CACHE=" + quoted(hwsim::test::binary_dir() + "/test-cache") +
                           " && { " + command + "\n} 2>" + quoted(errors.string());
  FILE* pipe = popen(line.c_str(), "r");
  if (!pipe) throw std::runtime_error("popen");
  Outcome outcome;
  char buffer[4096];
  while (const size_t count = std::fread(buffer, 1, sizeof buffer, pipe)) outcome.out.append(buffer, count);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.err = content(errors);
  fs::remove(errors);
  return outcome;
}

Outcome Workplace::hwsim(const std::string& arguments, const std::string& environment) const {
  return shell(environment + (environment.empty() ? "" : " ") + "hwsim " + arguments);
}

void Workplace::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string Workplace::read(const std::string& name) const { return content(folder_ / name); }

std::string Workplace::listing(const std::string& folder) const {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / folder))
    names.insert(entry.path().filename().string());
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

}  // namespace hwsim::cli::test
