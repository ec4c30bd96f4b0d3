#include "lab/base/scene_kinds.h"

#include <filesystem>

namespace hwsim::lab {

InputError with_scene_kinds(const InputError& error, const std::string& name) {
  std::vector<Diagnostic> problems = error.diagnostics();
  std::error_code ignored;
  for (Diagnostic& problem : problems) {
    if (problem.code != "S201") continue;
    problem.notes.emplace_back(
        "a scene is a file that ends in .gltf or .glb, or the name of a generated one");
    if (std::filesystem::is_directory(name, ignored))
      problem.notes.push_back("`" + name + "` is a folder: give a scene's file in it");
    else if (std::filesystem::exists(name, ignored))
      problem.notes.push_back("`" + name + "` is a file of another kind: export it as glTF 2.0");
  }
  return InputError(std::move(problems), error.status());
}

}  // namespace hwsim::lab
