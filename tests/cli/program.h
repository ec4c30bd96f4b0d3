#pragma once
// Runs the built program as a user does: a shell, a folder of its own, an exit status, two streams.
#include <filesystem>
#include <map>
#include <string>

namespace hwsim::cli::test {

struct Outcome {
  int status = -1;
  std::string out, err;
};

/// A temporary folder in which the program runs; removed at the end.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  /// `arguments` as typed after "hwsim "; `environment` as "NAME=value " assignments before it.
  Outcome hwsim(const std::string& arguments, const std::string& environment = "") const;
  Outcome shell(const std::string& command) const;

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  /// Names in a folder of the workplace, hidden ones included, sorted.
  std::string listing(const std::string& folder = ".") const;

 private:
  std::filesystem::path folder_;
};

/// A glTF file with one triangle and nothing beside it.
extern const char* const kTriangleGltf;

}  // namespace hwsim::cli::test
