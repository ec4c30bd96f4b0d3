#include "pipeline/gltf/report.h"

namespace hwsim::pipeline::gltf {
namespace {

// How to go on where the place of the mistake says nothing better.
const char* remedy_of(const std::string& code) {
  if (code == "S001") return "check the path and that the file may be read";
  if (code == "S006") return "export without the extension";
  if (code == "S010") return "repair the value in the program that the scene comes from, and export again";
  if (code == "S012") return "reduce the scene, or split it into several files";
  if (code == "S015") return "put the file into the scene's folder and name it by a relative path";
  if (code == "S002" || code == "S003") return "the file is damaged or incomplete: export or copy it again";
  return "the file breaks the rules of glTF 2.0: export it again, or look at it with a glTF validator";
}

}  // namespace

Diagnostic Report::error(const std::string& code, const std::string& message, const std::string& help) const {
  Diagnostic d;
  d.code = code;
  d.message = message;
  d.place.file = file_;
  d.help = help.empty() ? remedy_of(code) : help;
  return d;
}

void Report::fail(const std::string& code, const std::string& message, const std::string& help) const {
  throw InputError(error(code, message, help));
}

void Report::note(const std::string& code, const std::string& what, const std::string& element) {
  add(Severity::note, code, what, element);
}

void Report::warn(const std::string& code, const std::string& what, const std::string& element) {
  add(Severity::warning, code, what, element);
}

void Report::add(Severity severity, const std::string& code, const std::string& what,
                 const std::string& element) {
  const auto [place, is_new] = entry_of_.try_emplace(code + '\n' + what, entries_.size());
  if (is_new) entries_.push_back({severity, code, what, element, 0});
  ++entries_[place->second].count;
}

std::vector<Diagnostic> Report::notes() const {
  std::vector<Diagnostic> out;
  for (const Entry& entry : entries_) {
    Diagnostic d;
    d.severity = entry.severity;
    d.code = entry.code;
    d.message = entry.what;
    d.place.file = file_;
    if (!entry.first_element.empty()) {
      d.message += " (" + entry.first_element;
      if (entry.count > 1) d.message += " and " + std::to_string(entry.count - 1) + " more";
      d.message += ")";
    }
    out.push_back(std::move(d));
  }
  return out;
}

std::string element(const char* array, std::size_t index) {
  return std::string(array) + "[" + std::to_string(index) + "]";
}

}  // namespace hwsim::pipeline::gltf
