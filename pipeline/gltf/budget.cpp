#include "pipeline/gltf/budget.h"

namespace hwsim::pipeline::gltf {
namespace {

std::string mebibytes(std::uint64_t bytes) {
  return std::to_string((bytes + (std::uint64_t{1} << 20) - 1) >> 20) + " MiB";
}

}  // namespace

void Budget::charge(std::uint64_t bytes, const std::string& what) {
  if (bytes > limit_bytes_ - charged_bytes_)
    report_.fail("S012",
                 "loading " + what + " would take " + mebibytes(bytes) + " beside " +
                     mebibytes(charged_bytes_) + ", the limit is " + mebibytes(limit_bytes_),
                 "reduce the meshes and textures, or raise the limit: --set scene.memory_mib=NUMBER");
  charged_bytes_ += bytes;
}

}  // namespace hwsim::pipeline::gltf
