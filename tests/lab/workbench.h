#pragma once
// A folder of its own with a tiny scene and a cache, and an observer that remembers what it was told.
#include <filesystem>
#include <string>
#include <vector>

#include "lab/base/observer.h"
#include "lab/request/request.h"

namespace hwsim::lab::test {

/// A temporary folder that holds triangle.gltf. Removed at the end.
class Workbench {
 public:
  Workbench();
  ~Workbench();
  Workbench(const Workbench&) = delete;
  Workbench& operator=(const Workbench&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// The triangle at 64x48, without images.
  Request request(std::vector<std::string> techniques = {"none"},
                  std::vector<std::string> gpus = {"gtx980"}) const;

 private:
  std::filesystem::path folder_;
};

class Listener : public Observer {
 public:
  void say(const std::string& line) override { said.push_back(line); }
  void report(const Diagnostic& diagnostic) override { reported.push_back(diagnostic.code); }
  void progress(double done_ratio, const std::string& what) override {
    done.push_back(done_ratio);
    last = what;
  }
  void progress_ended() override { ++ends; }

  std::vector<std::string> said, reported;
  std::vector<double> done;
  std::string last;
  int ends = 0;
};

}  // namespace hwsim::lab::test
