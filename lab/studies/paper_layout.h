#pragma once
// The tables of a paper as the paper lays them out: which rows of a reproduction stand in which cell.
#include <string>
#include <vector>

#include "lab/studies/reproduction.h"

namespace hwsim::lab {

/// A table of a paper, or a part of one.
struct PaperTable {
  struct Line {
    std::string label{};
    std::vector<std::vector<std::size_t>> cells{};  ///< as columns; each: indices into Reproduction::rows
  };
  std::string name{};                               ///< "sbaa_table1_analysis"
  std::string title{};                              ///< "SBAA, Table 1: Time of the analysis pass"
  std::string line_title{};                         ///< what labels of lines are: "scene"
  std::vector<std::vector<std::string>> columns{};  ///< each: its labels, the outermost first
  std::vector<Line> lines{};
};

/// Every row but sentences of the text stands in one cell of one table. `published_dir` holds
/// mapping/layout.csv; a table that it does not name has scenes as lines. Throws InputError M001 for a layout
/// that names no field of a row.
std::vector<PaperTable> paper_tables(const Reproduction& reproduction, const std::string& published_dir);

}  // namespace hwsim::lab
