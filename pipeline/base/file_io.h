#pragma once
// Reads and writes whole files.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hwsim/base/diagnostics.h"
#include "pipeline/base/file_descriptor.h"

namespace hwsim::pipeline {

using ByteSpan = std::span<const std::uint8_t>;

/// The whole file. Throws InputError (code `code`) with the system's reason when it cannot be read or is
/// larger than `max_bytes`.
std::vector<std::uint8_t> read_file(const std::string& path, const std::string& code, std::size_t max_bytes);

/// The exit status of a program that could not write for this reason (errno). A disk that is full or broken
/// fails the run; a folder that is missing or closed is a mistake in what was asked for.
ExitStatus write_failure_status(int reason);

/// Writes beside the target, waits until the disk has it, and renames, so that a file that exists is complete
/// even after a loss of power. Throws InputError (code `code`).
void write_file_atomically(const std::string& path, const std::string& code, ByteSpan bytes);
/// The same of several pieces, one behind the other.
void write_file_atomically(const std::string& path, const std::string& code,
                           const std::vector<ByteSpan>& pieces);

/// The same, but a file that exists stays, and is an error.
void write_new_file(const std::string& path, const std::string& code, ByteSpan bytes);

/// A new file beside `target`, locked; `path` is its name. The first free name is taken, so that the next
/// writer of the same target finds what a killed one left. Not open, with errno set, where none can be made.
FileDescriptor open_unfinished(const std::string& target, std::string& path);

/// Whether a file of this name is one that the functions above rename when it is complete. Its writer holds a
/// lock on it.
bool is_unfinished_name(std::string_view name);
/// Removes an unfinished file whose writer is gone. Returns whether it did.
bool remove_if_abandoned(const std::string& path);

}  // namespace hwsim::pipeline
