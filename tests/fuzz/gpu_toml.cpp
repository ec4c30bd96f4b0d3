// A GPU file: loaded, shown, loaded again, and given work.
#include "fuzz/gpu_work.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hwsim;
  static fuzz::ScratchFolder folder;
  const std::string path = folder.write("input.toml", fuzz::Bytes(data, size));
  fuzz::answer_or_refuse([&] {
    const GpuConfig gpu = load_gpu(path, {}, {}, folder.path());
    const std::string shown = folder.write("shown.toml", show(gpu, size % 2 == 0));
    const GpuConfig again = fuzz::answer([&] { return load_gpu(shown, {}, {}, folder.path()); });
    fuzz::require(content_hash(again) == content_hash(gpu), "a GPU that is shown is the same GPU");
    fuzz::check_times(gpu);
  });
  return 0;
}
