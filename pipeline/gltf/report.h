#pragma once
// Errors, warnings and notes about one glTF file.
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hwsim/base/diagnostics.h"

namespace hwsim::pipeline::gltf {

/// Says what is wrong with one file, and collects what was ignored or generated. A file may trigger the same
/// note for each of ten thousand primitives, so equal notes merge: the first element and a count stay.
class Report {
 public:
  explicit Report(std::string file) : file_(std::move(file)) {}

  /// Without `help`, the code's usual remedy is given.
  [[noreturn]] void fail(const std::string& code, const std::string& message,
                         const std::string& help = "") const;
  Diagnostic error(const std::string& code, const std::string& message, const std::string& help = "") const;

  /// `what` reads on its own ("normals generated, one a triangle"); `element` says where
  /// ("meshes[2].primitives[0]").
  void note(const std::string& code, const std::string& what, const std::string& element = "");
  void warn(const std::string& code, const std::string& what, const std::string& element = "");

  std::vector<Diagnostic> notes() const;  ///< in the order of the first occurrence
  const std::string& file() const { return file_; }

 private:
  struct Entry {
    Severity severity;
    std::string code, what, first_element;
    int count = 0;
  };
  void add(Severity severity, const std::string& code, const std::string& what, const std::string& element);

  std::string file_;
  std::vector<Entry> entries_;
  std::map<std::string, std::size_t> entry_of_;
};

/// "nodes[7]"
std::string element(const char* array, std::size_t index);

}  // namespace hwsim::pipeline::gltf
