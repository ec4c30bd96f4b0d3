#pragma once
// Files of a cache: sealed with kind, version, length and check sum, in a folder that nobody else may write.
// Whatever is damaged, of another version or of another user is as good as not there.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/file_io.h"

namespace hwsim::pipeline {

/// What a sealed file is said to hold.
struct SealKind {
  std::string_view name;     ///< up to eight characters
  std::string_view sources;  ///< the digest of the sources that write it: its version
};

struct SealedContent {
  std::optional<std::vector<std::uint8_t>> bytes;
  std::string damage;  ///< why there are none; empty where there is no such file
};

/// Never throws for what is in the file.
SealedContent read_sealed(const std::string& path, const SealKind& kind);

/// Throws InputError (code `code`) where it cannot be written.
void write_sealed(const std::string& path, const SealKind& kind, const std::string& code, ByteSpan payload);

/// Makes the folder if it is missing (its parents too), for this user alone (0700). Returns why it cannot be
/// made or trusted: it is another user's, or others may write to it. Empty: it is there.
std::string make_own_folder(const std::string& path);
/// The same of a folder that holds nothing but sealed files: others lose the right to write and to look.
std::string make_private_folder(const std::string& path);

}  // namespace hwsim::pipeline
