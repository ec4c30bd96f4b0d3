// An overlay over a GPU that comes with hwsim, and one setting of the command line.
#include <array>

#include "fuzz/gpu_work.h"
#include "hwsim/config/settings.h"
#include "support/places.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hwsim;
  static fuzz::ScratchFolder folder;
  static const std::string gpus = test::source_dir() + "/configs/gpus";
  const std::vector<fuzz::Bytes> pieces = fuzz::pieces(fuzz::Bytes(data, size), 0);
  const std::array overlays{folder.write("overlay.toml", pieces.front())};
  fuzz::answer_or_refuse([&] {
    std::vector<Assignment> sets;
    if (pieces.size() > 1) sets.push_back(parse_assignment(std::string(fuzz::text_of(pieces[1]))));
    fuzz::check_times(load_gpu("gtx470", overlays, sets, gpus));
  });
  return 0;
}
