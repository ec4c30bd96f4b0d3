#pragma once
// Files that the application reads and writes, and where it finds its own.
#include <cstdint>
#include <string>
#include <string_view>

namespace hwsim::lab {

/// Written beside the target and renamed, so that a file that exists is complete. Throws InputError U010.
void write_file(const std::string& path, std::string_view text);

/// Throws InputError U011 when it cannot be read.
std::string read_file(const std::string& path);

/// The folder with gpus/, scenes/ and published/: $HWSIM_CONFIG_DIR, else ../share/hwsim/configs beside the
/// program's folder, else the source tree that it was built from. Throws InputError U012 when there is none.
std::string config_directory();

std::string gpu_directory();  ///< config_directory()/gpus

/// 64-bit FNV-1a as 16 hex digits: names of cached files, ids of runs. Not for untrusted keys.
std::string hash_hex(std::string_view bytes);

}  // namespace hwsim::lab
