#pragma once
// A report as one HTML file: readable without scripts, complete without a network.
#include <cstddef>
#include <string>

#include "lab/report/page_parts.h"
#include "lab/report/report.h"

namespace hwsim::lab {

inline constexpr std::size_t kPageBytesMax = 5'000'000;

/// The page. Its pictures lose quality, then size, until it takes less than kPageBytesMax.
std::string page_of(const Report& report, const PageParts& parts);

}  // namespace hwsim::lab
