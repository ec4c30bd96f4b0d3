#pragma once
// How a finished folder takes the place of another one, and what killed runs left behind.
#include <cstddef>
#include <filesystem>
#include <string>
#include <system_error>

namespace hwsim::lab {

/// Lies in a folder of results until it is complete.
inline constexpr const char* kUnfinishedMark = ".hwsim-unfinished";

/// ".results.partial-4711" beside "results", for this process.
std::filesystem::path partial_name(const std::filesystem::path& place);

/// Both folders change places in one step, so that there is always one under each name. File systems that
/// cannot do it get `exchange_in_steps`.
std::error_code exchange_folders(const std::filesystem::path& fresh, const std::filesystem::path& place);

/// The folder at `place` steps aside, as ".results.old-4711", until `fresh` has taken its place. It comes
/// back where that fails.
std::error_code exchange_in_steps(const std::filesystem::path& fresh, const std::filesystem::path& place);

/// Whether the folder holds a manifest.json that hwsim wrote: other programs have files of this name, too.
bool is_of_hwsim(const std::filesystem::path& folder);

/// Removes a folder of results; what shows whose it is goes last, so that a removal that is cut short can be
/// finished.
std::error_code remove_results(const std::filesystem::path& folder);

/// Removes the unfinished folder of this process while other threads may write into it: under another
/// unfinished name nobody finds it any more.
void remove_unfinished(const std::filesystem::path& partial);

/// Removes unfinished folders below `parent` whose process is gone, and brings back a result that had stepped
/// aside and that nothing replaced. Only what hwsim provably made is touched: name, owner, and mark or
/// manifest. Returns how many there were.
std::size_t clear_abandoned(const std::filesystem::path& parent);

}  // namespace hwsim::lab
