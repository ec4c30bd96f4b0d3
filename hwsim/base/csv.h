#pragma once
// CSV as RFC 4180 writes it; LF alone ends a line too.
#include <string>
#include <string_view>
#include <vector>

namespace hwsim {

struct CsvFile {
  std::string path;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header
  std::vector<int> lines;                      ///< where each row begins, from 1

  /// Index of a column; InputError U015 names the file when there is none.
  std::size_t column(std::string_view name) const;
};

/// Throws InputError U015 for rows of another length than the header.
CsvFile parse_csv(std::string_view text, const std::string& path);

/// Throws InputError U011 when the file cannot be read.
CsvFile read_csv(const std::string& path);

}  // namespace hwsim
