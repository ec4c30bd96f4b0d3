// A run.toml: read, planned, written, and read again.
#include "fuzz/fuzz_input.h"
#include "lab/request/run_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hwsim;
  static fuzz::ScratchFolder folder;
  const std::string path = folder.write("run.toml", fuzz::Bytes(data, size));
  fuzz::answer_or_refuse([&] {
    const lab::Request request = lab::read_run_file(path);
    lab::ConfigFiles files;
    const lab::RunPlan plan = lab::make_plan(request, files);
    const std::string text = lab::run_file_text(plan, plan.techniques.front(), request.gpus.front());
    const std::string written = folder.write("again.toml", text);
    const lab::Request again = fuzz::answer([&] { return lab::read_run_file(written); });
    fuzz::require(again.techniques.size() == 1, "a run has one technique");
  });
  return 0;
}
