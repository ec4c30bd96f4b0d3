#include "pipeline/gltf/report.h"

namespace hwsim::pipeline::gltf {

Diagnostic Report::error(const std::string& code, const std::string& message, const std::string& help) const {
  Diagnostic d;
  d.code = code;
  d.message = message;
  d.place.file = file_;
  d.help = help;
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
