#pragma once
// What the fuzz targets share: an input is answered or refused with a message; whatever else happens is a
// crash.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "hwsim/base/printable.h"

namespace hwsim::fuzz {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] inline void broken(const std::string& law) {
  std::fprintf(stderr, "broken law: %s\n", printable(law).c_str());
  std::abort();
}
inline void require(bool holds, const char* law) {
  if (!holds) broken(law);
}

/// What every refusal owes its reader.
inline void check_refusal(const InputError& refusal) {
  const std::vector<Diagnostic>& found = refusal.diagnostics();
  require(!found.empty(), "a refusal has a message");
  require(found.size() <= kProblemsShown, "a refusal can be read");
  for (const Diagnostic& d : found) {
    const std::string text = render(d, false);
    if (d.code.empty() || d.code == "X001" || d.message.empty()) broken("a refusal has a code: " + text);
    if (printable(text) != text) broken("a message is safe for a terminal: " + text);
  }
}

/// Calls `use`. An InputError is a good end; every other exception leaves the target, which is a crash.
template <class Use>
void answer_or_refuse(Use&& use) {
  try {
    use();
  } catch (const InputError& refusal) {
    check_refusal(refusal);
  }
}

/// Calls `use` with what the program itself has written: it must not be refused.
template <class Use>
auto answer(Use&& use) {
  try {
    return use();
  } catch (const InputError& refusal) {
    broken("what was written is read back: " + render(refusal.diagnostics().front(), false));
  }
}

inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The input in pieces, one for each file or word that the target needs.
inline std::vector<Bytes> pieces(Bytes input, std::uint8_t separator) {
  std::vector<Bytes> all;
  while (true) {
    std::size_t end = 0;
    while (end < input.size() && input[end] != separator) ++end;
    all.push_back(input.first(end));
    if (end == input.size()) return all;
    input = input.subspan(end + 1);
  }
}

/// A folder of this process, removed at its end. TMPDIR says where: in memory it is ten times as fast.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "hwsim_fuzz_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) broken("the scratch folder can be made");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string path() const { return path_.string(); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

  /// The file's path. A file that holds these bytes already stays as it is.
  std::string write(const std::string& name, Bytes bytes) {
    const std::string path = file(name);
    const std::string_view text = text_of(bytes);
    const auto [written, is_new] = written_.try_emplace(name);
    if (!is_new && written->second == text) return path;
    written->second = text;
    std::error_code ignored;
    std::filesystem::remove(path, ignored);  // ext4 flushes a file that is truncated and written again
    std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
    return path;
  }
  std::string write(const std::string& name, std::string_view text) {
    return write(name, Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }

 private:
  std::filesystem::path path_;
  std::map<std::string, std::string> written_;
};

}  // namespace hwsim::fuzz
