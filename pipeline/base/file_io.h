#pragma once
// Reads and writes whole files.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hwsim::pipeline {

/// The whole file. Throws InputError (code `code`) with the system's reason when it cannot be read or is
/// larger than `max_bytes`.
std::vector<std::uint8_t> read_file(const std::string& path, const std::string& code, std::size_t max_bytes);

/// Writes beside the target and renames, so that a file that exists is complete. Throws InputError (code
/// `code`).
void write_file_atomically(const std::string& path, const std::string& code,
                           std::span<const std::uint8_t> bytes);

}  // namespace hwsim::pipeline
