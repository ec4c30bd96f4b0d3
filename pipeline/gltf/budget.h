#pragma once
// What loading one scene may take of memory. Sums of bytes are charged before anything is allocated, so that
// a file of a kilobyte cannot fill memory with what it merely announces.
#include <cstdint>
#include <string>

#include "pipeline/gltf/report.h"

namespace hwsim::pipeline::gltf {

class Budget {
 public:
  Budget(const Report& report, std::uint64_t limit_bytes) : report_(report), limit_bytes_(limit_bytes) {}

  /// `what` completes "reading ... takes": "the buffers". Throws InputError (S012) where the sum of all
  /// charges passes the limit.
  void charge(std::uint64_t bytes, const std::string& what);
  std::uint64_t charged_bytes() const { return charged_bytes_; }

 private:
  const Report& report_;
  std::uint64_t limit_bytes_, charged_bytes_ = 0;
};

}  // namespace hwsim::pipeline::gltf
